// SPDX-License-Identifier: Apache-2.0
// Tests domes: masks of every method against the exact decision of each pair; areas of two arithmetics against each
// other and against many light samples.

#include "tests/agreement/lattice.hpp"
#include "tests/unit/dome_stage.hpp"
#include "tests/unit/visibility/soups.hpp"
#include "visibility/dome_faces.hpp"
#include "visibility/pair_truth.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <string_view>

namespace penumbra::tests {
namespace {

using visibility::PairOutcome;
using visibility::SamplePattern;

scenes::Dome some_dome(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> real(-1, 1);
  const double x = real(random), y = real(random), z = real(random);
  scenes::Dome dome;
  dome.half = seed % 3 == 1;
  dome.rotate = 360 * x;
  if (seed % 4 == 2) dome.up = glm::normalize(glm::dvec3(x, y, z));
  if (seed % 8 == 4) dome.up = {0, 0, -1};
  return dome;
}

/// Returns soups of triangles in general position, or on a lattice on which the faces' axes and the light samples of a
/// dome with an axis as `up` meet edges and planes exactly.
scenes::Scene soup_under_dome(std::uint32_t seed) {
  std::mt19937 random(seed);
  if (seed % 2 == 0) {
    scenes::Scene scene = soup_over_tilted_floor(random, 60);
    scene.lights.push_back(dome_light(some_dome(seed)));
    return scene;
  }
  LatticeSoup soup(seed, 3);
  visibility::SampleRequest ignored;
  scenes::Scene scene = lattice_scene(soup, ignored);
  for (scenes::Object& object : scene.objects) object.emits.reset();
  scene.lights.front() = dome_light(some_dome(seed));
  return scene;
}

/// Returns a picture of 8 by 4 texels, whose middles are directions along axes and diagonals.
scenes::Texture lattice_sky() {
  scenes::Texture sky{"made by hand", 8, 4, std::vector<glm::vec3>(32)};
  for (std::size_t i = 0; i < sky.texels.size(); ++i)
    sky.texels[i] = glm::vec3(static_cast<float>(i % 5), static_cast<float>(i % 3), 1);
  return sky;
}

/// Counts the pairs of all seeds that run: ten million with the seeds of label full.
class DomePairs : public testing::TestWithParam<std::uint32_t> {
 protected:
  static void SetUpTestSuite() { compared_ = blocked_ = 0; }
  static void TearDownTestSuite() {
    const testing::TestSuite& suite = *testing::UnitTest::GetInstance()->current_test_suite();
    fmt::print("{}: {} pairs, {} of them blocked, each by {} methods\n", suite.name(), compared_, blocked_,
               dome_mask_methods().size());
    const bool is_whole = suite.test_to_run_count() == suite.total_test_count();
    if (is_whole && std::string_view(suite.name()).starts_with("SeedsFull")) {
      EXPECT_GE(compared_, 10'000'000U);
    }
  }
  static inline std::uint64_t compared_ = 0, blocked_ = 0;
};

TEST_P(DomePairs, AreTheExactDecision) {
  const std::uint32_t seed = GetParam();
  scenes::Scene scene = soup_under_dome(seed);
  if (seed % 5 == 0) scene.lights.front().texture = lattice_sky();
  const SamplePattern pattern = seed % 2 == 1 ? SamplePattern::grid : SamplePattern::rows;
  const Stage stage(scene, 24, 24, {64, 0, 0, pattern, seed});
  const std::uint32_t count = stage.light.sample_count();
  Masks truth;
  truth.words_per_pixel = stage.light.words_per_mask();
  truth.words.resize(stage.samples.size() * truth.words_per_pixel);
  std::size_t pairs = 0, blocked = 0;
  for (std::size_t pixel = 0; pixel < stage.samples.size(); ++pixel) {
    if (stage.samples.triangle[pixel] < 0) continue;
    for (std::uint32_t j = 0; j < count; ++j) {
      const PairOutcome outcome = visibility::decide_pair(stage.floats, stage.samples, pixel, stage.light, j).outcome;
      ++pairs;
      blocked += outcome == PairOutcome::blocked ? 1 : 0;
      if (outcome == PairOutcome::visible) truth.words[pixel * truth.words_per_pixel + j / 32] |= 1U << j % 32;
    }
  }
  for (const auto& [name, method] : dome_mask_methods()) {
    const Masks masks = answer_of(*method, stage).masks;
    std::size_t wrong = 0;
    for (std::size_t pixel = 0; pixel < stage.samples.size(); ++pixel) {
      if (stage.samples.triangle[pixel] < 0) continue;
      for (std::uint32_t j = 0; j < count; ++j) wrong += masks.visible(pixel, j) != truth.visible(pixel, j) ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0U) << name << ", of " << pairs;
  }
  const Masks rays = trace(stage);
  std::size_t differing = 0;
  for (std::size_t pixel = 0; pixel < stage.samples.size(); ++pixel) {
    if (stage.samples.triangle[pixel] < 0) continue;
    for (std::uint32_t j = 0; j < count; ++j) differing += rays.visible(pixel, j) != truth.visible(pixel, j) ? 1 : 0;
  }
  if (seed % 2 == 0) {
    EXPECT_LE(differing, pairs / 5000) << "rays, of " << pairs;
  }
  compared_ += pairs;
  blocked_ += blocked;
}

INSTANTIATE_TEST_SUITE_P(Seeds, DomePairs, testing::Range(0U, 24U));
INSTANTIATE_TEST_SUITE_P(SeedsFull, DomePairs, testing::Range(24U, 624U));

class DomeAreas : public testing::TestWithParam<std::uint32_t> {};

TEST_P(DomeAreas, AgreeWithOneAnotherAndWithManySamples) {
  const Stage stage(soup_under_dome(GetParam()), 12, 12, {4096, 0, 0, SamplePattern::sobol, 0});
  const auto methods = dome_area_methods();
  const DomeAnswer rows = answer_of(*methods[0].second, stage), exact = answer_of(*methods[1].second, stage);
  const DomeAnswer samples = answer_of(*dome_mask_methods()[0].second, stage);
  std::size_t partly = 0;
  double largest = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (stage.samples.triangle[i] < 0) continue;
    const float v = rows.masks.visibility[i];
    partly += v > 0 && v < 1 ? 1 : 0;
    largest = std::max(largest, std::abs(rows.form_factors[i].x - exact.form_factors[i].x));
    EXPECT_NEAR(v, exact.masks.visibility[i], 2e-7) << i;
    EXPECT_NEAR(rows.form_factors[i].x, exact.form_factors[i].x, 1e-7) << i;
    // If half a dome leans away, few light samples are above the plane, and they carry little of the dome's light.
    const double whole = visibility::dome_form_factor(stage.light, glm::normalize(glm::dvec3(stage.samples.n[i])));
    EXPECT_NEAR(whole * v, whole * samples.masks.visibility[i], 0.02) << i;
  }
  EXPECT_GT(partly, GetParam() % 2 == 0 ? 5U : 0U);
  fmt::print("{} partly lit, form factors off by {:.1e}\n", partly, largest);
}

INSTANTIATE_TEST_SUITE_P(Seeds, DomeAreas, testing::Range(0U, 8U));
INSTANTIATE_TEST_SUITE_P(SeedsFull, DomeAreas, testing::Range(8U, 100U));

}  // namespace
}  // namespace penumbra::tests
