// SPDX-License-Identifier: Apache-2.0
#include "reference/methods.hpp"

#include "base/error.hpp"
#include "reference/plain_rays.hpp"
#include "tests/unit/ray_traced_masks.hpp"
#include "tests/unit/visibility/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace penumbra::reference {
namespace {

using tests::Masks;
using tests::Stage;
using tests::trace;
using visibility::SamplePattern;

/// A board over a finely divided floor.
scenes::Scene board_over_floor() {
  scenes::Scene scene;
  for (int x = -4; x < 4; ++x) {
    for (int z = -4; z < 4; ++z) {
      tests::add_object(scene, "tile", tests::quad({x + 0.5, 0, z + 0.5}, {0.5, 0, 0}, {0, 0, -0.5}));
    }
  }
  tests::add_object(scene, "board", tests::quad({0, 1, 0}, {1, 0, 0}, {0, 0, -1}));
  scene.lights.push_back(tests::ceiling_light(4, 1));
  scene.cameras.push_back(tests::camera({0.3, 0.7, 6}, {0, 0.3, 0}));
  return scene;
}

TEST(RayTraced, OwnAndCoplanarTrianglesNeverHide) {
  scenes::Scene scene = board_over_floor();
  scene.objects.back().casts_shadow = false;  // the board casts no shadow; the rest is one plane of 128 triangles
  const Stage setup(scene, 40, 40);
  const Masks masks = trace(setup);
  for (std::size_t pixel = 0; pixel < setup.samples.size(); ++pixel) {
    EXPECT_TRUE(masks.visible_count(pixel) == 256 || setup.samples.n[pixel].y < 0);
  }
}

TEST(RayTraced, ShadowsArePartFullAndAbsent) {
  const Stage setup(board_over_floor(), 40, 40);
  const Masks masks = trace(setup);
  int part = 0, full = 0, none = 0;
  for (std::size_t pixel = 0; pixel < setup.samples.size(); ++pixel) {
    const std::uint32_t visible = masks.visible_count(pixel);
    (visible == 0 ? full : visible == 256 ? none : part) += 1;
    EXPECT_EQ(masks.visibility[pixel], static_cast<float>(visible) / 256);
  }
  EXPECT_GT(part, 50);
  EXPECT_GT(full, 20);
  EXPECT_GT(none, 300);
}

TEST(RayTraced, BackgroundEmittersAndUnshadowedObjectsHaveEveryBitAndNoMore) {
  scenes::Scene scene = board_over_floor();
  for (std::size_t i = 0; i < 32; ++i) scene.objects[i].receives_shadow = false;
  for (std::size_t i = 32; i < 64; ++i) scene.objects[i].emits = 0;  // bodies of this light
  const Stage setup(scene, 40, 40, {37, 0, 0, SamplePattern::jittered, 1});
  const Masks masks = trace(setup);
  for (std::size_t pixel = 0; pixel < setup.samples.size(); ++pixel) {
    const std::int32_t triangle = setup.samples.triangle[pixel];
    EXPECT_EQ(masks.word(pixel, 1) >> 5, 0u);
    EXPECT_TRUE(triangle >= 128 || masks.visible_count(pixel) == 37u);
  }
}

TEST(RayTraced, ALightsBodyHidesOtherLightsButNotItsOwn) {
  scenes::Scene scene = board_over_floor();
  scene.objects.back().emits = 0;
  const Stage own(scene, 40, 40);
  const Masks unhidden = trace(own);
  EXPECT_TRUE(std::all_of(unhidden.visibility.begin(), unhidden.visibility.end(), [](float v) { return v == 1; }));
  scene.lights.insert(scene.lights.begin(), tests::ceiling_light(5, 1));
  scene.objects.back().emits = 1;
  const Masks hidden = trace(Stage(scene, 40, 40));
  EXPECT_GT(std::count(hidden.visibility.begin(), hidden.visibility.end(), 0.0f), 20);
}

TEST(RayTraced, NothingIsVisibleBelowTheHorizonOrBehindTheLight) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  scene.lights.push_back(tests::ceiling_light(-1, 1));  // under the floor, facing down
  scene.cameras.push_back(tests::camera({0, 5, 1}, {0, 0, 0}));
  EXPECT_EQ(trace(Stage(scene, 8, 8)).visibility, std::vector<float>(64, 0.0f)) << "horizon";
  scene.lights[0] = tests::rectangle_light({0, 3, 0}, {1, 0, 0}, {0, 0, -1});  // above it, facing up
  EXPECT_EQ(trace(Stage(scene, 8, 8)).visibility, std::vector<float>(64, 0.0f)) << "behind";
  scene.lights[0].two_sided = true;
  EXPECT_EQ(trace(Stage(scene, 8, 8)).visibility, std::vector<float>(64, 1.0f));
}

