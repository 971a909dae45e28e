// SPDX-License-Identifier: Apache-2.0
// Compares the counters themselves with the number of triangles that each segment meets, found triangle by triangle
// with exact predicates, on broken meshes. Also tests where the paper's counters are right: for closed meshes, but not
// for open ones that fold over at their boundary.

#include "tests/agreement/differences.hpp"

#include "mesh/shapes/broken_meshes.hpp"
#include "selftest/mask_checks.hpp"
#include "tests/unit/passed.hpp"
#include "volumes/counters/depth_counters.hpp"
#include "volumes/counters/methods.hpp"

#include <atomic>
#include <cmath>
#include <numbers>

namespace penumbra::volumes {
namespace {

using visibility::ViewSamples;

class Counters : public tests::DeviceTest {
 protected:
  /// Tests the counters of every `step`-th pixel.
  void expect_layers(const std::string& name, const scenes::Scene& scene, std::uint32_t size, std::size_t step) {
    SCOPED_TRACE(name);
    const tests::Stage stage(scene, size, size, {64, 0, 0, visibility::SamplePattern::sobol, 7});
    tests::expect_passed(selftest::check_counters(*method_, stage, step, total_));
  }

  void expect_seen_enough() {
    fmt::print("{} pairs, {} met something, {} several layers, {} left to exact predicates\n", total_.pairs, total_.met,
               total_.several, total_.open);
    EXPECT_GT(total_.met, total_.pairs / 50);
    EXPECT_GT(total_.several, total_.pairs / 100);
    EXPECT_LT(total_.open, total_.pairs / 10);  // otherwise the counters would hardly be tested
  }

  std::unique_ptr<DepthCounters> method_ = make_depth_counters(device());
  selftest::CounterTally total_;
};

scenes::Scene broken_scene(const std::vector<std::string>& defects, std::uint32_t size) {
  return tests::with_a_floor(mesh::make_broken_mesh({defects, size, {0, 1, 0}, 1}).soup);
}

TEST_F(Counters, EqualTheLayersOnEveryDefect) {
  for (const mesh::DefectName& defect : mesh::broken_defects()) {
    expect_layers(std::string(defect.name), broken_scene({std::string(defect.name)}, 2), 20, 3);
  }
  expect_seen_enough();
}

using CountersFull = Counters;
TEST_F(CountersFull, EqualTheLayersOnEveryDefect) {
  std::vector<std::string> all;
  for (const mesh::DefectName& defect : mesh::broken_defects()) {
    all.emplace_back(defect.name);
    for (const std::uint32_t size : {1U, 3U, 6U}) expect_layers(all.back(), broken_scene({all.back()}, size), 48, 1);
  }
  expect_layers("all", broken_scene(all, 2), 48, 1);
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    mesh::LatticeSoup soup;
    soup.seed = seed;
    soup.center = {0, 1, 0};
    expect_layers(fmt::format("soup {}", seed), tests::with_a_floor(mesh::make_lattice_soup(soup)), 32, 1);
  }
  expect_seen_enough();
}

/// A ball of `rings` bands around a tilted axis; with only the first `used` bands it is a bowl.
mesh::TriangleSoup ball(int rings, int used) {
  constexpr int kSegments = 12;
  mesh::TriangleSoup soup;
  const auto at = [&](int ring, int segment) {
    const double theta = std::numbers::pi * ring / rings,
                 phi = 2 * std::numbers::pi * (segment % kSegments) / kSegments;
    const double x = ring % rings == 0 ? 0 : std::sin(theta) * std::cos(phi),
                 z = ring % rings == 0 ? 0 : std::sin(theta) * std::sin(phi), y = -std::cos(theta);
    return glm::dvec3(0.1, 1.3, 0.2) + 0.9 * glm::dvec3(0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y, z);
  };
  const auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    if (a == b || b == c || c == a) return;
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    soup.positions.insert(soup.positions.end(), {a, b, c});
    soup.triangles.push_back({first, first + 1, first + 2});
  };
  for (int ring = 0; ring < used; ++ring) {
    for (int segment = 0; segment < kSegments; ++segment) {
      const glm::dvec3 a = at(ring, segment), b = at(ring, segment + 1), c = at(ring + 1, segment),
                       d = at(ring + 1, segment + 1);
      add(a, c, b);
      add(b, c, d);
    }
  }
  return soup;
}

using Variants = tests::DeviceTest;

std::size_t wrong_pairs(visibility::Method& method, const tests::Stage& stage) {
  const tests::Masks masks = tests::run(method, stage.floats, stage.light, stage.samples);
  std::atomic<std::size_t> wrong = 0;
  tbb::parallel_for(std::size_t{0}, stage.samples.size(), [&](std::size_t pixel) {
    if (stage.samples.triangle[pixel] == ViewSamples::kBackground) return;
    for (std::uint32_t j = 0; j < stage.light.sample_count(); ++j) {
      const auto truth = visibility::decide_pair(stage.floats, stage.samples, pixel, stage.light, j);
      wrong += masks.visible(pixel, j) != (truth.outcome == visibility::PairOutcome::visible) ? 1U : 0U;
    }
  });
  return wrong;
}

TEST_F(Variants, LaineIsRightForClosedMeshesOnly) {
  const auto soup = make_depth_complexity(device(), {}),
             laine = make_depth_complexity(device(), {{"variant", "laine"}});
  const tests::Stage closed(tests::with_a_floor(ball(8, 8)), 40, 40, {64, 0, 0, visibility::SamplePattern::rows, 0});
  EXPECT_EQ(wrong_pairs(*soup, closed), 0U);
  EXPECT_EQ(wrong_pairs(*laine, closed), 0U);
  EXPECT_GT(laine->counters()["referenceRays"], 0U);
  EXPECT_EQ(soup->counters()["referenceRays"], 0U);
  // A bowl shows its inside over its rim: there two layers end at a silhouette, and one at the rim.
  const tests::Stage open(tests::with_a_floor(ball(8, 6)), 40, 40, {64, 0, 0, visibility::SamplePattern::rows, 0});
  EXPECT_EQ(wrong_pairs(*soup, open), 0U);
  const std::size_t wrong = wrong_pairs(*laine, open);
  EXPECT_GT(wrong, 0U);
  fmt::print("variant=laine on a bowl: {} of {} pairs wrong\n", wrong, open.samples.size() * 64);
}

}  // namespace
}  // namespace penumbra::volumes
