// SPDX-License-Identifier: Apache-2.0
// Tests how many maps adaptive-light takes, and what refines them.

#include "tests/analytic/maps/adaptive_light.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <set>

namespace penumbra::tests {
namespace {

TEST_F(AdaptiveLight, FewerMapsForLargerTolerances) {
  const Stage stage(sphere_scene(0.5), 48, 48, light_samples(4));
  for (const char* compare : {"camera", "light"}) {
    std::uint64_t last = 81;
    std::set<std::uint64_t> counts;
    for (const char* epsilon : {"0", "0.0001", "0.001", "0.003", "0.01", "0.03", "0.1", "1"}) {
      const std::uint64_t maps = adaptive(stage, {{"epsilon", epsilon}, {"compare", compare}}).maps;
      EXPECT_LE(maps, last) << "epsilon " << epsilon;
      EXPECT_GE(maps, 4U);
      counts.insert(last = maps);
    }
    EXPECT_EQ(last, 4U);
    EXPECT_GT(counts.size(), 2U);
    last = 81;
    counts.clear();
    for (const char* gamma : {"0", "0.01", "0.02", "0.1", "0.5", "1"}) {
      const std::uint64_t maps = adaptive(stage, {{"gamma", gamma}, {"epsilon", "0.01"}, {"compare", compare}}).maps;
      fmt::print("{} gamma {}: {} maps\n", compare, gamma, maps);
      EXPECT_LE(maps, last) << "gamma " << gamma;
      EXPECT_GE(maps, 4U);
      counts.insert(last = maps);
    }
    EXPECT_GT(counts.size(), 1U);
  }
  const std::uint64_t bounded = adaptive(stage, {{"epsilon", "0"}, {"maps", "20"}}).maps;
  EXPECT_LE(bounded, 20U);
  EXPECT_GT(bounded, 20U - 5);
}

// Equation 7 at one pixel: two boards whose distances from the light are as 1 : 1.1, each of them seen from one corner.
TEST_F(AdaptiveLight, HeightsDifferFromGammaOn) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {0.5, 0, 0}, {0, 0, -0.5});
  // The light, at height 5, is 2 wide along x. In the direction of its left end the floor sees a board at 2, in that of
  // its right end one at 2.3: 3 and 2.7 below the light.
  add_quad(scene, {-4.2, 2, 0}, {4, 0, 0}, {0, 0, 4}).receives_shadow = false;
  add_quad(scene, {4.2, 2.3, 0}, {4, 0, 0}, {0, 0, 4}).receives_shadow = false;
  scene.lights.push_back(rectangle_light({0, 5, 0}, {1, 0, 0}, {0, 0, 0.1}));
  scene.cameras.push_back(camera({0, 1.5, 0}, {0, 0, -0.001}, 10));
  const Stage stage(scene, 8, 8, light_samples(1));
  for (std::size_t i = 0; i < stage.samples.size(); ++i) ASSERT_TRUE(on_floor(stage, i));
  const auto maps = [&](const char* gamma, const char* epsilon = "0.5") {
    return adaptive(stage, {{"levels", "1"},
                            {"epsilon", epsilon},
                            {"gamma", gamma},
                            {"form", "line"},
                            {"shareOf", "pixels"},
                            {"bias", "0.1"}})
        .maps;
  };
  // |1 - 3 / 2.7| = 0.111: the first point of a pair is the one with the lower coordinate.
  EXPECT_EQ(maps("0.110"), 3U);
  EXPECT_EQ(maps("0.112"), 2U);
  EXPECT_EQ(maps("0.110", "1"), 3U) << "all pixels differ: not less than all of them";
}

TEST_F(AdaptiveLight, EpsilonIsAShareOfTheMapsTexelsOrOfThePixels) {
  const Stage stage(sphere_scene(0.5), 48, 48, light_samples(4));
  // 48^2 pixels are 0.1406 of 128^2 texels, so that no larger share of the texels can differ.
  EXPECT_EQ(adaptive(stage, {{"epsilon", "0.141"}, {"gamma", "0"}}).maps, 4U);
  EXPECT_EQ(adaptive(stage, {{"epsilon", "0.141"}, {"gamma", "0"}, {"shareOf", "pixels"}}).maps, 81U);
}

