// SPDX-License-Identifier: Apache-2.0
// Tests what the error budget relies on: methods that should differ in one respect only do differ in that only.

#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/parallel_square.hpp"
#include "tests/analytic/maps/backprojection/patch_twin.hpp"

#include "visibility/lights/light_parts.hpp"

#include <algorithm>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

class MapsRepairs : public MapsTest {
 protected:
  static Masks project(const Stage& stage, MethodOptions options) {
    options.try_emplace("size", "48");
    options.try_emplace("search", "none");
    return run(maps::make_backproject, stage, options);
  }
};

// backproject's layers are those of backproject-peel with all texels.
TEST_F(MapsRepairs, LayersAreThoseOfPeeling) {
  for (const scenes::Scene& scene : {square_above_plate(), box_over_floor(0.3), plates_with_gap(false)}) {
    const Stage stage = on_floor(scene, 10, light_samples(1));
    const Masks one = project(stage, {{"fill", "none"}});
    bool other = false;
    for (const char* depth : {"first", "midpoint"}) {
      for (const char* layers : {"1", "2", "5"}) {
        const Masks peeled = run(maps::make_backproject_peel, stage,
                                 {{"size", "48"}, {"layers", layers}, {"samples", "0"}, {"depth", depth}});
        const Masks found = project(stage, {{"fill", "none"}, {"layers", layers}, {"depth", depth}});
        EXPECT_EQ(found.visibility, peeled.visibility) << layers << ", " << depth;
        other = other || found.visibility != one.visibility;
      }
    }
    EXPECT_TRUE(other) << "there is only one layer";
  }
}

// Compares fill=shared with a sum over all texels, as the other fills are tested.
TEST_F(MapsRepairs, SharedBordersAreTheNeighbours) {
  for (const scenes::Scene& scene : {sphere_over_floor(), oblique_quad(0.4), square_above_plate()}) {
    const Stage stage = on_floor(scene, 10, light_samples(1));
    const PatchTwin twin(device(), stage, 48);
    const Masks found = project(stage, {{"fill", "shared"}});
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!twin.is_below_all_casters(i)) continue;
      EXPECT_NEAR(found.visibility[i], twin.visibility(i, Fill::shared), 1e-4) << i;
    }
  }
}

// On a plate tilted about one axis of the map, patches with shared borders tile a rectangle on the light: the sum
// equals the union. A count of 64 × 64 samples in a rectangle is off by a row at its lower and upper side together, and
// by one sample in each row: 2 / 64. Without shared borders gaps and overlaps make the two differ.
TEST_F(MapsRepairs, WithSharedBordersTheSumIsTheUnion) {
  scenes::Scene scene = bare_floor(0.6);
  add_quad(scene, {0, 2.5, 0}, {0.8, 1.2, 0}, {0, 0, -0.9}).receives_shadow = false;
  const Stage stage = on_floor(scene, 12, light_samples(4096));
  const auto apart = [&](const char* fill) {
    const Masks sum = project(stage, {{"fill", fill}});
    const Masks joined =
        run(maps::make_bitmask, stage, {{"size", "48"}, {"search", "none"}, {"occluder", "patch"}, {"fill", fill}});
    double most = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i)
      most = std::max(most, std::abs(static_cast<double>(sum.visibility[i]) - joined.visibility[i]));
    return most;
  };
  EXPECT_LT(apart("shared"), 2.0 / 64);
  EXPECT_GT(apart("none"), 0.1);
}

// Pixels that are not wanted are left out, and the wanted ones are the same to the bit.
TEST_F(MapsRepairs, WantedPixelsAreTheSameAndOthersAreLeftOut) {
  const Stage stage(parallel_square(), 24, 24, light_samples(16));
  std::vector<std::uint32_t> wanted;
  for (std::uint32_t i = 5; i < 24 * 24; i += 7) wanted.push_back(i);
  for (const Factory& make :
       std::initializer_list<Factory>{maps::make_backproject, maps::make_packet, maps::make_bitmask, maps::make_pcss}) {
    const MethodOptions options{{"size", "64"}};
    const Masks all = run(make, stage, options);
    const auto method = make(device(), options);
    method->want_pixels(wanted);
    const Masks some = run(*method, stage);
    std::size_t left_out = 0;
    for (std::uint32_t i = 0; i < all.visibility.size(); ++i) {
      if (std::ranges::binary_search(wanted, i)) {
        EXPECT_EQ(some.visibility[i], all.visibility[i]) << i;
      } else {
        left_out += std::isnan(some.visibility[i]) ? 1 : 0;
      }
    }
    EXPECT_EQ(left_out, all.visibility.size() - wanted.size());
  }
}

