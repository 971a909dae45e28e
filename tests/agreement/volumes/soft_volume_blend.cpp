// SPDX-License-Identifier: Apache-2.0
// Tests soft-volume-blend: it equals soft-volume where one object stands alone, and is less than its sum where objects
// overlap.

#include "tests/agreement/volumes/soft_stage.hpp"
#include "tests/unit/mesh/shuffled.hpp"

#include "volumes/soft/blended_cover.hpp"
#include "volumes/soft/methods.hpp"

namespace penumbra::volumes {
namespace {

using tests::Errors;
using tests::SoftStage;

TEST(SoftVolumeBlendRule, StaysBetweenTheLargerAndTheSum) {
  std::mt19937 random(7);
  const auto draw = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  const auto cover = [&] {
    const double x = draw(), y = draw(), z = draw(), w = draw();
    Cover result{0, {std::min(x, z), std::min(y, w), std::max(x, z), std::max(y, w)}};
    result.share = draw() * result.box_area();
    return result;
  };
  for (int i = 0; i < 1000; ++i) {
    const Cover a = cover(), b = cover(), both = blend(a, b);
    EXPECT_GE(both.share, std::max(a.share, b.share));
    EXPECT_LE(both.share, a.share + b.share + 1e-15);
    EXPECT_EQ(blend({}, a).share, a.share);
    EXPECT_EQ(blend(a, {}).share, a.share);
  }
  const Cover left{0.5, {0, 0, 0.5, 1}}, right{0.5, {0.5, 0, 1, 1}};
  EXPECT_EQ(blend(left, right).share, 1);   // separate boxes: the sum
  EXPECT_EQ(blend(left, left).share, 0.5);  // full boxes, one on the other: only one of them counts
}

class SoftVolumeBlend : public tests::DeviceTest {
 protected:
  static std::vector<float> run(const SoftStage& stage) { return stage.run(*make_soft_volume_blend(device(), {})); }
};

/// Both add the same areas, one of them in quarters: four times the tolerance of soft_volume_twin.cpp.
TEST_F(SoftVolumeBlend, OneObjectIsAsSoftVolume) {
  for (const glm::dvec3& at : {glm::dvec3(0, 1, 0), glm::dvec3(0.3, 1.5, -0.2)}) {
    scenes::Scene scene = tests::floor_and_light(0.6);
    scene.objects[0].casts_shadow = false;
    tests::add_object(scene, "ball", tests::triangles_of(mesh::make_icosphere(at, 0.5, 3)));
    const SoftStage stage(scene, device(), 64, 48);
    std::vector<float> sum = stage.run(*make_soft_volume(device(), {}));
    const std::vector<double> expected = stage.at_judged([&](std::size_t i) { return static_cast<double>(sum[i]); });
    const Errors errors = tests::errors_of(run(stage), expected);
    fmt::print("a ball: {} in penumbra, off by {:.1e} at most\n", errors.penumbra, errors.largest);
    EXPECT_LE(errors.largest, 1e-6);
    EXPECT_GT(errors.penumbra, 50U);
  }
}

TEST_F(SoftVolumeBlend, OverlapIsLessThanTheSum) {
  scenes::Scene scene = tests::floor_and_light(0.5);
  tests::add_object(scene, "low", tests::quad({0, 1, 0}, {0.4, 0, 0}, {0, 0, -0.4}));
  tests::add_object(scene, "high", tests::quad({0, 1.25, 0}, {0.4, 0, 0}, {0, 0, -0.4}));
  for (const bool shipped : {false, true}) {
    const SoftStage stage(shipped ? tests::shipped_scene("fusion") : scene, device(), 64, 48);
    const std::vector<double> exact = stage.exact();
    const Errors blended = tests::errors_of(run(stage), exact),
                 added = tests::errors_of(stage.run(*make_soft_volume(device(), {})), exact);
    fmt::print("{}: RMSE {:.4f} blended, {:.4f} added\n", shipped ? "fusion" : "two boards", blended.rmse(),
               added.rmse());
    EXPECT_LT(blended.rmse(), added.rmse());
  }
}

TEST_F(SoftVolumeBlend, RefusesWhatItCannotDo) {
  EXPECT_THROW(static_cast<void>(make_soft_volume_blend(device(), {{"split", "2"}})), UsageError);
  EXPECT_THROW(static_cast<void>(run(SoftStage(tests::shipped_scene("textured-light"), device(), 8, 8))), InputError);
}

TEST_F(SoftVolumeBlend, WithoutOccludersOnlyTheHorizonIsDark) {
  scenes::Scene scene = tests::floor_and_light(0.5);
  scene.objects[0].casts_shadow = false;
  scene.lights.push_back(scene.lights[0]);
  for (const double height : {5.0, -5.0}) {
    std::get<scenes::Rectangle>(scene.lights[0].shape).center.y = height;
    scene.lights[0].two_sided = true;
    const SoftStage stage(scene, device(), 16, 12);
    for (const auto& v : {run(stage), stage.run(*make_soft_volume(device(), {}))}) {
      for (std::size_t i = 0; i < v.size(); ++i) {
        EXPECT_EQ(v[i], height > 0 || stage.samples.triangle[i] == visibility::ViewSamples::kBackground ? 1 : 0);
      }
    }
  }
}

TEST_F(SoftVolumeBlend, TheOrderOfTrianglesChangesNoByte) {
  scenes::Scene scene = tests::shipped_scene("fusion");
  const std::vector<float> once = run(SoftStage(scene, device(), 40, 30));
  std::mt19937 random(5);
  tests::shuffle_order(scene.soup, random);
  const SoftStage stage(scene, device(), 40, 30);
  EXPECT_EQ(run(stage), once);
  EXPECT_EQ(stage.run(*make_soft_volume_blend(device(), {}), 7), once) << "in tiles";
  for (const float v : once) ASSERT_TRUE(v >= 0 && v <= 1) << v;
}

}  // namespace
}  // namespace penumbra::volumes