// A camera far away sees few pixels of penumbra, so the published criterion stops too early (section 5.1 of the paper).
// Compared from the light, the camera's distance makes no difference.
TEST_F(AdaptiveLight, FromFarAwayOnlyTheLightsOwnViewRefines) {
  const Stage near(sphere_scene(0.5), 64, 64, light_samples(4)), far(sphere_scene(0.5, 4), 64, 64, light_samples(4));
  const MethodOptions camera{{"epsilon", "0.007"}}, light{{"epsilon", "0.007"}, {"compare", "light"}};
  const Run close_up = adaptive(near, camera), distant = adaptive(far, camera);
  EXPECT_EQ(distant.maps, 4U);
  EXPECT_GT(close_up.maps, 20U);
  EXPECT_EQ(adaptive(near, light).maps, adaptive(far, light).maps);
  EXPECT_GT(adaptive(far, light).maps, 4U);
  const auto in_penumbra = [&](const Stage& stage, const Run& found) {
    const Masks truth = exact(stage);
    return rmse(
        stage, [&](std::size_t i) { return on_floor(stage, i) && truth.visibility[i] > 0 && truth.visibility[i] < 1; },
        [&](std::size_t i) {
          return static_cast<double>(found.picture.visibility[i]) - static_cast<double>(truth.visibility[i]);
        });
  };
  const double near_error = in_penumbra(near, close_up), far_error = in_penumbra(far, distant);
  fmt::print("maps near {} far {}; RMSE in the penumbra {:.4f}, {:.4f}\n", close_up.maps, distant.maps, near_error,
             far_error);
  EXPECT_GT(far_error, 2 * near_error);
}

// Where penumbrae are small, fewer adaptive maps are as good as 128 fixed ones; larger lights need more maps.
TEST_F(AdaptiveLight, MapsGrowWithThePenumbraAndAreFewForSmallLights) {
  std::uint64_t last = 4;
  for (const double half : {0.1, 0.5, 2.0}) {
    const Stage stage(sphere_scene(half), 64, 64, light_samples(128));
    const Run found = adaptive(stage, {{"epsilon", "0.0018"}, {"size", "256"}});
    const Masks truth = exact(stage), fixed = run(maps::make_accumulate, stage, {{"size", "256"}});
    const double adaptive_error = floor_rmse(stage, found.picture, truth),
                 fixed_error = floor_rmse(stage, fixed, truth);
    fmt::print("light half {}: {} maps, RMSE {:.5f}; 128 fixed maps {:.5f}\n", half, found.maps, adaptive_error,
               fixed_error);
    EXPECT_GE(found.maps, last);
    last = found.maps;
    if (half == 0.1) {
      EXPECT_LE(found.maps, 64U);
      EXPECT_LE(adaptive_error, 1.3 * fixed_error);
    }
  }
  EXPECT_EQ(last, 81U);
}

