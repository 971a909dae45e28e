// SPDX-License-Identifier: Apache-2.0
// Tests the share of a light of any shape that a patch covers, and the receiver's horizon across it, against closed
// forms and exact areas.

#include "maps/backprojection/light_table.hpp"
#include "reference/methods.hpp"
#include "tests/analytic/maps/backprojection_scenes.hpp"

#include <array>

namespace penumbra::tests {
namespace {

class MapsLightTable : public MapsTest {
 protected:
  /// Returns V of both methods, with maps of 256² texels, all of which are used.
  static std::array<Masks, 2> both(const Stage& stage) {
    return {run(maps::make_backproject, stage, {{"size", "256"}}),
            run(maps::make_backproject_peel, stage, {{"size", "256"}, {"samples", "0"}})};
  }
  static visibility::Light light_of(const scenes::Scene& scene) {
    return visibility::make_light(scene, 0, glm::dvec3(0), light_samples(1));
  }
  /// The table's share of the light in the rectangle [0, x] × [0, y] of its bounds, interpolated as light_table.glsl
  /// does.
  static double share(const maps::LightTableData& data, const glm::dvec2& unit) {
    const glm::dvec2 at = unit * glm::dvec2(data.head.width, data.head.height);
    const glm::dvec2 cell = glm::min(glm::floor(at), glm::dvec2(data.head.width - 1, data.head.height - 1)),
                     t = at - cell;
    const auto node = [&](int x, int y) {
      const std::size_t column = static_cast<std::size_t>(cell.x) + static_cast<std::size_t>(x),
                        row = static_cast<std::size_t>(cell.y) + static_cast<std::size_t>(y);
      return static_cast<double>(data.shares[row * (data.head.width + 1) + column]);
    };
    return glm::mix(glm::mix(node(0, 0), node(1, 0), t.x), glm::mix(node(0, 1), node(1, 1), t.x), t.y);
  }
};

// The reference is a regular grid of a million points in the light's bounding rectangle, accurate to one row, 1e-3. A
// cell of the table has 1/256² of the rectangle and is off by less than that.
TEST_F(MapsLightTable, HoldsTheShareOfEveryCorner) {
  scenes::Scene scene = bare_floor(1);
  const auto inside_disk = [](const glm::dvec2& at) { return glm::length(2.0 * at - 1.0) <= 1; };
  const std::vector<glm::dvec3> corners{{-1, 5, -1}, {1, 5, -0.5}, {0, 5, 1}};
  for (const char* kind : {"disk", "ellipse", "oblique ellipse", "polygon"}) {
    const bool disk = kind == std::string("disk") || kind == std::string("ellipse");
    scene.lights.front().shape = scenes::Disk{{0, 5, 0}, {0, -1, 0}, 0.7};
    if (kind == std::string("ellipse"))
      scene.lights.front().shape = scenes::Ellipse{{0, 5, 0}, {0.7, 0, 0}, {0, 0, 0.3}};
    if (kind == std::string("oblique ellipse"))
      scene.lights.front().shape = scenes::Ellipse{{0, 5, 0}, {0.7, 0, 0}, {0.4, 0, 0.3}};
    if (kind == std::string("polygon")) scene.lights.front().shape = scenes::Polygon{corners};
    const visibility::Light light = light_of(scene);
    const maps::LightBasis basis = maps::light_basis(light);
    const maps::LightTableData data = maps::light_table(light, basis);
    const maps::LightBounds bounds = maps::light_bounds(light, basis);
    const auto inside = [&](const glm::dvec2& at) {
      if (disk) return inside_disk(at);
      const glm::dvec2 p = glm::mix(bounds.lower, bounds.upper, at);
      if (light.kind == visibility::LightKind::ellipse) {
        const auto [u, v] = maps::light_axes(light, basis);
        const glm::dvec2 st(p.x * v.y - p.y * v.x, u.x * p.y - u.y * p.x);
        return glm::length(st) <= u.x * v.y - u.y * v.x;
      }
      int left = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2 a(basis.local(light.outline[i])), b(basis.local(light.outline[(i + 1) % 3]));
        left += (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0 ? 1 : -1;
      }
      return std::abs(left) == 3;
    };
    constexpr int kGrid = 1000;
    for (const glm::dvec2& corner :
         {glm::dvec2(1, 1), {0.5, 0.5}, {0.25, 0.9}, {0.8, 0.3}, {0.103, 0.64}, {0.9, 0.97}}) {
      std::size_t below = 0, all = 0;
      for (int y = 0; y < kGrid; ++y) {
        for (int x = 0; x < kGrid; ++x) {
          const glm::dvec2 at = (glm::dvec2(x, y) + 0.5) / static_cast<double>(kGrid);
          if (!inside(at)) continue;
          ++all;
          below += at.x <= corner.x && at.y <= corner.y ? 1 : 0;
        }
      }
      EXPECT_NEAR(share(data, corner), static_cast<double>(below) / static_cast<double>(all), 2e-3)
          << kind << " " << corner.x << ", " << corner.y;
    }
  }
}

/// The columns have 5, 7 and 12 of the texels' sum of 24; the rows, from below, 18 and 6.
scenes::Texture three_by_two() {
  scenes::Texture texture;
  texture.width = 3;
  texture.height = 2;
  texture.texels = {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}, {5, 5, 5}, {9, 9, 9}};  // upper row first
  return texture;
}

TEST_F(MapsLightTable, WeighsATexturesTexels) {
  scenes::Scene scene = bare_floor(1);
  scene.lights.front().texture = three_by_two();
  const visibility::Light light = light_of(scene);
  const maps::LightTableData data = maps::light_table(light, maps::light_basis(light));
  EXPECT_NEAR(share(data, {1, 1}), 1, 1e-6);
  EXPECT_NEAR(share(data, {1.0 / 3, 0.5}), 4.0 / 24, 1e-6) << "the lower left texel";
  EXPECT_NEAR(share(data, {1, 0.5}), 18.0 / 24, 1e-6);
  EXPECT_NEAR(share(data, {2.0 / 3, 1}), 12.0 / 24, 1e-6);
  EXPECT_NEAR(share(data, {0.5, 0.25}), (4.0 + 2.5) / 2 / 24, 1e-6);
}

// A board with a straight edge stands between a disk and the floor: V is a segment of the disk. The edge's place is off
// by up to a texel t at depth 3, which is t · f on the light, f = 3 · 5 / (5 − 3); there the disk is at most 2 r wide.
// The window holds the floor, ±2 / 5, and the board's part up to r (1/3 − 1/5) beside it.
TEST_F(MapsLightTable, ADiskBehindAHalfPlane) {
  constexpr double kRadius = 0.7, kEdge = 0.3;
  scenes::Scene scene = bare_floor(1);
  scene.lights.front().shape = scenes::Disk{{0, 5, 0}, {0, -1, 0}, kRadius};
  add_quad(scene, {kEdge + 3, 2, 0}, {3, 0, 0}, {0, 0, -4}).receives_shadow = false;
  const Stage stage = on_floor(scene, 16, light_samples(1));
  const double texel = (0.8 + 2 * kRadius * (1 / 3.0 - 1 / 5.0)) / 254;
  const double bound = texel * 7.5 * 2 / (std::numbers::pi * kRadius);
  double most = 0;
  for (const Masks& found : both(stage)) {
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const double x = static_cast<double>(stage.samples.p[i].x) + stage.floats.origin.x;
      // The light point at s is hidden where the ray from x passes the edge's plane, at height 2 of 5, beyond the edge.
      const double t = std::clamp((kEdge - 0.6 * x) / 0.4 / kRadius, -1.0, 1.0);
      const double seen = 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / std::numbers::pi;
      most = std::max(most, std::abs(found.visibility[i] - seen));
    }
  }
  fmt::print("disk behind a half-plane: off by at most {:.4f}, bound {:.4f}\n", most, bound);
  EXPECT_LT(most, bound);
}

