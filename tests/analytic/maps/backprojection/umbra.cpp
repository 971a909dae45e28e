// SPDX-License-Identifier: Apache-2.0
// Tests umbrae: no light is left where the whole light is hidden, however many texels hide it. A search in too narrow a
// part of a map would leave light at the light's ends.

#include "tests/analytic/maps/backprojection_scenes.hpp"

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

class MapsUmbra : public MapsTest {
 protected:
  /// Expects that no pixel of the first two objects within 2 of the plane z = 0 sees more than `most` of the light.
  static void expect_dark(const Stage& stage, const Factory& factory, const MethodOptions& options, double most = 0) {
    const Masks found = run(factory, stage, options);
    std::size_t pixels = 0, lit = 0;
    double brightest = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const std::int32_t triangle = stage.samples.triangle[i];
      if (triangle < 0 || stage.floats.object[static_cast<std::size_t>(triangle)] > 1) continue;
      if (std::abs(static_cast<double>(stage.samples.p[i].z) + stage.floats.origin.z) > 2) continue;
      ++pixels;
      const double v = static_cast<double>(found.visibility[i]);
      lit += v > most ? 1 : 0;
      brightest = std::max(brightest, v);
    }
    EXPECT_GE(pixels, 9U);
    EXPECT_EQ(lit, 0U) << "of " << pixels << " up to " << brightest << ", search=" << options.at("search");
  }
};

// A kernel some 500 texels across: 2 % of it is more than the margin that tiles have for rounding and for reaching
// beyond a texel.
TEST_F(MapsUmbra, APlateThatIsManyTexelsWideHidesTheWholeLight) {
  scenes::Scene scene = bare_floor(1, 3);
  add_quad(scene, {0, 3, 0}, {2.1, 0, 0}, {0, 0, -2.1}).receives_shadow = false;
  const Stage stage = on_floor(scene, 3, light_samples(1024));
  for (const char* occluder : {"patch", "quad"}) {
    expect_dark(stage, maps::make_bitmask, {{"size", "1024"}, {"occluder", occluder}, {"search", "none"}});
  }
}

/// A floor, a wall at x = -6 that reaches above the light (so that the light's maps are hemicubes), and the light 5
/// above the floor.
scenes::Scene floor_and_wall() {
  scenes::Scene scene = bare_floor(0.5, 6);
  add_quad(scene, {-6, 3, 0}, {0, 0, 6}, {0, 3, 0}).casts_shadow = false;
  scene.cameras.front() = camera({3, 2.5, 0}, {-4, 1.2, 0}, 60);
  return scene;
}

// The light is in a box whose sides are parallel to the hemicube's and whose edges lie on the cube's: patches cover the
// bottom and one side without gaps. This holds for receivers that do not look over an edge from one side to another,
// where rounding now and then leaves a light sample. Bits show this for samples, sums for the whole light, with each
// patch's area to 2^-22.
TEST_F(MapsUmbra, ABoxOfTheHemicubesShapeHidesTheWholeLight) {
  scenes::Scene scene = floor_and_wall();
  const auto side = [&](const glm::dvec3& middle, const glm::dvec3& u, const glm::dvec3& v) {
    add_quad(scene, middle, u, v).receives_shadow = false;
  };
  side({0, 4, 0}, {1, 0, 0}, {0, 0, 1});
  for (const double at : {-1.0, 1.0}) {
    side({at, 4.75, 0}, {0, 0.75, 0}, {0, 0, 1});
    side({0, 4.75, at}, {0, 0.75, 0}, {1, 0, 0});
  }
  const Stage stage(scene, 12, 12, light_samples(1024));
  for (const char* search : {"none", "mssm"}) {
    expect_dark(stage, maps::make_bitmask, {{"size", "384"}, {"occluder", "patch"}, {"search", search}});
    expect_dark(stage, maps::make_backproject, {{"size", "384"}, {"fill", "none"}, {"search", search}}, 1e-3);
  }
}

