// SPDX-License-Identifier: Apache-2.0
// Tests forms of pcf that use less than every texel, or something else: extreme depths of a window (Pagot et al. 2004),
// its mean depth (Luft and Deussen 2006), object numbers (Brabec and Seidel 2002); and shadow-map's object test.

#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/centre_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace penumbra::tests {
namespace {

class PcfForms : public MapsTest {};

/// Depths in a window of the map around a receiver on a level floor, whose plane has the same depth at every texel.
struct Window {
  std::vector<double> depths;
  double own, forgiven;
};
Window window_around(const CentreMaps& drawn, const std::vector<float>& texels, const glm::vec3& p, int count) {
  const maps::gpu::LightView& view = drawn.fitted.views.front();
  const glm::dvec3 d = drawn.basis.local(p);
  const glm::dvec2 lower(view.side[0].lower),
      texel = (glm::dvec2(view.side[0].upper) - lower) / static_cast<double>(drawn.size);
  const glm::dvec2 first = glm::floor((glm::dvec2(d) / d.z - lower) / texel - 0.5 * count + 0.5);
  Window window{{}, d.z, 0.5 * std::max(texel.x, texel.y) * d.z};
  for (int k = 0; k < count * count; ++k) {
    const int x = static_cast<int>(first.x) + k % count, y = static_cast<int>(first.y) + k / count;
    const int size = static_cast<int>(drawn.size);
    const bool inside = x >= 0 && y >= 0 && x < size && y < size;
    window.depths.push_back(inside ? static_cast<double>(texels[static_cast<std::size_t>(y * size + x)]) *
                                         static_cast<double>(view.far)
                                   : static_cast<double>(view.far));
  }
  return window;
}

/// Two boards over a floor, so that a window may hold three depths.
Stage two_boards() {
  scenes::Scene scene = bare_floor(0.3);
  scene.objects.front().casts_shadow = true;
  add_quad(scene, {0.5, 2, 0}, {0.5, 0, 0}, {0, 0, 0.9}).receives_shadow = false;
  add_quad(scene, {-0.2, 3.2, 0.1}, {0.25, 0, 0}, {0, 0, 0.3}).receives_shadow = false;
  return on_floor(scene, 96, light_samples(1));
}

TEST_F(PcfForms, ExtremesAndMeansAreThoseOfTheWindow) {
  constexpr int kCount = 9;
  constexpr std::uint32_t kSize = 64;
  const Stage stage = two_boards();
  const CentreMaps drawn(device(), stage, kSize, glm::dvec2(8.0 * (kCount / 2) / kSize));
  const std::vector<float> texels = drawn.read();
  const visibility::MethodOptions common{{"size", "64"}, {"window", "9"}};
  const auto with = [&](visibility::MethodOptions more) {
    more.insert(common.begin(), common.end());
    return run(maps::make_pcf, stage, more);
  };
  const Masks two = with({{"keep", "2"}}), three = with({{"keep", "3"}}),
              mean = with({{"test", "mean"}, {"softness", "0.25"}});
  std::array<int, 4> levels{};
  std::size_t off = 0, soft = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    const Window window = window_around(drawn, texels, stage.samples.p[i], kCount);
    const auto [least, greatest] = std::ranges::minmax(window.depths);
    const auto lit = [&](double depth) { return depth < window.own - window.forgiven ? 0 : 1; };
    const double far = static_cast<double>(drawn.fitted.views.front().far), half = 0.5 * (least + greatest);
    const double middle = *std::ranges::min_element(window.depths, {}, [&](double depth) {
      return std::abs(depth - half) + (depth > half ? far * 0x1p-20 : 0.0);  // a tie goes to the lesser depth
    });
    const double of_two = (lit(least) + lit(greatest)) / 2.0,
                 of_three = (lit(least) + lit(greatest) + lit(middle)) / 3.0;
    double sum = 0;
    for (const double depth : window.depths) sum += std::min(depth, window.own);
    const double behind = (window.own - sum / kCount / kCount - window.forgiven) / (0.25 * window.own),
                 x = std::clamp(behind, 0.0, 1.0), smooth = 1 - x * x * (3 - 2 * x);
    // A place within rounding of a texel's border may get the neighbouring window.
    const bool same = std::abs(static_cast<double>(two.visibility[i]) - of_two) < 1e-6 &&
                      std::abs(static_cast<double>(three.visibility[i]) - of_three) < 1e-6 &&
                      std::abs(static_cast<double>(mean.visibility[i]) - smooth) < 1e-4;
    off += same ? 0 : 1;
    soft += smooth > 0.01 && smooth < 0.99 ? 1 : 0;
    ++levels.at(static_cast<std::size_t>(std::lround(3 * of_three)));
  }
  EXPECT_LE(off, stage.samples.size() / 200);
  EXPECT_GT(soft, 500U);
  for (const int count : levels) EXPECT_GT(count, 20);
}

