// SPDX-License-Identifier: Apache-2.0
// Compares soft-irregular with the sum over all silhouettes of the light's centre at each view sample (SoftVisibility):
// its lists lose no edge and no layer. With umbra=layers and arc=tangent the numbers are the same to the last bit. An
// arc cosine is off by √(2 · 2⁻⁵²) if its angle is near 0 or π (the cosine rounds by 2⁻⁵² at most), so an edge's share
// of the light is off by half of that over π, 3.4e-9; V is stored in float, 2⁻²⁵. Joined layers (fusion=union) are
// compared with methods that count them at the same light samples by other means.

#include "tests/agreement/lattice.hpp"
#include "tests/agreement/volumes/soft_stage.hpp"
#include "tests/property/lattice_truth.hpp"

#include "base/error.hpp"
#include "volumes/counters/methods.hpp"
#include "volumes/soft/methods.hpp"
#include "vsm/methods.hpp"

namespace penumbra::volumes {
namespace {

using tests::SoftStage;

constexpr double kArcCosine = 3.4e-9, kFloat = 0x1p-25;

class SoftIrregularTwin : public tests::DeviceTest {
 protected:
  struct Expected {
    std::vector<LayerSum> sums;
    std::size_t penumbra = 0;
  };
  static Expected twin(const SoftStage& stage) {
    const Casters casters = casters_of(stage.floats, stage.light);
    const SoftVisibility soft(stage.floats, stage.light, casters);
    Expected expected{std::vector<LayerSum>(stage.samples.size())};
    tbb::parallel_for(std::size_t{0}, stage.samples.size(), [&](std::size_t i) {
      if (visibility::is_receiver(stage.floats, stage.light, stage.samples, i))
        expected.sums[i] = soft.at(stage.lit(i), Viewer::center);
    });
    for (const LayerSum& sum : expected.sums) expected.penumbra += sum.edges.empty() ? 0U : 1U;
    return expected;
  }
  static void expect_twin(const std::string& name, const SoftStage& stage, std::size_t fewest = 10) {
    const Expected expected = twin(stage);
    const auto layers = make_soft_irregular({{"umbra", "layers"}, {"arc", "tangent"}});
    const auto cosines = make_soft_irregular({{"umbra", "layers"}}), published = make_soft_irregular({});
    const std::vector<float> v = stage.run(*layers, 7), by_cosine = stage.run(*cosines),
                             as_published = stage.run(*published);
    std::size_t wrong = 0;
    double most_off = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (!visibility::is_receiver(stage.floats, stage.light, stage.samples, i)) continue;
      const LayerSum& sum = expected.sums[i];
      if (v[i] != static_cast<float>(sum.visibility) && wrong++ == 0)
        ADD_FAILURE() << name << ", pixel " << i << ": V is " << v[i] << ", the twin's " << sum.visibility;
      const double off = std::abs(static_cast<double>(by_cosine[i]) - sum.visibility);
      const double allowed = kFloat + kArcCosine * static_cast<double>(sum.edges.size());
      EXPECT_LE(off, allowed) << name << ", pixel " << i;
      most_off = std::max(most_off, off);
      const double one = sum.in_front ? std::clamp(1 - std::min(sum.constant, 1) - sum.sum, 0.0, sum.above) : 0;
      EXPECT_LE(std::abs(static_cast<double>(as_published[i]) - one), allowed) << name << ", pixel " << i;
    }
    EXPECT_EQ(wrong, 0U) << name;
    EXPECT_GE(expected.penumbra, fewest) << name;
    fmt::print("{}: {} view samples see edges; by arc cosines off by {:.1e} at most; {} wedge tests, {} kept\n", name,
               expected.penumbra, most_off, layers->counters().at("wedgeTests"), layers->counters().at("edgesOnLight"));
  }
};

TEST_F(SoftIrregularTwin, ShippedScenes) {
  for (const char* name : {"broken", "contact", "fusion", "textured-light", "thin"})
    expect_twin(name, SoftStage(tests::shipped_scene(name), device(), 32, 24));
}

TEST_F(SoftIrregularTwin, RoundLightsAndPolygons) {
  for (const scenes::LightShape& shape : {scenes::LightShape(scenes::Disk{{0, 5, 0}, {0.1, -1, 0}, 0.9}),
                                          scenes::LightShape(scenes::Ellipse{{0, 5, 0}, {1.2, 0, 0}, {0, 0.1, 0.4}}),
                                          scenes::LightShape(scenes::Polygon{{{-1, 5, -1}, {1, 5, -1}, {0, 5, 1}}})}) {
    scenes::Scene scene = tests::shipped_scene("fusion");
    scene.lights[0].shape = shape;
    expect_twin(fmt::format("fusion {}", shape.index()), SoftStage(scene, device(), 32, 24));
  }
}

/// View samples on both sides of a light, and outside its frusta.
TEST_F(SoftIrregularTwin, LightsAmongTriangles) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> real(-1, 1);
  const auto point = [&] { return glm::dvec3(real(random), real(random), real(random)); };
  std::size_t outside = 0;
  for (int i = 0; i < 12; ++i) {
    scenes::Scene scene = tests::floor_and_light(0.5);
    std::vector<tests::Corners> soup;
    for (int k = 0; k < 16; ++k) soup.push_back({2.0 * point(), 2.0 * point(), 2.0 * point()});
    tests::add_object(scene, "soup", soup);
    scene.lights[0] = tests::rectangle_light(point(), 0.4 * point(), 0.3 * point());
    scene.lights[0].two_sided = true;
    const SoftStage stage(scene, device(), 24, 24);
    expect_twin(fmt::format("soup {}", i), stage, 0);
    const auto method = make_soft_irregular({});
    static_cast<void>(stage.run(*method));
    outside += method->counters().at("viewSamplesOutside");
  }
  EXPECT_GT(outside, 20U);
}

