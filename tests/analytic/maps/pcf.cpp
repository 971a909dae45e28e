// SPDX-License-Identifier: Apache-2.0
// Tests pcf with a fixed window of texels: its widths, levels and self-shadowing are known in closed form.

#include "maps/filters/methods.hpp"

#include "tests/analytic/maps/centre_maps.hpp"

#include <fmt/format.h>

#include <cmath>

namespace penumbra::tests {
namespace {

class Pcf : public MapsTest {
 protected:
  static visibility::MethodOptions window(std::uint32_t n, std::uint32_t size = 1024) {
    return {{"window", fmt::format("{}", n)}, {"size", fmt::format("{}", size)}};
  }
};

/// A floor at height 0 and a board above it, from x = edge to far beyond the floor, under a light at height 2.
scenes::Scene under_a_board(double height, double edge, double half_light) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, 2});
  if (height > 0) add_quad(scene, {edge + 4, height, 0}, {4, 0, 0}, {0, 0, 4}).receives_shadow = false;
  scene.lights.push_back(ceiling_light(2, half_light));
  scene.cameras.push_back(camera({0, 1, 3}, {0, 0, 0}));
  return scene;
}

// Eisemann et al. 2009, section 4.1.2: the window depends neither on the occluder nor on the light. Around the hard
// shadow's edge V rises over n texels, each t z wide on the floor, linearly up to steps of one texel.
TEST_F(Pcf, ThePenumbraIsTheWindowWhateverTheBlockersHeightAndTheLightsSize) {
  constexpr std::uint32_t kSamples = 2048, kSize = 256;
  for (const std::uint32_t n : {7U, 8U, 21U}) {
    for (const double z : {0.3, 1.0, 1.7}) {
      const double height = 2 - z, edge = 0.05 * z;  // its shadow begins at x = 0.1
      std::vector<float> first;
      for (const double half_light : {0.1, 0.5, 1.0}) {
        const auto line = [](const visibility::SceneFloats& floats, const visibility::PinholeCamera& /*camera*/) {
          visibility::ViewSamples samples;
          samples.width = kSamples;
          samples.height = 1;
          for (std::uint32_t i = 0; i < kSamples; ++i) {
            samples.triangle.push_back(0);
            samples.p.emplace_back(glm::dvec3(-1 + 2.0 * i / kSamples, 0, 0.003) - floats.origin);
            samples.n.emplace_back(0, 1, 0);
            samples.depth.push_back(1);
            samples.facing.push_back(1);
          }
          return samples;
        };
        const Stage stage(under_a_board(height, edge, half_light), kSamples, 1, light_samples(1), line);
        const Masks found = run(maps::make_pcf, stage, window(n, kSize));
        if (first.empty()) first = found.visibility;
        EXPECT_EQ(found.visibility, first) << "light " << half_light;
        // A texel's width on the floor at distance 2; the window is ±1 in x/z, plus the filter's reach beside it.
        const int reach = n / 2;
        const CentreMaps maps(device(), stage, kSize, glm::dvec2(8.0 * reach / kSize));
        const auto& side = maps.fitted.views.front().side[0];
        const double texel = 2.0 * static_cast<double>(side.upper.x - side.lower.x) / kSize;
        const auto place_of = [&](double share) {  // V falls along x
          std::size_t i = 0;
          while (i<kSamples&& static_cast<double>(found.visibility[i])> share) ++i;
          return -1 + 2.0 * static_cast<double>(i) / kSamples;
        };
        // Steps of 1/n are a texel apart: a level is reached within half a texel of where a ramp would reach it, and up
        // to a sample's spacing later.
        const double spacing = 2.0 / kSamples;
        EXPECT_NEAR(place_of(0.1) - place_of(0.9), 0.8 * n * texel, texel + spacing) << n << " at z " << z;
        // Rows of texels may begin anywhere, so the edge is where the rasteriser puts it, up to half a texel off; an
        // even window's centre is half a texel off.
        EXPECT_NEAR(place_of(0.5), 0.1, texel + spacing) << n << " at z " << z;
      }
    }
  }
}

