// Where all of the light is hidden no bit is left, however many texels it takes: whatever is looked for in too narrow a
// part of a map leaves some at the light's ends.

#include "tests/analytic/maps/backprojection_scenes.hpp"

namespace penumbra::tests {
namespace {

class MapsUmbra : public MapsTest {
 protected:
  /// Of the first two objects' pixels that are no farther than 2 beside the plane z = 0 none sees any of the light.
  static void expect_dark(const Stage& stage, const visibility::MethodOptions& options) {
    const Masks found = run(maps::make_bitmask, stage, options);
    std::size_t pixels = 0, lit = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const std::int32_t triangle = stage.samples.triangle[i];
      if (triangle < 0 || stage.floats.object[static_cast<std::size_t>(triangle)] > 1) continue;
      if (std::abs(static_cast<double>(stage.samples.p[i].z) + stage.floats.origin.z) > 2) continue;
      ++pixels;
      lit += found.visibility[i] > 0 ? 1 : 0;
    }
    EXPECT_GE(pixels, 9U);
    EXPECT_EQ(lit, 0U) << options.at("occluder") << ", search=" << options.at("search");
  }
};

// A kernel of some 500 texels across: what is 2 % of it is more than tiles leave themselves for rounding and for what
// reaches beyond a texel.
TEST_F(MapsUmbra, APlateThatIsManyTexelsWideHidesTheWholeLight) {
  scenes::Scene scene = bare_floor(1, 3);
  add_quad(scene, {0, 3, 0}, {2.1, 0, 0}, {0, 0, -2.1}).receives_shadow = false;
  const Stage stage = on_floor(scene, 3, light_samples(1024));
  for (const char* occluder : {"patch", "quad"}) {
    expect_dark(stage, {{"size", "1024"}, {"occluder", occluder}, {"search", "none"}});
  }
}

// The light in a box whose sides are parallel to the hemicube's and whose edges lie on the cube's: patches cover its
// bottom and one side without gaps, as receivers see it that do not look over an edge from one side to another, where
// rounding leaves a light sample now and then.
TEST_F(MapsUmbra, ABoxOfTheHemicubesShapeHidesTheWholeLight) {
  scenes::Scene scene = bare_floor(0.5, 6);
  add_quad(scene, {-6, 3, 0}, {0, 0, 6}, {0, 3, 0}).casts_shadow = false;  // up to beyond the light: hemicubes
  const auto side = [&](const glm::dvec3& middle, const glm::dvec3& u, const glm::dvec3& v) {
    add_quad(scene, middle, u, v).receives_shadow = false;
  };
  side({0, 4, 0}, {1, 0, 0}, {0, 0, 1});
  for (const double at : {-1.0, 1.0}) {
    side({at, 4.75, 0}, {0, 0.75, 0}, {0, 0, 1});
    side({0, 4.75, at}, {0, 0.75, 0}, {1, 0, 0});
  }
  scene.cameras.front() = camera({3, 2.5, 0}, {-4, 1.2, 0}, 60);
  const Stage stage(scene, 12, 12, light_samples(1024));
  for (const char* search : {"none", "mssm"}) {
    expect_dark(stage, {{"size", "384"}, {"occluder", "patch"}, {"search", search}});
  }
}

}  // namespace
}  // namespace penumbra::tests