// Parts of a light that is not a rectangle are polygons in its plane that lie inside it and cover all of it.
TEST_F(MapsRepairs, PartsOfAnyLightAreAllOfIt) {
  const std::vector<decltype(scenes::AreaLight::shape)> shapes{
      scenes::Disk{{0.3, 5, 0}, {0.2, -1, 0.1}, 0.8}, scenes::Ellipse{{0, 5, 0}, {0.9, 0, 0}, {0.3, 0, 0.5}},
      scenes::Polygon{{{-1, 5, -1}, {1, 5, -1}, {0.7, 5, 0.9}, {-0.4, 5, 1}}}};
  for (const auto& shape : shapes) {
    scenes::Scene scene = parallel_square();
    scene.lights.front().shape = shape;
    const Stage stage(scene, 8, 8, light_samples(16));
    const glm::dvec3 centroid = visibility::center_of(stage.light);
    const maps::LightBasis whole = maps::light_basis(stage.light);
    const auto parts = visibility::light_parts(stage.light, 3);
    double weights = 0, area = 0;
    glm::dvec3 moment(0);
    for (const visibility::LightPart& part : parts) {
      const glm::dvec3 middle = visibility::center_of(part.light);
      EXPECT_EQ(part.light.kind, visibility::LightKind::polygon);
      EXPECT_NEAR(part.weight, part.light.area / stage.light.area, 1e-6);
      EXPECT_GT(glm::dot(maps::light_basis(part.light).n, whole.n), 1 - 1e-6) << "it emits to the same side";
      for (const glm::vec3& point : part.light.points) EXPECT_EQ(point, visibility::center_of(part.light));
      double own = 0;
      for (std::size_t i = 0; i < part.light.outline.size(); ++i) {
        const glm::dvec3 a = part.light.outline[i], b = part.light.outline[(i + 1) % part.light.outline.size()];
        own += glm::dot(glm::cross(a - middle, b - middle), whole.n) / 2;
      }
      EXPECT_NEAR(own, part.light.area, 1e-5 * stage.light.area);
      weights += part.weight;
      area += part.light.area;
      moment += part.weight * (middle - centroid);
    }
    EXPECT_NEAR(weights, 1, 1e-12);
    EXPECT_NEAR(area, stage.light.area, 1e-6 * stage.light.area);
    EXPECT_LT(glm::length(moment), 1e-6);
  }
}

// Each part of a light has the light's samples, scaled down to the part.
TEST_F(MapsRepairs, PartsOfALightHaveItsSamples) {
  const Stage stage(parallel_square(), 8, 8, light_samples(16));
  const auto parts = visibility::light_parts(stage.light, 3);
  ASSERT_EQ(parts.size(), 9U);
  double weight = 0;
  for (const visibility::LightPart& part : parts) {
    weight += part.weight;
    ASSERT_EQ(part.light.points.size(), 16U);
    const glm::dvec3 corner = part.light.center;
    const glm::dvec3 u = glm::dvec3(part.light.center_u) - corner, v = glm::dvec3(part.light.center_v) - corner;
    for (std::size_t i = 0; i < 16; ++i) {
      const glm::dvec2 at = part.light.coordinates[i];
      const glm::dvec3 off = glm::dvec3(part.light.points[i]) - (corner + at.x * u + at.y * v);
      EXPECT_LT(glm::length(off), 1e-6);
      EXPECT_LE(std::max(std::abs(at.x), std::abs(at.y)), 1);
    }
  }
  EXPECT_NEAR(weight, 1, 1e-12);
  EXPECT_NEAR(glm::length(glm::dvec3(parts[0].light.center) + glm::dvec3(parts[8].light.center) -
                          2.0 * glm::dvec3(stage.light.center)),
              0, 1e-6);
}

}  // namespace
}  // namespace penumbra::tests