// Eisemann et al. 2009, figure 4.3: if all texels are compared with the receiver's own depth, one half of a tilted
// window shades the other.
TEST_F(Pcf, ATiltedReceiverShadesHalfOfItselfUnlessItsPlaneIsFollowed) {
  constexpr std::uint32_t kSide = 40, kSize = 256;
  for (const double tilt : {30.0, 60.0}) {
    const double angle = tilt * 0.017453292519943295;
    const glm::dvec3 along(std::cos(angle), std::sin(angle), 0), up(-std::sin(angle), std::cos(angle), 0);
    scenes::Scene scene;
    add_quad(scene, {0, 0, 0}, along, {0, 0, -1});
    scene.lights.push_back(ceiling_light(5, 0.5));
    scene.cameras.push_back(camera({0, 3, 3}, {0, 0, 0}));
    // The samples are away from the border by more than the widest window.
    const Stage stage(scene, kSide, kSide, light_samples(1),
                      grid_samples(kSide, {0, 0, 0}, 0.8 * along, {0, 0, 0.8}, up));
    for (const std::uint32_t n : {1U, 3U, 7U, 15U}) {
      visibility::MethodOptions options = window(n, kSize);
      const Masks followed = run(maps::make_pcf, stage, options);
      options["receiverPlane"] = "off";
      options["bias"] = "0";
      const Masks found = run(maps::make_pcf, stage, options);
      const CentreMaps maps(device(), stage, kSize);
      const auto& side = maps.fitted.views.front().side[0];
      std::size_t more = 0, less = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        EXPECT_EQ(followed.visibility[i], 1.0F) << "pixel " << i;
        const glm::dvec3 d = maps.basis.local(glm::dvec3(stage.samples.p[i]));
        // Depth changes along one axis only. The receiver's own column of texels is nearer to the light than the
        // receiver if its centre is on the side where the plane rises toward the light: then (n − 1) / 2 of n columns
        // are lit, otherwise (n + 1) / 2.
        const int axis = std::abs(maps.basis.u.x) > 0.5 ? 0 : 1;
        const double texel = static_cast<double>(side.upper[axis] - side.lower[axis]) / kSize;
        const double at = (d[axis] / d.z - static_cast<double>(side.lower[axis])) / texel, part = at - std::floor(at);
        if (std::abs(part - 0.5) < 0.02 || std::min(part, 1 - part) < 0.02) continue;  // rounding of p and of depths
        const bool rises = (axis == 0 ? maps.basis.u.x : maps.basis.v.x) > 0;          // depth falls as x grows
        const bool own_is_lit = (part < 0.5) != rises;
        const std::uint32_t columns = own_is_lit ? (n + 1) / 2 : (n - 1) / 2;
        EXPECT_EQ(found.visibility[i], static_cast<float>(columns * n) / static_cast<float>(n * n)) << "pixel " << i;
        (own_is_lit ? more : less) += 1;
      }
      EXPECT_GT(std::min(more, less), stage.samples.size() / 4) << tilt << ", " << n;
    }
  }
}

/// A floor, a sphere and a wall of height `wall`; where the wall reaches the light, maps are hemicubes.
scenes::Scene sphere_and_wall(double wall, bool two_sided) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3});
  add_object(scene, "sphere", sphere({0.3, 1, 0.2}, 0.6, 8));
  add_quad(scene, {3, wall / 2, 0}, {0, wall / 2, 0}, {0, 0, 3});
  scene.lights.push_back(ceiling_light(4, 0.5));
  scene.lights.back().two_sided = two_sided;
  scene.cameras.push_back(camera({-3, 3, 6}, {0.5, 1.5, 0}));
  return scene;
}

TEST_F(Pcf, AWindowOfOneTexelIsTheShadowMap) {
  for (const double wall : {1.0, 5.0}) {
    const Stage stage(sphere_and_wall(wall, wall > 4), 48, 48, light_samples(1));
    const Masks hard = run(maps::make_shadow_map, stage, {{"size", "128"}});
    const Masks found = run(maps::make_pcf, stage, window(1, 128));
    EXPECT_EQ(found.visibility, hard.visibility) << "wall " << wall;
  }
}

TEST_F(Pcf, LevelsAreWholeTexelsOfTheWindow) {
  for (const std::uint32_t n : {2U, 7U, 12U}) {
    const Stage stage(sphere_and_wall(5, true), 48, 48, light_samples(1));
    const Masks found = run(maps::make_pcf, stage, window(n, 128));
    std::size_t between = 0;
    for (const float v : found.visibility) {
      const auto texels = static_cast<float>(n * n);
      EXPECT_EQ(v, std::round(v * texels) / texels);
      between += v > 0 && v < 1 ? 1 : 0;
    }
    EXPECT_GT(between, 5U);
  }
}