// An object just in front of a wall, hardly higher than what it shades, is still in front of the wall's plane and above
// it, by less than 2 % of the distance to the light. (At this distance it is above by at least half a row of texels: a
// texel stands as high as its centre.)
TEST_F(MapsUmbra, WhatStandsJustBeforeAWallShadesIt) {
  static constexpr std::uint32_t kSide = 16;
  scenes::Scene scene = floor_and_wall();
  scene.objects.front().receives_shadow = false;
  add_quad(scene, {-5.95, 3, 0}, {0, 0, 6}, {0, 3, 0}).receives_shadow = false;
  const auto on_the_wall = [](const visibility::SceneFloats& floats, const visibility::PinholeCamera& /*camera*/) {
    visibility::ViewSamples samples;
    samples.width = samples.height = kSide;
    std::int32_t wall = 0;
    while (floats.object[static_cast<std::size_t>(wall)] != 1) ++wall;
    const auto corners = floats.corners(static_cast<std::uint32_t>(wall));
    const bool toward_x = glm::cross(corners[1] - corners[0], corners[2] - corners[0]).x > 0;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      const glm::dvec2 at = (glm::dvec2(i % kSide, i / kSide) + 0.5) / static_cast<double>(kSide);
      samples.triangle.push_back(wall);
      samples.p.emplace_back(glm::dvec3(-6, 0.3 + 2 * at.y, 4 * at.x - 2) - floats.origin);
      samples.n.emplace_back(1, 0, 0);
      samples.depth.push_back(1);
      samples.facing.push_back(toward_x ? 1 : -1);
    }
    return samples;
  };
  const Stage stage(scene, kSide, kSide, light_samples(64), on_the_wall);
  for (const char* search : {"none", "mssm"}) {
    expect_dark(stage, maps::make_bitmask, {{"size", "384"}, {"occluder", "patch"}, {"search", search}});
    expect_dark(stage, maps::make_backproject, {{"size", "384"}, {"fill", "none"}, {"search", search}});
  }
}

// A plate less than 1 % of its depth above a tilted plane, under a wide light that sees some 20 texels of a fine map
// around each place. Texels of the plate and of the plane are neighbours there: hierarchy nodes that hide light as a
// whole, because all they hold is in front of the receiver's plane, must not hold texels of both. The plane must not
// hide anything from itself either.
TEST_F(MapsUmbra, WhatLiesJustAboveATiltedPlaneHasOneOutlineInEveryWay) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {1.5, 0.9, 0}, {0, 0, -1.5});
  add_quad(scene, {0.5, 0.34, 0}, {0.4, 0.24, 0}, {0, 0, -0.5}).receives_shadow = false;
  scene.lights.push_back(ceiling_light(5, 2));
  scene.cameras.push_back(camera({-1, 4, 1}, {0.1, 0.07, 0}, 3));  // looks at an edge of the plate
  const Stage stage(scene, 10, 10, light_samples(1));
  const auto v = [&](const Factory& factory, MethodOptions options) {
    options["size"] = "1024";
    return run(factory, stage, options).visibility;
  };
  const std::vector<float> flat = v(maps::make_contour, {{"traversal", "flat"}, {"search", "none"}});
  EXPECT_EQ(v(maps::make_contour, {{"traversal", "hierarchy"}}), flat);
  EXPECT_EQ(v(maps::make_contour, {{"traversal", "minmax"}}), flat);
  EXPECT_EQ(v(maps::make_packet, {}), flat);
  std::size_t lit = 0, partly = 0;
  for (std::size_t i = 0; i < flat.size(); ++i) {
    if (stage.samples.triangle[i] < 0) continue;
    lit += flat[i] == 1 ? 1 : 0;
    partly += flat[i] > 0 && flat[i] < 1 ? 1 : 0;
  }
  EXPECT_GT(lit, 10U);
  EXPECT_GT(partly, 10U);
}

}  // namespace
}  // namespace penumbra::tests