// Figure 4 of the paper: a tilted receiver stretches the penumbra.
TEST_F(AdaptiveLight, ATiltedReceiverNeedsMoreMaps) {
  std::uint64_t last = 4;
  for (const double degrees : {0.0, 30.0, 60.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    scenes::Scene scene;
    const glm::dvec3 along(std::cos(angle), -std::sin(angle), 0);
    add_quad(scene, glm::dvec3(0, -3 * std::sin(angle), 0), 4.0 * along, {0, 0, -4});
    add_quad(scene, {0, 2.5, 0}, {0.6, 0, 0}, {0, 0, 0.6}).receives_shadow = false;
    scene.lights.push_back(ceiling_light(5, 0.3));
    const glm::dvec3 up(std::sin(angle), std::cos(angle), 0);
    scene.cameras.push_back(camera(7.0 * up + glm::dvec3(0, 0, 3), {0, -2 * std::sin(angle), 0}, 60));
    const Stage stage(scene, 64, 64, light_samples(1));
    const std::uint64_t maps = adaptive(stage, {{"epsilon", "0.01"}, {"gamma", "0.1"}}).maps;
    fmt::print("receiver tilted by {}: {} maps\n", degrees, maps);
    EXPECT_GE(maps, last);
    last = maps;
  }
  EXPECT_GT(last, 14U);
}

// By default epsilon is a share of the pixels. In the paper it is a share of a map's texels, which can be more pixels
// than a small picture has: such pictures keep their four maps.
TEST_F(AdaptiveLight, ByDefaultPicturesOfAnySizeAreRefinedAlike) {
  for (const double half : {0.04, 0.15}) {
    std::vector<std::uint64_t> found, published;
    for (const std::uint32_t side : {24U, 48U, 96U}) {
      const Stage stage(sphere_scene(half), side, side, light_samples(4));
      const auto method = maps::make_adaptive_light(device(), {{"size", "128"}});
      run(*method, stage);
      found.push_back(method->counters().at("maps"));
      published.push_back(adaptive(stage, {{"epsilon", "0.01"}}).maps);
      fmt::print("light half {}, {} pixels a side: {} maps, of a map's texels {}\n", half, side, found.back(),
                 published.back());
    }
    const auto [fewest, most] = std::ranges::minmax(found);
    EXPECT_LE(static_cast<double>(most), 1.5 * static_cast<double>(fewest)) << half;
    EXPECT_GT(fewest, 4U) << half;
    EXPECT_EQ(published.front(), 4U) << half;
  }
}

// Reeves, Salesin and Cook 1987: hard shadows are interpolated bilinearly between the four texels around a receiver.
// For a light without size all maps are equal, and under a half-plane V is a ramp between the two columns of texels on
// either side of its edge.
TEST_F(AdaptiveLight, TheFilterIsARampBetweenTwoTexels) {
  constexpr std::uint32_t kSize = 64;
  for (const bool along_z : {false, true}) {
    scenes::Scene scene = bare_floor(1e-6, 2);
    const glm::dvec3 away = along_z ? glm::dvec3(0, 0, 3) : glm::dvec3(3, 0, 0),
                     along = along_z ? glm::dvec3(3, 0, 0) : glm::dvec3(0, 0, 3);
    add_quad(scene, glm::dvec3(0, 2, 0) + away, away, along).receives_shadow = false;  // occupies the side beyond 0
    const auto places = [&](const visibility::SceneFloats& floats, const visibility::PinholeCamera& /*camera*/) {
      visibility::ViewSamples samples;
      samples.width = 300;
      samples.height = 1;
      for (int i = 0; i < 300; ++i) {
        const double at = 0.3 * (2 * i - 299) / 300;
        samples.triangle.push_back(0);
        samples.p.emplace_back(glm::dvec3(along_z ? 0.013 : at, 0, along_z ? at : 0.013) - floats.origin);
        samples.n.emplace_back(0, 1, 0);
        samples.depth.push_back(1);
        samples.facing.push_back(1);
      }
      return samples;
    };
    const Stage stage(scene, 300, 1, light_samples(1), places);
    const Run found = adaptive(stage, {{"size", fmt::format("{}", kSize)}, {"levels", "0"}});
    EXPECT_EQ(found.maps, 4U);
    const maps::LightBasis basis = maps::light_basis(stage.light);
    const glm::vec3 centre(basis.center);
    const auto fitted = maps::fit_views(stage.floats, stage.light, basis, std::span(&centre, 1), {.size = kSize});
    const auto& side = fitted.views.front().side[0];
    const int axis = std::abs(glm::dot(basis.u, away)) > 1 ? 0 : 1;
    const double sign = glm::dot(axis == 0 ? basis.u : basis.v, away) > 0 ? 1 : -1;
    const double lower = side.lower[axis], texel = (static_cast<double>(side.upper[axis]) - lower) / kSize;
    // The edge is at 0; a column whose centre is beyond it is dark.
    const auto lit = [&](double column) { return sign * (lower + (column + 0.5) * texel) < 0 ? 1.0 : 0.0; };
    std::size_t between = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const glm::dvec3 d = basis.local(glm::dvec3(stage.samples.p[i]));
      const double at = (d[axis] / d.z - lower) / texel - 0.5, first = std::floor(at), part = at - first;
      const double expected = lit(first) + part * (lit(first + 1) - lit(first));
      EXPECT_NEAR(found.picture.visibility[i], expected, 1e-3) << i;
      between += expected > 0.05 && expected < 0.95 ? 1 : 0;
    }
    EXPECT_GT(between, 20U);
  }
}

}  // namespace
}  // namespace penumbra::tests