TEST(RayTraced, TilesRepeatsAndPacketsAgree) {
  for (const std::uint32_t count : {1u, 31u, 100u, 4096u}) {
    const Stage setup(board_over_floor(), 24, 24, {count, 0, 0, SamplePattern::sobol, 9});
    const Masks whole = trace(setup);
    EXPECT_EQ(whole.words, trace(setup).words) << "a second run must give the same bits";
    EXPECT_EQ(whole.words, trace(setup, {}, 5).words) << "five rows at a time";
    for (const char* packet : {"1", "4", "8", "16"}) {
      const Masks other = trace(setup, {{"packet", packet}});
      EXPECT_LE(tests::differing_bits(whole, other), count * 24 * 24 / 10000) << packet;
    }
  }
}

TEST(RayTraced, EveryKindOfLightIsTraced) {
  for (int kind = 0; kind < 6; ++kind) {
    scenes::Scene scene = board_over_floor();
    auto& shape = scene.lights[0].shape;
    if (kind == 1) shape = scenes::Disk{{0, 4, 0}, {0, -1, 0}, 1};
    if (kind == 2) shape = scenes::Polygon{{{-1, 4, -1}, {1, 4, -1}, {0, 4, 1}}};
    if (kind == 3) shape = scenes::Sphere{{0, 4, 0}, 1};
    if (kind == 4) shape = scenes::Ellipse{{0, 4, 0}, {1, 0, 0}, {0, 0, 0.5}};
    if (kind == 5) shape = scenes::Sun{{0, -1, 0}, 30};
    const Masks masks = trace(Stage(scene, 30, 30));
    const auto partly = [](float v) { return v > 0 && v < 1; };
    EXPECT_GT(std::count_if(masks.visibility.begin(), masks.visibility.end(), partly), 8) << kind;
  }
}

TEST(RayTraced, AnEmptySceneOfCastersIsAllVisible) {
  scenes::Scene scene = board_over_floor();
  for (scenes::Object& object : scene.objects) object.casts_shadow = false;
  const Stage setup(scene, 8, 8);
  const Masks masks = trace(setup);
  EXPECT_TRUE(std::all_of(masks.visibility.begin(), masks.visibility.end(), [](float v) { return v == 0 || v == 1; }));
}

TEST(RayTraced, RefusesOptionsItCannotDo) {
  EXPECT_THROW(make_ray_traced({{"packet", "3"}}), UsageError);
  EXPECT_THROW(make_ray_traced({{"packets", "8"}}), UsageError);
  EXPECT_NO_THROW(make_ray_traced({{"packet", "auto"}}));
}

TEST(PlainRays, AgreeWithTheOracleUpToTheirOffset) {
  const Stage setup(board_over_floor(), 40, 40);
  const Masks masks = trace(setup);
  for (const int width : {0, 1, 4, 8, 16}) {
    PlainRays rays({width, width != 4, width != 8});
    rays.prepare_mesh(setup.floats);
    rays.prepare_light(setup.light);
    std::vector<float> visibility(setup.samples.size());
    rays.evaluate(setup.samples, visibility);
    double difference = 0;
    for (std::size_t i = 0; i < visibility.size(); ++i) difference += std::abs(visibility[i] - masks.visibility[i]);
    EXPECT_LT(difference / static_cast<double>(visibility.size()), 1e-3) << width;
  }
}

}  // namespace
}  // namespace penumbra::reference