/// One board is exact. Of two boards, one behind the other, the map has only one layer: light that the nearer board's
/// outline gives back although the other board still hides it is a leak. umbra=layers has no leak where the boards do
/// not overlap on the light.
TEST_F(SoftIrregularTwin, StackedBoardsLeak) {
  scenes::Scene one = tests::floor_and_light(0.6);
  tests::add_object(one, "board", tests::quad({0, 1, 0}, {0.8, 0, 0}, {0, 0, -0.8}));
  scenes::Scene two = one;
  tests::add_object(two, "lower", tests::quad({0, 0.5, 0}, {2, 0, 0}, {0, 0, -2}));
  two.cameras[0] = tests::camera({0, 0.3, 4.5}, {0, 0, 0});  // below both boards
  const auto errors = [&](const scenes::Scene& scene, const char* umbra) {
    const SoftStage stage(scene, device(), 32, 32);
    const auto method = make_soft_irregular({{"umbra", umbra}});
    return tests::errors_of(stage.run(*method), stage.exact());
  };
  EXPECT_LE(errors(one, "map").largest, 1e-7);
  EXPECT_LE(errors(one, "layers").largest, 1e-7);
  EXPECT_GT(errors(two, "map").largest, 0.2);
  EXPECT_LE(errors(two, "layers").largest, errors(two, "map").largest);
}

/// With the silhouettes of each view sample, V equals the twin's; V of pixels that are not wanted is NaN.
TEST_F(SoftIrregularTwin, SilhouettesOfTheReceiver) {
  for (const char* name : {"broken", "contact", "fusion", "textured-light"}) {
    const SoftStage stage(tests::shipped_scene(name), device(), 24, 18);
    const Casters casters = casters_of(stage.floats, stage.light);
    const SoftVisibility soft(stage.floats, stage.light, casters);
    std::vector<std::uint32_t> wanted;
    for (std::uint32_t i = 3; i < stage.samples.size(); i += 2) wanted.push_back(i);
    const auto method = make_soft_irregular({{"umbra", "layers"}, {"arc", "tangent"}, {"silhouettes", "receiver"}});
    method->want_pixels(wanted);
    const std::vector<float> v = stage.run(*method, 5);
    for (std::uint32_t i = 0; i < v.size(); ++i) {
      if (!std::ranges::binary_search(wanted, i)) {
        EXPECT_TRUE(std::isnan(v[i])) << name << ", pixel " << i;
      } else if (visibility::is_receiver(stage.floats, stage.light, stage.samples, i)) {
        EXPECT_EQ(v[i], static_cast<float>(soft.at(stage.lit(i), Viewer::receiver).visibility)) << name << ", " << i;
      }
    }
  }
}