// In a hemicube a window continues on the next face: no seams show on a floor without shadows.
TEST_F(Pcf, WindowsGoOnAcrossTheFacesOfAHemicube) {
  scenes::Scene scene = sphere_and_wall(5, false);
  scene.objects[1].casts_shadow = false;
  const Stage stage(scene, 64, 64, light_samples(1));
  const Masks found = run(maps::make_pcf, stage, window(9, 64));
  std::size_t floor = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    const std::int32_t triangle = stage.samples.triangle[i];
    if (triangle < 0 || stage.floats.object[static_cast<std::size_t>(triangle)] != 0) continue;
    // At the wall's foot, windows contain the wall, which is nearer to the light than the floor's plane continued.
    const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
    if (p.x > 2) continue;
    ++floor;
    EXPECT_EQ(found.visibility[i], 1.0F) << p.x << " " << p.z;
  }
  EXPECT_GT(floor, 300U);
}

// V is the sum of the weights of all columns beyond the edge, if a board's straight edge runs along the texels.
TEST_F(Pcf, WeightsAreThoseOfTheirNames) {
  constexpr std::uint32_t kSamples = 512, kSize = 64;
  const auto line = [](const visibility::SceneFloats& floats, const visibility::PinholeCamera& /*camera*/) {
    visibility::ViewSamples samples;
    samples.width = kSamples;
    samples.height = 1;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      samples.triangle.push_back(0);
      samples.p.emplace_back(glm::dvec3(-0.5 + 1.0 * i / kSamples, 0, 0.003) - floats.origin);
      samples.n.emplace_back(0, 1, 0);
      samples.depth.push_back(1);
      samples.facing.push_back(1);
    }
    return samples;
  };
  const Stage stage(under_a_board(1, 0.05, 0.1), kSamples, 1, light_samples(1), line);
  for (const std::uint32_t n : {1U, 4U, 7U}) {
    const int reach = static_cast<int>(n / 2);
    for (const bool bilinear : {false, true}) {
      visibility::MethodOptions options = window(n, kSize);
      options["weights"] = bilinear ? "bilinear" : "gaussian";
      const Masks found = run(maps::make_pcf, stage, options);
      const CentreMaps maps(device(), stage, kSize, glm::dvec2(8.0 * (reach + (bilinear ? 1 : 0)) / kSize));
      const auto& side = maps.fitted.views.front().side[0];
      const int axis = std::abs(maps.basis.u.x) > 0.5 ? 0 : 1;
      const double texel = static_cast<double>(side.upper[axis] - side.lower[axis]) / kSize;
      const bool forward = (axis == 0 ? maps.basis.u.x : maps.basis.v.x) > 0;
      const auto column_of = [&](double x_over_z) {
        return ((forward ? x_over_z : -x_over_z) - static_cast<double>(side.lower[axis])) / texel;
      };
      // The board covers columns whose centres are beyond its edge, at x = 0.05 and depth 1.
      const double edge = column_of(0.05);
      const auto dark = [&](double column) { return forward ? column + 0.5 > edge : column + 0.5 < edge; };
      std::size_t between = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        const glm::dvec3 d = maps.basis.local(glm::dvec3(stage.samples.p[i]));
        const double at = (d[axis] / d.z - static_cast<double>(side.lower[axis])) / texel;
        const double to_border = std::abs(at - std::round(at)), to_half = std::abs(at - std::floor(at) - 0.5);
        if (std::min(to_border, to_half) < 1e-3) continue;  // rounding may choose another column
        double lit = 0, all = 0;
        if (bilinear) {
          const double first = at - 0.5 * n, last = at + 0.5 * n;
          for (double c = std::floor(first); c < last; ++c) {
            const double weight = std::min(c + 1, last) - std::max(c, first);
            all += weight;
            lit += dark(c) ? 0 : weight;
          }
        } else {
          const double first = std::floor(at - 0.5 * n + 0.5);
          for (std::uint32_t k = 0; k < n; ++k) {
            const double beside = k - 0.5 * (n - 1.0), weight = std::exp(-0.5 * beside * beside / (n * n / 16.0));
            all += weight;
            lit += dark(first + k) ? 0 : weight;
          }
        }
        EXPECT_NEAR(static_cast<double>(found.visibility[i]), lit / all, 2e-4) << n << ", sample " << i;
        between += lit > 0 && lit < all ? 1 : 0;
      }
      if (n > 1 || bilinear) {
        EXPECT_GT(between, n * 4) << n;
      }
    }
  }
}

