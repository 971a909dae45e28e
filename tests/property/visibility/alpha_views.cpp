// SPDX-License-Identifier: Apache-2.0
// Tests view samples of scenes with surfaces that let light through: seen through holes, and with translucent panes in
// front.
#include "visibility/alpha/panes.hpp"

#include "tests/unit/visibility/scenes.hpp"
#include "visibility/tree/view_walk.hpp"
#include "visibility/view_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace penumbra::visibility {
namespace {

using scenes::Alpha;
using scenes::PictureUse;

/// A card of three by two texels, half of them holes, in front of a wall.
struct Card {
  scenes::Scene scene;
  Card() {
    tests::add_quad(scene, {0, 0, -3}, {5, 0, 0}, {0, 5, 0});
    scenes::Object& card = tests::add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    card.alpha = {Alpha::Mode::mask, 1, 0.5};
    card.picture = PictureUse{0};
    scene.pictures.push_back({"card", 3, 2, {{0, 0, 0, 255}, {}, {0, 0, 0, 128}, {0, 0, 0, 127}, {0, 0, 0, 200}, {}}});
    for (const glm::dvec3& position : scene.soup.positions) {
      scene.looks.places.emplace_back((position.x + 1) / 2, (1 - position.y) / 2);
    }
    scene.lights.push_back(tests::ceiling_light(4, 0.5));
  }
};

TEST(ViewsThroughHoles, AreOfWhatIsBehind) {
  Card card;
  scenes::Camera seen = tests::camera({0.2, 0.1, 4}, {0, 0, 0}, 40);
  for (const bool parallel : {false, true}) {
    if (parallel) seen.height = 2.5;
    const SceneFloats floats = make_scene_floats(card.scene);
    PinholeCamera through_lens = make_camera(seen, floats.origin, 37, 29);
    through_lens.lens = Lens{.radius = 0.4, .focus_distance = 3, .side = 3, .moment = 1, .moments = 2};
    const ViewSamples blurred = brute_force_view_samples(floats, through_lens);
    EXPECT_EQ(blurred.triangle, walk_view_samples(floats, through_lens).triangle);
    const PinholeCamera view = make_camera(seen, floats.origin, 37, 29);
    EXPECT_NE(blurred.triangle, brute_force_view_samples(floats, view).triangle);
    const ViewSamples truth = brute_force_view_samples(floats, view);
    const ViewSamples walked = walk_view_samples(floats, view);
    EXPECT_EQ(truth.triangle, walked.triangle);
    EXPECT_EQ(truth.p, walked.p);
    card.scene.objects[1].alpha = {};
    const SceneFloats filled = make_scene_floats(card.scene);
    card.scene.objects[1].alpha = {Alpha::Mode::mask, 1, 0.5};
    ViewSamples solid = brute_force_view_samples(filled, view);
    EXPECT_NE(solid.triangle, truth.triangle);
    EXPECT_EQ(look_through(floats, view, solid).triangle, truth.triangle);
    std::array<int, 4> seen_on{};
    for (std::size_t i = 0; i < truth.size(); ++i) {
      // The texel of the card, in the plane z = 0, that the pixel's ray meets.
      const ViewRay ray = view.ray(static_cast<std::uint32_t>(i % 37), static_cast<std::uint32_t>(i / 37));
      const glm::dvec3 at =
          ray.start + floats.origin - (ray.start.z + floats.origin.z) / ray.direction.z * ray.direction;
      if (std::abs(at.x) >= 1 || std::abs(at.y) >= 1 || std::abs(at.y) < 1e-9)
        continue;  // off the card, or between two texels
      const int column = static_cast<int>((at.x + 1) / 2 * 3), row = static_cast<int>((1 - at.y) / 2 * 2);
      const bool is_there = (row == 0 && column != 1) || (row == 1 && column == 1);
      EXPECT_EQ(truth.triangle[i] >= 2, is_there) << at.x << " " << at.y;
      ++seen_on[is_there ? 1 : 0];
    }
    EXPECT_GT(seen_on[0], 50);
    EXPECT_GT(seen_on[1], 50);
  }
}

/// Only pixels that may look through a hole are examined again. None of them may be missed, wherever the card with
/// holes and the other objects are: in the picture, next to the eye or behind it.
TEST(ViewsThroughHoles, AreFoundWhereverTheyAre) {
  std::size_t looked_through = 0;
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    const auto point = [&](double size) { return size * glm::dvec3(real(random), real(random), real(random)); };
    scenes::Scene scene;
    std::vector<tests::Corners> soup;
    for (int i = 0; i < 60; ++i) {
      const glm::dvec3 middle = point(3);
      soup.push_back({middle + point(1), middle + point(1), middle + point(1)});
    }
    tests::add_object(scene, "soup", soup);
    scenes::Object& card = tests::add_quad(scene, point(1.5), point(0.4), point(0.4));
    card.alpha = {Alpha::Mode::mask, 1, 0.5};
    card.picture = PictureUse{0};
    scene.pictures.push_back({"card", 2, 1, {{0, 0, 0, 255}, {}}});
    for (std::size_t i = 0; i < scene.soup.positions.size(); ++i) scene.looks.places.emplace_back(real(random), 0.5);
    scene.lights.push_back(tests::ceiling_light(4, 0.5));
    scenes::Camera camera = tests::camera(point(1) + glm::dvec3(0, 0, 3), point(0.5), 50);
    if (seed % 3 == 0) camera.height = 4;
    const SceneFloats floats = make_scene_floats(scene);
    const std::uint32_t width = seed % 10 == 9 ? 1 : 31, height = seed % 10 == 8 ? 1 : 23;
    const PinholeCamera view = make_camera(camera, floats.origin, width, height);
    const ViewSamples truth = brute_force_view_samples(floats, view);
    scene.objects[1].alpha = {};
    const ViewSamples solid = brute_force_view_samples(make_scene_floats(scene), view);
    looked_through += solid.triangle != truth.triangle ? 1 : 0;
    EXPECT_EQ(look_through(floats, view, solid).triangle, truth.triangle) << "seed " << seed;
  }
  EXPECT_GT(looked_through, 30u);
}