// The same edge in front of a square of half-size 1 whose table has 3 × 2 cells, so that nearly all V come from the
// inside of cells; the edge moves across the columns, then across the rows. Per unit of length no column has more than
// 12/24 / (2/3) of the light, no row more than 18/24.
TEST_F(MapsLightTable, ATextureBehindAHalfPlane) {
  constexpr double kEdge = 0.3, kMost = 0.75;
  const double texel = (0.8 + 2 * (1 / 3.0 - 1 / 5.0)) / 254, bound = texel * 7.5 * kMost;
  for (const bool across_rows : {false, true}) {
    scenes::Scene scene = bare_floor(1);
    scene.lights.front().texture = three_by_two();
    add_quad(scene, across_rows ? glm::dvec3(0, 2, kEdge + 3) : glm::dvec3(kEdge + 3, 2, 0),
             {across_rows ? 4 : 3, 0, 0}, {0, 0, across_rows ? -3 : -4})
        .receives_shadow = false;
    const Stage stage = on_floor(scene, 16, light_samples(1));
    const Masks exact = tests::run(*reference::make_exact({}), stage);
    for (const Masks& found : both(stage)) {
      double most = 0;
      std::size_t partly = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        most = std::max(most, static_cast<double>(std::abs(found.visibility[i] - exact.visibility[i])));
        partly += exact.visibility[i] > 0.01F && exact.visibility[i] < 0.99F ? 1 : 0;
      }
      fmt::print("texture behind a half-plane: off by at most {:.4f}, bound {:.4f}\n", most, bound);
      EXPECT_LT(most, bound);
      EXPECT_GT(partly, stage.samples.size() / 5);
    }
  }
}

