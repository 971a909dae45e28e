// SPDX-License-Identifier: Apache-2.0
// Tests surfaces with holes with methods whose maps handle only solid casters (maps/host/every_light.hpp), against the
// same casters cut out of solid surfaces.

#include "maps/host/holes.hpp"
#include "tests/analytic/maps/every_light.hpp"

#include <array>
#include <optional>

namespace penumbra::tests::every_light {
namespace {

// Compares each texel's centre with the leaf's plane in double. Rasterisers snap corners to 1/256 texel: texels that a
// shift by a fiftieth of a texel would change are skipped.
TEST_F(EveryLight, TexelsOfMapsSeeThroughHoles) {
  constexpr std::uint32_t kSize = 96;
  using Wrap = scenes::PictureUse::Wrap;
  const std::array leaves{Leaf{}, Leaf{.times = 2.5}, Leaf{.times = 2.5, .wrap = Wrap::mirror},
                          Leaf{.times = 1.5, .wrap = Wrap::clamp, .vertices = true}};
  for (const Leaf& leaf : leaves) {
    scenes::Scene scene = floor_under(ceiling_light(3, 0.3));
    leaf.add_to(scene);
    // A solid board above a part of the leaf: under it the second layer is the leaf, or what is below a hole in it.
    const glm::dvec2 board_from(-0.9, -0.5), board_to(0.1, 0.5);
    add_quad(scene, {-0.4, 1.6, 0}, {0.5, 0, 0}, {0, 0, -0.5});
    scene.looks.places.resize(scene.soup.positions.size());
    if (leaf.vertices) scene.looks.colors.resize(scene.soup.positions.size(), glm::vec4(1));
    Stage stage = on_the_floor(scene, 4);
    ASSERT_TRUE(maps::with_holes_drawn(stage.floats).has_value());
    stage.floats = *maps::with_holes_drawn(stage.floats);
    const glm::dvec3 middle = leaf.center - stage.floats.origin;
    for (const maps::Rasteriser rasteriser : {maps::Rasteriser::vulkan, maps::Rasteriser::opengl}) {
      const CentreMaps maps(device(), stage, kSize, {0, 0}, {.layers = 2, .farthest = true, .rasteriser = rasteriser});
      ASSERT_EQ(maps.fitted.faces, 1U);
      const std::vector<float> texels = maps.read();
      const maps::gpu::LightView& view = maps.fitted.views.front();
      const maps::Face face = maps::face_of(view, maps.basis, 0);
      std::size_t solid = 0, holes = 0;
      for (std::uint32_t i = 0; i < kSize * kSize; ++i) {
        /// Returns the leaf's depth there; nullopt beside it or in a hole.
        const auto depth_at = [&](const glm::dvec2& beside) -> std::optional<double> {
          const glm::dvec2 at = face.lower + (glm::dvec2(i % kSize, i / kSize) + 0.5 + beside) *
                                                 (face.upper - face.lower) / double{kSize};
          const glm::dvec3 direction = at.x * face.a + at.y * face.b + face.w, n = glm::cross(leaf.u, leaf.v);
          const double w = glm::dot(middle - maps.basis.center, n) / glm::dot(direction, n);
          const glm::dvec3 on = maps.basis.center + w * direction - middle;
          const double s = glm::dot(glm::cross(on, leaf.v), n) / glm::dot(n, n),
                       t = glm::dot(glm::cross(leaf.u, on), n) / glm::dot(n, n);
          if (std::max(std::abs(s), std::abs(t)) > 1 || !leaf.is_there(s, t)) return std::nullopt;
          return w / static_cast<double>(view.far);
        };
        const auto board_at = [&](const glm::dvec2& beside) -> std::optional<double> {
          const glm::dvec2 at = face.lower + (glm::dvec2(i % kSize, i / kSize) + 0.5 + beside) *
                                                 (face.upper - face.lower) / double{kSize};
          const glm::dvec3 direction = at.x * face.a + at.y * face.b + face.w,
                           centre = maps.basis.center + stage.floats.origin;
          const double w = (1.6 - centre.y) / direction.y;
          const glm::dvec3 on = centre + w * direction;
          if (on.x < board_from.x || on.x > board_to.x || on.z < board_from.y || on.z > board_to.y) return std::nullopt;
          return w / static_cast<double>(view.far);
        };
        const std::optional<double> expected = depth_at({0, 0}), board = board_at({0, 0});
        const bool sure = std::ranges::all_of(
            std::array{glm::dvec2(0.02, 0), glm::dvec2(-0.02, 0), glm::dvec2(0, 0.02), glm::dvec2(0, -0.02)},
            [&](const glm::dvec2& beside) {
              return depth_at(beside).has_value() == expected.has_value() &&
                     board_at(beside).has_value() == board.has_value();
            });
        if (!sure) continue;
        const double ground = glm::dot(glm::dvec3(0, 0, 0) - stage.floats.origin - maps.basis.center, face.w) /
                              static_cast<double>(view.far);
        const double nearest = texels[i], behind = texels[i + texels.size() / 3],
                     farthest = texels[i + 2 * texels.size() / 3];
        const glm::dvec2 across =
            face.lower + (glm::dvec2(i % kSize, i / kSize) + 0.5) * (face.upper - face.lower) / double{kSize};
        const glm::dvec3 below =
            maps.basis.center + stage.floats.origin + 3.0 * (across.x * face.a + across.y * face.b + face.w);
        if (std::max(std::abs(below.x), std::abs(below.z)) > 1.59) continue;  // outside the floor
        std::vector<double> depths;
        for (const std::optional<double>& depth : {board, expected, std::optional(ground), std::optional(1.0)})
          if (depth) depths.push_back(*depth);
        ASSERT_NEAR(nearest, depths[0], 1e-4) << "texel " << i % kSize << ", " << i / kSize;
        ASSERT_NEAR(behind, depths[1], 1e-4) << "texel " << i % kSize << ", " << i / kSize;
        ASSERT_NEAR(farthest, ground, 1e-4);
        (expected ? solid : holes) += 1;
      }
      EXPECT_GT(solid, 300U);
      EXPECT_GT(holes, 1000U);
    }
  }
}

/// A leaf with holes casts the same shadow as solid squares cut out of it, up to a texel's step at the borders of
/// squares.
class Leaves : public EveryLight {
 protected:
  static void expect_squares(const std::vector<Entry>& entries, const scenes::AreaLight& light) {
    const Leaf leaf{.u = {0.8, 0, 0}, .v = {0, 0, -0.8}};
    scenes::Scene with_holes = floor_under(light), cut_out = floor_under(light);
    leaf.add_to(with_holes);
    leaf.add_cut_out_to(cut_out);
    const Stage stage = on_the_floor(with_holes, 20, 16), solid = on_the_floor(cut_out, 20, 16);
    ASSERT_EQ(stage.floats.origin, solid.floats.origin);
    for (Entry entry : entries) {
      for (const char* rasteriser : {"vulkan", "opengl"}) {
        entry.options["rasteriser"] = rasteriser;
        const Masks found = run_entry(entry, stage), right = run_entry(entry, solid);
        // A leaf's corners are holes: windows and slices that end where casters end differ for its squares.
        const bool by_extent = entry.name == "soft-shadow-map" || entry.name == "occlusion-textures";
        EXPECT_LT(error(found, right), by_extent ? 0.04 : 0.005) << entry.name << " " << rasteriser;
        const auto shaded = std::ranges::count_if(right.visibility, [](float v) { return v < 0.9F; });
        EXPECT_GT(shaded, 30) << entry.name;
      }
    }
  }
  static inline const std::array lights{shaped(scenes::Rectangle{{0, 4, 0}, {0.3, 0, 0}, {0, 0, 0.3}}),
                                        shaped(scenes::Sun{{-0.2, -1, 0.1}, 6})};
};

TEST_F(Leaves, ShadeAsTheirSquaresDo) {
  // One method of each kind of map: depths only, layers of depths, ids, slices, separate objects.
  const auto some =
      some_methods("96", {"pcss", "backproject-peel", "shadow-map ids", "occlusion-textures", "soft-shadow-map"});
  expect_squares(some, lights[0]);
  expect_squares({some[0], some[2]}, lights[1]);
}

TEST_F(Leaves, ShadeAsTheirSquaresDoInFoils) {
  std::vector<Entry> entries = foils("96");
  std::erase_if(entries, [](const Entry& one) { return !one.given.holes; });
  expect_squares(entries, lights[0]);
}

TEST_F(Leaves, ShadeAsTheirSquaresDoInEveryMethodFull) {
  for (const scenes::AreaLight& light : lights) expect_squares(all_methods("160"), light);
}

}  // namespace
}  // namespace penumbra::tests::every_light