/// Compares with methods that use light samples, in judged pixels: counts by how many light samples soft-irregular's V
/// differs, rounded to whole samples.
class SoftIrregularUnion : public SoftIrregularTwin {
 protected:
  struct Compared {
    std::size_t penumbra = 0, samples_off = 0;
  };
  static Compared compare(const char* scene_name, std::uint32_t light_samples, const char* silhouettes,
                          visibility::Method& other) {
    const scenes::Scene scene = tests::shipped_scene(scene_name);
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    const visibility::Light light =
        visibility::make_light(scene, 0, floats.origin, {light_samples, 0, 0, visibility::SamplePattern::rows, 0});
    const visibility::ViewSamples samples =
        render::VisibilityBuffer(device(), floats)
            .render(visibility::make_camera(scene.cameras[0], floats.origin, 40, 40));
    const auto method = make_soft_irregular({{"umbra", "layers"}, {"fusion", "union"}, {"silhouettes", silhouettes}});
    const std::vector<float> joined = tests::run(*method, floats, light, samples).visibility;
    const std::vector<float> expected = tests::run(other, floats, light, samples).visibility;
    const auto classes = visibility::classify_pixels(floats, samples, light);
    Compared result;
    for (std::size_t i = 0; i < joined.size(); ++i) {
      if (classes[i] != visibility::PixelClass::judged) continue;
      result.penumbra += expected[i] > 0 && expected[i] < 1 ? 1U : 0U;
      const double off = std::abs(static_cast<double>(joined[i]) - static_cast<double>(expected[i]));
      result.samples_off += static_cast<std::size_t>(std::lround(off * light.sample_count()));
    }
    fmt::print("{}, {}: {} pixels in penumbra, {} light samples off\n", scene_name, silhouettes, result.penumbra,
               result.samples_off);
    return result;
  }
};

/// The silhouettes of the centre, at 16 points, give the counters of Forest et al. 2008. A light sample may be on an
/// edge within rounding.
TEST_F(SoftIrregularUnion, OfTheCentreIsForests) {
  for (const char* name : {"contact", "fusion", "bunny", "large-penumbra"}) {
    const auto forest = make_depth_complexity(device(), {{"variant", "forest"}});
    const Compared compared = compare(name, 16, "centre", *forest);
    EXPECT_GT(compared.penumbra, 20U) << name;
    EXPECT_LE(compared.samples_off, 1U) << name;
  }
}

/// The silhouettes of each view sample bound the layers that it sees: joined, these give the truth of each pair.
TEST_F(SoftIrregularUnion, OfTheReceiverIsTheTruthOfPairs) {
  for (const char* name : {"contact", "fusion", "broken"}) {
    const auto exact = vsm::make_hierarchical_penumbra({});
    const Compared compared = compare(name, 64, "receiver", *exact);
    EXPECT_GT(compared.penumbra, 20U) << name;
    EXPECT_LE(compared.samples_off, 1U) << name;
  }
}

TEST_F(SoftIrregularTwin, WhatItCannotDoIsRefused) {
  scenes::Scene scene = tests::floor_and_light(0.5);
  for (const scenes::LightShape& shape :
       {scenes::LightShape(scenes::Sphere{{0, 3, 0}, 0.5}), scenes::LightShape(scenes::Sun{{0, -1, 0}, 5})}) {
    scene.lights[0].shape = shape;
    const SoftStage stage(scene, device(), 8, 8);
    const auto method = make_soft_irregular({});
    EXPECT_THROW(static_cast<void>(stage.run(*method)), InputError);
  }
  EXPECT_THROW(make_soft_irregular({{"umbra", "both"}}), UsageError);
  EXPECT_THROW(make_soft_irregular({{"bias", "1"}}), UsageError);
  EXPECT_THROW(make_soft_irregular({{"fusion", "union"}}), UsageError) << "the map has one layer";
}

}  // namespace
}  // namespace penumbra::volumes
