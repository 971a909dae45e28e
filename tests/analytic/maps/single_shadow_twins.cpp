// SPDX-License-Identifier: Apache-2.0
// Tests the second maps of methods that make penumbrae from one hard shadow, and their searches, against twins that try
// every edge at every texel, and every texel for every view sample.

#include "maps/products/light_shape.hpp"
#include "maps/products/slices.hpp"
#include "maps/single_shadow/outer_map.hpp"
#include "maps/single_shadow/search_recipe.hpp"
#include "maps/single_shadow/width_map.hpp"
#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/centre_maps.hpp"
#include "tests/analytic/maps/map_variants.hpp"

#include <map>
#include <tuple>

namespace penumbra::tests {
namespace {

using selftest::CentreMaps;

/// A silhouette edge of casters as the light's centre sees it: an edge whose triangles lie more on one side than on the
/// other. Casters behind the light's plane are not part of these tests.
struct TwinEdge {
  glm::dvec3 a{0}, b{0};
  glm::dvec2 outside{0};  ///< direction away from the casters at right angles to the edge, in (x/z, y/z)
};
std::vector<TwinEdge> twin_edges(const Stage& stage, const maps::LightBasis& basis) {
  using Key = std::tuple<float, float, float>;
  const auto key = [](const glm::vec3& p) { return Key(p.x, p.y, p.z); };
  struct Sides {
    glm::dvec3 a{0}, b{0};
    int left = 0;  ///< number of triangles on the left minus those on the right
  };
  std::map<std::pair<Key, Key>, Sides> edges;
  for (std::uint32_t i = 0; i < stage.floats.triangles.size(); ++i) {
    if (stage.floats.casts_shadow[i] == 0) continue;
    const auto corners = stage.floats.corners(i);
    for (std::size_t k = 0; k < 3; ++k) {
      glm::vec3 a = corners[k], b = corners[(k + 1) % 3];
      if (key(b) < key(a)) std::swap(a, b);
      Sides& sides = edges[{key(a), key(b)}];
      sides.a = basis.local(a);
      sides.b = basis.local(b);
      const double turn = glm::dot(glm::cross(sides.a, sides.b), basis.local(corners[(k + 2) % 3]));
      if (std::abs(turn) > 1e-9) sides.left += turn > 0 ? 1 : -1;
    }
  }
  std::vector<TwinEdge> found;
  for (const auto& [ends, sides] : edges) {
    if (sides.left == 0) continue;
    const glm::dvec2 direction = glm::normalize(glm::dvec2(sides.b) / sides.b.z - glm::dvec2(sides.a) / sides.a.z);
    const glm::dvec2 left(-direction.y, direction.x);
    found.push_back({sides.a, sides.b, sides.left > 0 ? -left : left});
  }
  return found;
}

/// Returns z of the point where a ray in this direction meets the nearest triangle, or 0 if it meets none.
double nearest_surface(const Stage& stage, const maps::LightBasis& basis, const glm::dvec2& seen) {
  double nearest = std::numeric_limits<double>::infinity();
  const glm::dvec3 direction(seen, 1);
  for (std::uint32_t i = 0; i < stage.floats.triangles.size(); ++i) {
    const auto corners = stage.floats.corners(i);
    const glm::dvec3 a = basis.local(corners[0]), b = basis.local(corners[1]), c = basis.local(corners[2]);
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double depth = glm::dot(n, a) / glm::dot(n, direction);
    if (!(depth > 0) || !(depth < nearest)) continue;
    const glm::dvec3 q = depth * direction;
    const auto inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
      return glm::dot(n, glm::cross(to - from, q - from)) >= 0;
    };
    if (inside(a, b) && inside(b, c) && inside(c, a)) nearest = depth;
  }
  return std::isinf(nearest) ? 0 : nearest;
}

/// The part of a penumbra in a texel: how far out the texel is, and the edge's height.
struct Left {
  double kept, height;
};
template <typename Keep>
void each_part(const TwinEdge& edge, const glm::dvec2& outward, const glm::dvec2& seen, const Keep& keep) {
  const glm::dvec2 a = glm::dvec2(edge.a) / edge.a.z, b = glm::dvec2(edge.b) / edge.b.z, along = glm::normalize(b - a);
  const auto across = [](const glm::dvec2& u, const glm::dvec2& v) { return u.x * v.y - u.y * v.x; };
  // seen = a + s (b - a) + t outward
  const double s = across(seen - a, outward) / across(b - a, outward),
               t = across(b - a, seen - a) / across(b - a, outward);
  if (s >= 0 && s <= 1 && t >= 0) keep(t, 1 / ((1 - s) / edge.a.z + s / edge.b.z));
  // Calls `keep` for the region around an end, between `outward` and the continuation of the edge.
  const auto around = [&](const glm::dvec2& end, const glm::dvec2& on, double height) {
    const double p = across(seen - end, on) / across(outward, on),
                 q = across(outward, seen - end) / across(outward, on);
    if (p >= 0 && q >= 0) keep(glm::distance(seen, end), height);
  };
  around(a, -along, edge.a.z);
  around(b, along, edge.b.z);
}

/// A scene with a wall up to the light's plane, which needs a hemicube instead of one window.
scenes::Scene beside_a_wall() {
  scenes::Scene scene = bare_floor(0.4, 1.5);
  add_quad(scene, {-1.5, 2.5, 0}, {0, 0, 1.5}, {0, 2.5, 0}).casts_shadow = false;
  add_quad(scene, {-0.8, 3.4, 0.2}, {0.3, 0.05, 0.1}, {0.05, 0.2, -0.3}).receives_shadow = false;
  add_quad(scene, {0.5, 2.6, 0.2}, {0.3, 0.1, 0.1}, {0.1, 0.1, -0.3}).receives_shadow = false;
  return scene;
}

class MapsOuterMap : public MapsTest {
 protected:
  static void expect_twin(const scenes::Scene& scene, maps::OuterForm form, double width) {
    constexpr std::uint32_t kSize = 64;
    const Stage stage = on_floor(scene, 4, light_samples(1));
    const CentreMaps maps(device(), stage, kSize);
    maps::OuterMap product(device(), {.form = form, .width = width});
    render::Commands commands(device());
    product.record(commands, maps.set(stage));
    commands.submit();
    std::vector<std::uint32_t> words(2 * maps.texel_count());
    product.buffer().read<std::uint32_t>(words);
    const maps::gpu::LightView& view = maps.fitted.views.front();
    const std::vector<TwinEdge> edges = twin_edges(stage, maps.basis);
    const double radius = maps::half_width(stage.light);
    std::size_t drawn = 0, wrong = 0, near = 0, compared = 0;
    for (std::size_t texel = 0; texel < maps.texel_count(); ++texel) {
      const maps::Face face = maps::face_of(view, maps.basis, static_cast<std::uint32_t>(texel / (kSize * kSize)));
      const glm::dvec3 direction = face.direction(texel % kSize, texel / kSize % kSize, kSize);
      const glm::dvec3 local(glm::dot(direction, maps.basis.u), glm::dot(direction, maps.basis.v),
                             glm::dot(direction, maps.basis.n));
      const glm::dvec2 seen = glm::dvec2(local) / local.z;
      // Returns the twin's result for a texel that is moved by `off`.
      const auto least = [&](const glm::dvec2& off) {
        Left left{1, std::numeric_limits<double>::infinity()};
        const double surface = nearest_surface(stage, maps.basis, seen + off);
        for (const TwinEdge& edge : edges) {
          glm::dvec2 outward = edge.outside;
          if (form == maps::OuterForm::cones) {
            const glm::dvec2 between = glm::dvec2(edge.b) / edge.b.z - glm::dvec2(edge.a) / edge.a.z;
            const double lean = radius * (1 / edge.a.z - 1 / edge.b.z) / glm::length(between);
            if (std::abs(lean) >= 1) continue;
            outward = lean * glm::normalize(between) + std::sqrt(1 - lean * lean) * outward;
          }
          each_part(edge, outward, seen + off, [&](double beside, double height) {
            double kept = 2;
            if (form == maps::OuterForm::cones) {
              const double cone = 1 / (1 / height - beside / radius);
              if (cone > 0 && cone < surface) kept = (cone - height) / (surface - height);
            } else if (beside <= width && surface > height) {
              kept = std::min(beside / width / (1 - height / surface), 1.0);
            }
            if (kept > 1) return;
            left.kept = std::min(left.kept, kept);
            left.height = std::min(left.height, height);
          });
        }
        return left;
      };
      const Left expected = least({0, 0});
      const double kept = static_cast<double>(std::bit_cast<float>(words[2 * texel])),
                   height = static_cast<double>(std::bit_cast<float>(words[2 * texel + 1]));
      ++compared;
      drawn += expected.kept < 1 ? 1 : 0;
      const auto agrees = [&](const Left& with) {
        return std::abs(kept - with.kept) < 2e-4 &&
               (std::isinf(with.height) ? std::isinf(height) : std::abs(height - with.height) < 1e-3);
      };
      if (agrees(expected)) continue;
      // Corners are snapped to 1/256 texel: skips texels whose centre is on a silhouette or on an outer border.
      bool beside = false;
      const double d = (face.upper.x - face.lower.x) / kSize / 64 / std::max(local.z, 1e-3);
      for (const glm::dvec2& off : {glm::dvec2(d, 0), glm::dvec2(-d, 0), glm::dvec2(0, d), glm::dvec2(0, -d)}) {
        const Left moved = least(off);
        beside = beside || std::abs(moved.kept - expected.kept) > 0.02 || moved.height != expected.height ||
                 std::abs(kept - moved.kept) < 0.02;
      }
      (beside ? near : wrong) += 1;
    }
    fmt::print("{} texels, {} in a penumbra, {} on a border, {} wrong\n", compared, drawn, near, wrong);
    EXPECT_EQ(wrong, 0U);
    EXPECT_GT(drawn, 200U);
    EXPECT_LT(near, compared / 50);
  }
};

TEST_F(MapsOuterMap, EachTexelHasTheLeastOfAllConesAndSheets) {
  expect_twin(oblique_quad(0.3), maps::OuterForm::cones, 0);
  expect_twin(sphere_over_floor(0.5, 6), maps::OuterForm::cones, 0);
  expect_twin(square_above_plate(), maps::OuterForm::cones, 0);
  expect_twin(beside_a_wall(), maps::OuterForm::cones, 0);
}

TEST_F(MapsOuterMap, EachTexelHasTheLeastOfAllSmoothies) {
  expect_twin(oblique_quad(0.3), maps::OuterForm::smoothies, 0.15);
  expect_twin(sphere_over_floor(0.5, 6), maps::OuterForm::smoothies, 0.1);
  expect_twin(beside_a_wall(), maps::OuterForm::smoothies, 0.2);
}

TEST_F(MapsOuterMap, ATwoSidedLightHasSilhouettesOnBothSides) {
  scenes::Scene scene = bare_floor(0.4);
  add_quad(scene, {0, 10, 0}, {2, 0, 0}, {0, 0, -2}).casts_shadow = false;
  for (const double height : {2.0, 8.0}) add_quad(scene, {0.2, height, 0}, {0.5, 0, 0}, {0, 0, -0.4});
  scene.lights.front().two_sided = true;
  const Stage stage = on_floor(scene, 4, light_samples(1));
  const maps::LightBasis basis = maps::light_basis(stage.light);
  const maps::OuterEdges edges = maps::outer_edges(stage.floats, stage.light, basis, maps::OuterForm::cones, 1e-5);
  for (const auto& side : edges.sides) {
    ASSERT_EQ(side.size(), 4U);
    glm::dvec2 middle{0};
    for (const maps::gpu::OuterEdge& edge : side)
      middle += glm::dvec2(edge.first) / static_cast<double>(edge.first.z) / 4.0;
    for (const maps::gpu::OuterEdge& edge : side) {
      const glm::dvec2 at = glm::dvec2(edge.first) / static_cast<double>(edge.first.z);
      EXPECT_GT(glm::dot(at - middle, glm::dvec2(edge.outward)), 0) << "an outer side that leads inside";
      EXPECT_NEAR(edge.first.z, 3, 1e-5);
    }
  }
  EXPECT_NEAR(edges.mean_height, 3, 1e-5);
}

TEST_F(MapsOuterMap, WidthsAreDistancesToTheNearestTexelWithoutAnOccluder) {
  constexpr std::uint32_t kSize = 48;
  for (const std::uint32_t radius : {3U, 140U}) {
    scenes::Scene scene = sphere_over_floor(0.5, 6);
    add_quad(scene, {1, 2.5, 0.4}, {0.6, 0.1, 0.2}, {0.1, 0.2, -0.4});
    const Stage stage = on_floor(scene, 4, light_samples(1));
    const CentreMaps maps(device(), stage, kSize);
    maps::WidthMap product(device(), radius, maps::Rasteriser::vulkan);
    render::Commands commands(device());
    product.record(commands, maps.set(stage));
    commands.submit();
    std::vector<float> widths(maps.texel_count());
    product.buffer().read<float>(widths);
    const std::vector<float> depths = maps.read();  // the floor casts nothing, so every drawn texel is an occluder
    const auto& side = maps.fitted.views.front().side[0];
    const glm::dvec2 texel = glm::dvec2(side.upper - side.lower) / static_cast<double>(kSize);
    std::size_t inside = 0, unknown = 0;
    for (int y = 0; y < static_cast<int>(kSize); ++y) {
      for (int x = 0; x < static_cast<int>(kSize); ++x) {
        double least = 1e30;
        for (int v = 0; v < static_cast<int>(kSize); ++v) {
          for (int u = 0; u < static_cast<int>(kSize); ++u) {
            const int most = static_cast<int>(radius);
            if (depths[static_cast<std::size_t>(v) * kSize + static_cast<std::size_t>(u)] < 1) continue;
            if (std::abs(u - x) > most || std::abs(v - y) > most) continue;
            least = std::min(least, glm::length(glm::dvec2(u - x, v - y) * texel));
          }
        }
        const float found = widths[static_cast<std::size_t>(y) * kSize + static_cast<std::size_t>(x)];
        inside += least > 0 ? 1 : 0;
        unknown += least == 1e30 ? 1 : 0;
        EXPECT_NEAR(found / (least + 1e-30), least == 0 ? 0 : 1, 1e-5) << x << " " << y;
      }
    }
    EXPECT_GT(inside, 100U);
    EXPECT_EQ(unknown > 0, radius == 3U);
  }
}

TEST(MapsSearch, OffsetsAreAllOfADiskNearestFirst) {
  const std::vector<glm::ivec2> offsets = maps::search_offsets(140);
  EXPECT_EQ(offsets.size(), 61529U);  // within 65,535 loop iterations; Gauss's circle problem, N(140)
  EXPECT_EQ(offsets.front(), glm::ivec2(0));
  for (std::size_t k = 1; k < offsets.size(); ++k) {
    EXPECT_GE(offsets[k].x * offsets[k].x + offsets[k].y * offsets[k].y,
              offsets[k - 1].x * offsets[k - 1].x + offsets[k - 1].y * offsets[k - 1].y);
  }
}

// The twin tries every texel for every view sample: all casters are far above the floor, which casts nothing.
class MapsSearchTwin : public MapsTest {};

TEST_F(MapsSearchTwin, EveryTexelIsAskedThatCanMatter) {
  constexpr std::uint32_t kSize = 64;
  for (const scenes::Scene& scene : {oblique_quad(0.4), sphere_over_floor(0.6, 8), square_above_plate()}) {
    const Stage stage = on_floor(scene, 24, light_samples(1));
    const glm::dvec2 beside =
        maps::half_extent(stage.light, maps::light_basis(stage.light)) / maps::half_width(stage.light);
    const CentreMaps maps(device(), stage, kSize, beside);
    const auto& side = maps.fitted.views.front().side[0];
    const double far = static_cast<double>(maps.fitted.views.front().far), light = maps::half_width(stage.light);
    const glm::dvec2 texel = glm::dvec2(side.upper - side.lower) / static_cast<double>(kSize);
    const std::vector<float> depths = maps.read();
    const visibility::MethodOptions options{{"size", "64"}, {"radius", "140"}, {"falloff", "linear"}};
    const Masks outer = run(*MapVariant("parker").with(options).make(device()), stage),
                both = run(*MapVariant("brabec-seidel").with(options).make(device()), stage);
    std::size_t wrong = 0, between = 0, ties = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const glm::dvec3 e = maps.basis.local(stage.samples.p[i]);
      const glm::dvec2 seen = glm::dvec2(e) / e.z, at = (seen - glm::dvec2(side.lower)) / texel;
      const auto depth_at = [&](std::uint32_t x, std::uint32_t y) {
        return far * static_cast<double>(depths[std::size_t{y} * kSize + x]);
      };
      const double own = depth_at(static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y));
      const bool shaded = own < far;
      double least = 1, nearest = 1e30, width = light * (1 / own - 1 / e.z), second = 1e30;
      for (std::uint32_t y = 0; y < kSize; ++y) {
        for (std::uint32_t x = 0; x < kSize; ++x) {
          const double depth = depth_at(x, y);
          const glm::dvec2 centre = glm::dvec2(side.lower) + (glm::dvec2(x, y) + 0.5) * texel;
          const double away = std::max(glm::distance(seen, centre) - 0.5 * std::max(texel.x, texel.y), 0.0);
          if (depth < far) least = std::min(least, away / (light * (1 / depth - 1 / e.z)));
          if ((depth < far) == shaded) continue;
          second = std::min(second, std::abs(away - nearest));
          if (away < nearest) {
            nearest = away;
            if (!shaded) width = light * (1 / depth - 1 / e.z);
          }
        }
      }
      const double share = std::min(nearest / width, 1.0);
      const double v = shaded ? 0.5 - 0.5 * share : 0.5 + 0.5 * share;
      between += v > 0 && v < 1 ? 1 : 0;
      wrong += std::abs(static_cast<double>(outer.visibility[i]) - (shaded ? 0.0 : least)) > 1e-4 ? 1 : 0;
      if (std::abs(static_cast<double>(both.visibility[i]) - v) > 1e-4) (second < 1e-6 ? ties : wrong) += 1;
    }
    EXPECT_EQ(wrong, 0U) << "of " << stage.samples.size();
    EXPECT_LT(ties, 12U);
    EXPECT_GT(between, 50U);
  }
}

}  // namespace
}  // namespace penumbra::tests