// Uralsky 2005: with stages, more taps are read only where the outermost taps disagree; rotated patterns have the
// window's mean.
TEST_F(Pcf, SpreadTapsHaveTheWindowsMean) {
  const Stage stage(sphere_and_wall(1, false), 64, 64, light_samples(1));
  const auto found = [&](const char* taps, const char* stages) {
    visibility::MethodOptions options = window(9, 256);
    options["taps"] = taps;
    options["stages"] = stages;
    return run(maps::make_pcf, stage, options).visibility;
  };
  const std::vector<float> all = found("0", "1"), few = found("16", "1"), many = found("128", "1"),
                           staged = found("128", "2");
  const auto off = [&](const std::vector<float>& a, const std::vector<float>& b) {
    return rmse(
        stage, [](std::size_t) { return true; }, [&](std::size_t i) { return static_cast<double>(a[i] - b[i]); });
  };
  EXPECT_LT(off(many, all), 0.03);
  EXPECT_LT(off(many, all), off(few, all));
  EXPECT_LT(off(staged, many), 0.03);
  std::size_t changed = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (staged[i] == many[i]) continue;
    ++changed;  // the outermost taps agreed, others did not
    EXPECT_TRUE(staged[i] == 0.0F || staged[i] == 1.0F);
  }
  EXPECT_LT(changed, all.size() / 20);
  EXPECT_EQ(found("16", "1"), few) << "the pattern is the receiver's, whatever the run";
  EXPECT_THROW(maps::make_pcf(device(), {{"taps", "4"}, {"weights", "bilinear"}}), UsageError);
}

// A texel's centre is up to half a texel from a receiver along both axes: a polygon offset of factor 1 is the change of
// the plane's depth over a texel, so that a tilted plane no longer shades itself. A caster at half the height still
// shades.
TEST_F(Pcf, APolygonOffsetKeepsATiltedPlaneLit) {
  constexpr std::uint32_t kSide = 40;
  for (const double tilt : {30.0, 60.0}) {
    const double angle = tilt * 0.017453292519943295;
    const glm::dvec3 along(std::cos(angle), std::sin(angle), 0), up(-std::sin(angle), std::cos(angle), 0);
    scenes::Scene scene;
    add_quad(scene, {0, 0, 0}, along, {0, 0, -1});
    scene.lights.push_back(ceiling_light(5, 0.5));
    scene.cameras.push_back(camera({0, 3, 3}, {0, 0, 0}));
    const Stage stage(scene, kSide, kSide, light_samples(1),
                      grid_samples(kSide, {0, 0, 0}, 0.8 * along, {0, 0, 0.8}, up));
    for (const Factory& make : {Factory(maps::make_shadow_map), Factory(maps::make_pcf)}) {
      visibility::MethodOptions options{{"size", "256"}, {"receiverPlane", "off"}, {"bias", "0"}, {"offsetUnits", "8"}};
      const auto mean = [&](const Masks& masks) {
        double sum = 0;
        for (const float v : masks.visibility) sum += static_cast<double>(v);
        return sum / static_cast<double>(masks.visibility.size());
      };
      EXPECT_LT(mean(run(make, stage, options)), 0.7) << "units alone";
      // pcf's window of 7 reads texels three and a half away.
      options["offsetFactor"] = "4.5";
      EXPECT_EQ(mean(run(make, stage, options)), 1.0) << tilt;
      options["rasteriser"] = "opengl";
      EXPECT_EQ(mean(run(make, stage, options)), 1.0) << tilt << ", OpenGL";
    }
    visibility::MethodOptions least{
        {"size", "256"}, {"receiverPlane", "off"}, {"bias", "0"}, {"offsetUnits", "8"}, {"offsetFactor", "0.51"}};
    for (const float v : run(maps::make_shadow_map, stage, least).visibility) EXPECT_EQ(v, 1.0F);
    least["depth"] = "dual";
    EXPECT_THROW(maps::make_shadow_map(device(), least), UsageError);
  }
  // The offset forgives no more than that: a board 0.3 above a floor still shades it.
  const auto grid = grid_samples(16, {0.6, 0, 0}, {0.3, 0, 0}, {0, 0, 0.3}, {0, 1, 0});
  const Stage stage(under_a_board(0.3, 0.05, 0.1), 16, 16, light_samples(1), grid);
  const Masks found =
      run(maps::make_shadow_map, stage, {{"size", "256"}, {"receiverPlane", "off"}, {"offsetFactor", "4"}});
  for (const float v : found.visibility) EXPECT_EQ(v, 0.0F);
}

}  // namespace
}  // namespace penumbra::tests