// Upright receivers below the light see the part of it that is in front of them; nothing casts a shadow.
TEST_F(MapsLightTable, TheHorizonCutsLightsOfAnyShape) {
  scenes::Scene scene = bare_floor(1);
  for (const double x : {-0.6, 0.2, 0.5}) {
    add_quad(scene, {x, 1.5, 0}, {0.3, 1.4, 0}, {0.2, 0, 0.5}).casts_shadow = false;
  }
  scene.cameras.front() = camera({3, 3, 2}, {0, 1.5, 0}, 60);
  using Shape = decltype(scenes::AreaLight::shape);
  for (const Shape& shape : {Shape(scenes::Rectangle{{0, 5, 0}, {1, 0, 0}, {0, 0, 1}}),
                             Shape(scenes::Rectangle{{0, 5, 0}, {1, 0, 0.3}, {-0.2, 0, 0.8}}),
                             Shape(scenes::Disk{{0, 5, 0}, {0, -1, 0}, 0.7}),
                             Shape(scenes::Ellipse{{0, 5, 0}, {0.9, 0, 0.1}, {-0.2, 0, 0.4}}),
                             Shape(scenes::Polygon{{{-1, 5, -1}, {1, 5, -0.5}, {0, 5, 1}}})}) {
    scene.lights.front().shape = shape;
    const Stage stage(scene, 24, 24, light_samples(1));
    const Masks exact = tests::run(*reference::make_exact({}), stage);
    const Masks found = run(maps::make_backproject, stage, {{"size", "16"}}),
                outlines = run(maps::make_contour, stage, {{"size", "16"}});
    std::size_t cut = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      // The method uses closed forms in float: a light of size 1 at coordinates of a few units. An ellipse is a polygon
      // of 256 sides.
      const double polygon = stage.light.kind == visibility::LightKind::ellipse ? 1.27 / (256 * 256) : 0;
      EXPECT_NEAR(found.visibility[i], exact.visibility[i], 2e-5 + polygon) << i;
      EXPECT_NEAR(outlines.visibility[i], exact.visibility[i], 1e-4 + polygon)
          << i;  // there the horizon is an edge of an outline
      cut += exact.visibility[i] > 0 && exact.visibility[i] < 1 ? 1 : 0;
    }
    EXPECT_GT(cut, 20U);
  }
}

}  // namespace
}  // namespace penumbra::tests