/// The rays of an orthographic camera are parallel: p is at its pixel's place, whatever the distance.
TEST(OrthographicViews, KeepDistancesAcross) {
  Card card;
  scenes::Camera seen = tests::camera({0, 0, 7}, {0, 0, 0});
  seen.height = 4;
  const SceneFloats floats = make_scene_floats(card.scene);
  const PinholeCamera view = make_camera(seen, floats.origin, 16, 8);
  const ViewSamples samples = walk_view_samples(floats, view);
  for (std::uint32_t y = 0; y < 8; ++y) {
    for (std::uint32_t x = 0; x < 16; ++x) {
      const std::size_t i = std::size_t{y} * 16 + x;
      const glm::dvec3 world = glm::dvec3(samples.p[i]) + floats.origin;
      EXPECT_NEAR(world.x, (x + 0.5) / 16 * 8 - 4, 1e-6);
      EXPECT_NEAR(world.y, 2 - (y + 0.5) / 8 * 4, 1e-6);
      EXPECT_NEAR(samples.depth[i], world.z < -1 ? 10 : 7, 1e-6);
      EXPECT_EQ(samples.n[i], glm::vec3(0, 0, 1));
    }
  }
}

TEST(PaneLayers, AreBeforeWhatIsSeenAndInOrder) {
  Card card;
  const auto add_pane = [&](double z, double alpha) {
    tests::add_quad(card.scene, {0, 0, z}, {3, 0, 0}, {0, 3, 0}).alpha = {Alpha::Mode::blend, alpha, 0.5};
    card.scene.looks.places.resize(card.scene.soup.positions.size());
  };
  add_pane(-4, 0.9);  // behind the wall
  add_pane(1, 0.25);
  add_pane(-1, 0.5);  // behind the card
  add_pane(2, 0);     // an alpha of 0: no pane at all
  const SceneFloats floats = make_scene_floats(card.scene);
  const PinholeCamera view = make_camera(tests::camera({0, 0, 6}, {0, 0, 0}, 30), floats.origin, 21, 21);
  const ViewSamples seen = brute_force_view_samples(floats, view);
  for (const std::int32_t triangle : seen.triangle)
    EXPECT_TRUE(triangle < 4) << "a pane must not be a view sample's surface";
  const Panes panes(floats, seen);
  ASSERT_EQ(panes.depth(), 2u);
  const std::array layers{panes.layer(0), panes.layer(1)};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(layers[0].alpha[i], 0.25f);
    EXPECT_NEAR(layers[0].samples.depth[i], 5, 1e-6);
    const bool card_before = seen.triangle[i] >= 2;
    EXPECT_EQ(layers[1].alpha[i], card_before ? 0.0f : 0.5f);
    EXPECT_EQ(layers[1].samples.triangle[i] == ViewSamples::kBackground, card_before);
  }
}

/// A ray through a common edge or corner of several triangles meets one surface, even if they belong to different
/// objects; coincident faces are two surfaces.
TEST(PaneLayers, SeamsAreOneSurface) {
  const auto quads = [](std::initializer_list<glm::dvec3> centers) {
    scenes::Scene scene;
    tests::add_quad(scene, {0, 0, -3}, {5, 0, 0}, {0, 5, 0});
    for (const glm::dvec3& center : centers)
      tests::add_quad(scene, center, {1, 0, 0}, {0, 1, 0}).alpha = {Alpha::Mode::blend, 0.5, 0.5};
    scene.lights.push_back(tests::ceiling_light(4, 0.5));
    return scene;
  };
  const auto depths = [](const scenes::Scene& scene) {
    const SceneFloats floats = make_scene_floats(scene);
    // Odd sizes: rays through the picture's middle pass through the seam x = 0, the diagonals of quads, and the corner
    // at (0, 0).
    const PinholeCamera view = make_camera(tests::camera({0, 0, 6}, {0, 0, 0}, 30), floats.origin, 21, 21);
    const ViewSamples seen = brute_force_view_samples(floats, view);
    const Panes panes(floats, seen);
    std::vector<int> counts(seen.size());
    for (std::size_t layer = 0; layer < panes.depth(); ++layer) {
      const std::vector<float> alpha = panes.layer(layer).alpha;
      for (std::size_t i = 0; i < alpha.size(); ++i) counts[i] += alpha[i] > 0 ? 1 : 0;
    }
    return counts;
  };
  const std::vector<int> four = depths(quads({{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(four, std::vector<int>(four.size(), 1));
  const std::vector<int> twice = depths(quads({{0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(std::ranges::count(twice, 2), std::ranges::count_if(twice, [](int depth) { return depth > 0; }));
  EXPECT_GT(std::ranges::count(twice, 2), 30);
}

}  // namespace
}  // namespace penumbra::visibility