/// No object shades itself: without any bias, and compared with the receiver's own depth, a ball is lit where the
/// light's centre is above its horizon, and it still casts its shadow on the floor.
TEST_F(PcfForms, ObjectsDoNotShadeThemselves) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
  add_object(scene, "ball", sphere({0.1, 1, 0}, 0.5, 16));
  scene.lights.push_back(ceiling_light(5, 0.3));
  scene.cameras.push_back(camera({0, 4, 4}, {0, 0.4, 0}));
  const Stage stage(scene, 64, 64, light_samples(1));
  const visibility::MethodOptions bare{{"size", "128"}, {"bias", "0"}, {"receiverPlane", "off"}};
  visibility::MethodOptions by_object = bare;
  by_object["test"] = "object";
  const Masks acne = run(maps::make_pcf, stage, bare), clean = run(maps::make_pcf, stage, by_object),
              hard = run(maps::make_shadow_map, stage, {{"size", "128"}, {"test", "object"}});
  std::size_t ball = 0, dark = 0, shaded = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (stage.samples.triangle[i] < 0) continue;
    const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin, to = glm::dvec3(0, 5, 0) - p;
    if (stage.floats.object[static_cast<std::size_t>(stage.samples.triangle[i])] == 0) {
      // The middle of the shadow: places whose ray to the light passes the ball's middle within half its radius.
      const double t = glm::dot(glm::dvec3(0.1, 1, 0) - p, to) / glm::dot(to, to);
      if (glm::distance(p + t * to, glm::dvec3(0.1, 1, 0)) > 0.25) continue;
      ++shaded;
      EXPECT_EQ(clean.visibility[i], 0);
      EXPECT_EQ(hard.visibility[i], 0);
    } else if (glm::dot(glm::dvec3(stage.samples.n[i]), to) > 0.3 * glm::length(to)) {
      ++ball;
      dark += acne.visibility[i] < 0.9F ? 1 : 0;
      EXPECT_EQ(clean.visibility[i], 1);
      EXPECT_EQ(hard.visibility[i], 1);
    }
  }
  EXPECT_GT(ball, 100U);
  EXPECT_GT(dark, ball / 2);
  EXPECT_GT(shaded, 10U);
}

TEST_F(PcfForms, WhatMeansNothingTogetherIsRefused) {
  for (const visibility::MethodOptions& options : {visibility::MethodOptions{{"keep", "1"}},
                                                   {{"keep", "2"}, {"taps", "9"}},
                                                   {{"keep", "3"}, {"weights", "gaussian"}},
                                                   {{"keep", "2"}, {"test", "mean"}},
                                                   {{"test", "mean"}, {"weights", "bilinear"}},
                                                   {{"test", "object"}, {"fit", "cascades"}}})
    EXPECT_THROW(std::ignore = maps::make_pcf(device(), options), UsageError);
}

}  // namespace
}  // namespace penumbra::tests
