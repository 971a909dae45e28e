// SPDX-License-Identifier: Apache-2.0
// The part of a scene with instances that a picture needs gives the same view samples, and the same truth of every
// pair, as the scene in which each instance is a copy. Both are found without any tree.
#include "visibility/seen/seen_part.hpp"

#include "tests/unit/visibility/scenes.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace penumbra::visibility {
namespace {

struct Forest {
  scenes::Scene scene;
  scenes::Instances instances;
};

/// Shards over a floor, placed twelve times by any transform: turned, mirrored, sheared, flattened.
Forest forest(std::mt19937& random, const scenes::LightShape& shape) {
  std::uniform_real_distribution<double> real(-1, 1);
  const auto point = [&](double size) { return size * glm::dvec3(real(random), real(random), real(random)); };
  Forest forest;
  tests::add_object(forest.scene, "floor", tests::quad({0, -1.37, 0}, {3.1, 0.1, 0}, {0, 0.2, -2.9}));
  scenes::Scene one;
  std::vector<tests::Corners> shards;
  for (int i = 0; i < 40; ++i) {
    const glm::dvec3 middle = point(0.5);
    shards.push_back({middle + point(0.3), middle + point(0.3), middle + point(0.3)});
  }
  shards.push_back({glm::dvec3(0), glm::dvec3(0.1), glm::dvec3(0.2)});  // without area
  tests::add_object(one, "shards", shards);
  forest.instances.meshes.push_back(std::make_shared<const scenes::SharedMesh>(scenes::SharedMesh{one.soup}));
  for (std::uint32_t i = 0; i < 12; ++i) {
    scenes::Instance instance{.object = static_cast<std::uint32_t>(forest.scene.objects.size()), .soup_before = 2};
    instance.placement.offset_last = i % 2 == 0;
    for (glm::length_t column = 0; column < 3; ++column)
      instance.placement.to_world[column] = glm::dvec4(point(0.9), 0);
    if (i == 5) instance.placement.to_world[1] = instance.placement.to_world[0];  // flattened
    instance.placement.to_world[3] = glm::dvec4(point(1.5), 1);
    forest.instances.all.push_back(instance);
    forest.scene.objects.emplace_back().name = "shards";
  }
  tests::add_object(forest.scene, "post", tests::quad({0.3, -0.5, 0.2}, {0.05, 0, 0.02}, {0.01, 0.8, 0}));
  forest.scene.cameras.push_back(tests::camera({0.3, 1.5, 5}, {0, -0.3, 0}));
  forest.scene.lights.push_back(tests::ceiling_light(3, 0.6));
  forest.scene.lights[0].shape = shape;
  return forest;
}

std::vector<scenes::LightShape> shapes() {
  return {scenes::Rectangle{{0.4, 3, 0.3}, {0.5, 0.1, 0}, {0, 0.1, 0.4}}, scenes::Sphere{{-1, 2.5, 1}, 0.4},
          scenes::Disk{{0, 3, 0}, {0.1, -1, 0.05}, 0.5}, scenes::Sun{glm::normalize(glm::dvec3(0.3, -1, 0.2)), 12},
          scenes::Sun{glm::normalize(glm::dvec3(-0.2, -1, 0.4)), 0}};
}

TEST(SeenPart, HasTheViewSamplesAndPairsOfTheWholeScene) {
  std::mt19937 random(42);
  std::size_t left_out = 0, blocked = 0;
  for (const scenes::LightShape& shape : shapes()) {
    for (int round = 0; round < 3; ++round) {
      SCOPED_TRACE(testing::Message() << "light " << shape.index() << ", round " << round);
      Forest forest = visibility::forest(random, shape);
      if (round == 1) forest.scene.cameras[0].height = 3;  // orthographic
      if (round == 2) forest.scene.objects[4].alpha = {scenes::Alpha::Mode::blend, 0.5, 0.5};
      const SceneFloats whole = make_scene_floats(copied(forest.scene, forest.instances, 0));
      const PlacedMeshes meshes(forest.scene, forest.instances);
      ASSERT_EQ(meshes.origin(), whole.origin);
      const SampleRequest request{16, 0, 0, SamplePattern::sobol, 3};
      const Light light = make_light(forest.scene, 0, whole.origin, request);
      const PinholeCamera camera = make_camera(forest.scene.cameras[0], whole.origin, 20, 15);
      const SeenPart part = seen_part(meshes, camera, {&light, 1}, {0, camera.height});
      EXPECT_EQ(part.triangles, whole.triangles.size());
      EXPECT_EQ(part.lower, whole.lower);
      EXPECT_EQ(part.upper, whole.upper);
      EXPECT_TRUE(std::ranges::is_sorted(part.numbers));
      left_out += whole.triangles.size() - part.numbers.size();
      const SceneFloats some = make_scene_floats(part.scene);
      ASSERT_EQ(some.triangles.size(), part.numbers.size());
      for (std::uint32_t i = 0; i < part.numbers.size(); ++i) {
        ASSERT_EQ(some.corners(i), whole.corners(part.numbers[i])) << i;
        ASSERT_EQ(some.object[i], whole.object[part.numbers[i]]) << i;
      }
      const ViewSamples all = brute_force_view_samples(whole, camera), seen = brute_force_view_samples(some, camera);
      ASSERT_EQ(seen.p, all.p);
      for (std::size_t pixel = 0; pixel < all.size(); ++pixel) {
        if (all.triangle[pixel] == ViewSamples::kBackground) {
          ASSERT_EQ(seen.triangle[pixel], ViewSamples::kBackground);
          continue;
        }
        ASSERT_EQ(part.numbers.at(static_cast<std::size_t>(seen.triangle[pixel])),
                  static_cast<std::uint32_t>(all.triangle[pixel]));
        for (std::uint32_t sample = 0; sample < light.sample_count(); ++sample) {
          const PairOutcome outcome = decide_pair(whole, all, pixel, light, sample).outcome;
          blocked += outcome == PairOutcome::blocked ? 1 : 0;
          ASSERT_EQ(decide_pair(some, seen, pixel, light, sample).outcome, outcome) << pixel << ", " << sample;
        }
      }
    }
  }
  EXPECT_GT(left_out, 500U);
  EXPECT_GT(blocked, 2000U);
}

TEST(SeenPart, OfNothingInSightIsAScene) {
  std::mt19937 random(1);
  Forest forest = visibility::forest(random, shapes()[0]);
  forest.scene.cameras[0].target = {0, 1.5, 100};
  const PlacedMeshes meshes(forest.scene, forest.instances);
  const Light light = make_light(forest.scene, 0, meshes.origin(), {});
  const PinholeCamera camera = make_camera(forest.scene.cameras[0], meshes.origin(), 8, 8);
  EXPECT_EQ(seen_part(meshes, camera, {&light, 1}, {0, camera.height}).numbers, std::vector<std::uint32_t>{0});
}

TEST(SeenPart, OfSomeRowsIsNoMoreThanTheWhole) {
  std::mt19937 random(8);
  const Forest forest = visibility::forest(random, shapes()[0]);
  const PlacedMeshes meshes(forest.scene, forest.instances);
  const Light light = make_light(forest.scene, 0, meshes.origin(), {});
  const PinholeCamera camera = make_camera(forest.scene.cameras[0], meshes.origin(), 20, 15);
  const auto numbers = [&](std::span<const Light> lights, const Tile& rows) {
    return seen_part(meshes, camera, lights, rows).numbers;
  };
  const std::vector<std::uint32_t> all = numbers({&light, 1}, {0, 15});
  std::vector<std::uint32_t> together = numbers({&light, 1}, {0, 4});
  for (const Tile& rows : {Tile{4, 7}, Tile{11, 4}}) {
    const std::vector<std::uint32_t> more = numbers({&light, 1}, rows);
    EXPECT_LT(more.size(), all.size());
    EXPECT_TRUE(std::ranges::includes(all, numbers({}, rows)))
        << "visible triangles are included without any light, too";
    std::vector<std::uint32_t> before = std::exchange(together, {});
    std::ranges::set_union(before, more, std::back_inserter(together));
  }
  // Clusters of view samples end where a tile's rows end, so more or fewer triangles may be near a shaft.
  const std::vector<std::uint32_t> seen = numbers({}, {0, 15});
  EXPECT_TRUE(std::ranges::includes(together, seen));
  EXPECT_LT(seen.size(), all.size());
  // If the parts of a picture are known, no second search for the visible triangles is needed.
  std::vector<std::uint64_t> viewed;
  for (const Tile& rows : {Tile{0, 4}, Tile{4, 7}, Tile{11, 4}}) {
    const SeenPart part = seen_part(meshes, camera, {&light, 1}, rows, {.viewed = &viewed});
    EXPECT_GT(part.numbers.size(), viewed_part(meshes, viewed).numbers.size());
  }
  EXPECT_EQ(viewed_part(meshes, viewed).numbers, seen);
}

TEST(PlacedMeshes, KeepTheTreesOfMeshesThatStay) {
  std::mt19937 random(5);
  Forest forest = visibility::forest(random, shapes()[0]);
  forest.instances.meshes.push_back(forest.instances.meshes[0]);
  PlacedMeshes kept(forest.scene, forest.instances);
  EXPECT_EQ(kept.trees_built(), 2U);
  const auto expect_as_anew = [&] {
    const PlacedMeshes anew(forest.scene, forest.instances);
    const Light light = make_light(forest.scene, 0, anew.origin(), {});
    const PinholeCamera camera = make_camera(forest.scene.cameras[0], anew.origin(), 20, 15);
    EXPECT_EQ(kept.origin(), anew.origin());
    EXPECT_EQ(seen_part(kept, camera, {&light, 1}, {0, 15}).numbers,
              seen_part(anew, camera, {&light, 1}, {0, 15}).numbers);
  };
  // An instance moves; the meshes stay the same, even if they are read again.
  forest.instances.all[3].placement.to_world[3] += glm::dvec4(0.7, 0.2, -3, 0);
  forest.instances.meshes[1] = std::make_shared<const scenes::SharedMesh>(*forest.instances.meshes[1]);
  kept.place(forest.scene, forest.instances);
  EXPECT_EQ(kept.trees_built(), 0U);
  expect_as_anew();
  kept.leave();
  // One mesh changes, and the two meshes swap their places in the list.
  scenes::SharedMesh changed = *forest.instances.meshes[1];
  changed.soup.positions[0] *= 3;
  forest.instances.meshes[1] = forest.instances.meshes[0];
  forest.instances.meshes[0] = std::make_shared<const scenes::SharedMesh>(changed);
  kept.place(forest.scene, forest.instances);
  EXPECT_EQ(kept.trees_built(), 1U);
  expect_as_anew();
}

/// Every pair with a dome's light sample is decided as in the whole scene, and the part has every translucent triangle
/// that is not hidden from the light sample by an opaque one.
TEST(SeenPart, HasABlockerOfEachPairWithADome) {
  std::mt19937 random(17);
  std::size_t left_out = 0, blocked = 0, visible = 0, filtered = 0;
  for (int round = 0; round < 8; ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    scenes::Dome dome;
    dome.half = round % 2 == 1;
    if (round % 4 > 1) dome.up = glm::normalize(glm::dvec3(0.3, 1, -0.2));
    Forest forest = visibility::forest(random, dome);
    if (round >= 2) forest.scene.objects[4].alpha = {scenes::Alpha::Mode::blend, 0.5, 0.5};
    if (round >= 3) forest.scene.objects[5].casts_shadow = false;
    if (round >= 5) {  // a sun in addition to the dome
      forest.scene.lights.push_back(forest.scene.lights[0]);
      forest.scene.lights[1].shape = shapes()[3];
    }
    const SceneFloats whole = make_scene_floats(copied(forest.scene, forest.instances, 0));
    const PlacedMeshes meshes(forest.scene, forest.instances);
    const SampleRequest request{100, 0, 0, SamplePattern::sobol, 3};
    std::vector<Light> lights;
    for (std::uint32_t i = 0; i < forest.scene.lights.size(); ++i)
      lights.push_back(make_light(forest.scene, i, whole.origin, request));
    if (round >= 6) {  // an object that the dome's light ignores
      lights[0].unshaded_by.assign(forest.scene.objects.size(), 0);
      lights[0].unshaded_by[7] = 1;
    }
    const PinholeCamera camera = make_camera(forest.scene.cameras[0], whole.origin, 20, 15);
    const SeenPart part = seen_part(meshes, camera, lights, {0, camera.height}, {.dome_samples = true});
    left_out += whole.triangles.size() - part.numbers.size();
    const SceneFloats some = make_scene_floats(part.scene);
    const ViewSamples all = brute_force_view_samples(whole, camera), seen = brute_force_view_samples(some, camera);
    ASSERT_EQ(seen.p, all.p);
    for (const Light& light : lights) {
      const SceneFloats of_whole = cast_for(whole, light), of_some = cast_for(some, light);
      for (std::size_t pixel = 0; pixel < all.size(); ++pixel) {
        if (all.triangle[pixel] == ViewSamples::kBackground) continue;
        for (std::uint32_t sample = 0; sample < light.sample_count(); ++sample) {
          const PairOutcome outcome = decide_pair(of_whole, all, pixel, light, sample).outcome;
          ASSERT_EQ(decide_pair(of_some, seen, pixel, light, sample).outcome, outcome) << pixel << ", " << sample;
          blocked += outcome == PairOutcome::blocked ? 1 : 0;
          if (outcome != PairOutcome::visible) continue;
          ++visible;
          for (const std::uint32_t triangle : of_whole.alphas.casters) {
            const auto carrier = static_cast<std::uint32_t>(all.triangle[pixel]);
            if (!may_filter(whole, light, carrier, triangle) ||
                !segment_meets_triangle(all.p[pixel], light.points[sample], whole.corners(triangle), light).meets)
              continue;
            ++filtered;
            ASSERT_TRUE(std::ranges::binary_search(part.numbers, triangle)) << pixel << ", " << sample;
          }
        }
      }
    }
  }
  EXPECT_GT(left_out, 100U);
  EXPECT_GT(blocked, 20000U);
  EXPECT_GT(visible, 20000U);
  EXPECT_GT(filtered, 100U);
}

TEST(SeenPart, OfADomeIsEverythingForAreas) {
  std::mt19937 random(1);
  const Forest forest = visibility::forest(random, scenes::Dome{});
  const PlacedMeshes meshes(forest.scene, forest.instances);
  const Light light = make_light(forest.scene, 0, meshes.origin(), {});
  const PinholeCamera camera = make_camera(forest.scene.cameras[0], meshes.origin(), 8, 8);
  const SeenPart part = seen_part(meshes, camera, {&light, 1}, {0, camera.height});
  const scenes::Scene whole = copied(forest.scene, forest.instances, 0);
  EXPECT_EQ(part.scene.soup.triangles, whole.soup.triangles);
  EXPECT_EQ(part.scene.soup.positions, whole.soup.positions);
}

}  // namespace
}  // namespace penumbra::visibility
