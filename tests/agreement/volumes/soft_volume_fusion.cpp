// SPDX-License-Identifier: Apache-2.0
// Tests soft-volume with other rules than the sum: each object's share against a scene in which only that object casts,
// and all rules against exact areas. Tolerance: V is stored in float, twice here.

#include "tests/agreement/volumes/soft_stage.hpp"

#include "volumes/soft/fused_volume.hpp"
#include "volumes/soft/methods.hpp"

namespace penumbra::volumes {
namespace {

using tests::Errors;
using tests::SoftStage;

constexpr std::array kRules{"sum", "max", "product", "average"};

class SoftVolumeFusion : public tests::DeviceTest {
 protected:
  static std::vector<float> run(const SoftStage& stage, const std::string& fusion,
                                visibility::MethodOptions options = {}) {
    options["fusion"] = fusion;
    return stage.run(*make_soft_volume(device(), options));
  }
  static scenes::Scene boards() {
    scenes::Scene scene = tests::floor_and_light(1);
    tests::add_object(scene, "board", tests::quad({0.2, 1, 0}, {0.8, 0, 0.1}, {0, 0.1, -0.7}));
    tests::add_object(scene, "above", tests::quad({-0.3, 1.7, 0.2}, {0.6, 0, 0.1}, {0, 0, -0.7}));
    return scene;
  }
};

/// Each rule does what its name says with V of the floor and one of the boards alone; the floor hides nothing of
/// itself.
TEST_F(SoftVolumeFusion, FusesWhatEachObjectHides) {
  const scenes::Scene scene = boards();
  const SoftStage stage(scene, device(), 48, 36);
  std::vector<std::vector<float>> alone;
  for (std::size_t left_out = 1; left_out <= 2; ++left_out) {
    scenes::Scene one = scene;
    one.objects[left_out].casts_shadow = false;
    alone.push_back(run(SoftStage(one, device(), 48, 36), "sum"));
  }
  for (const char* rule : kRules) {
    const std::vector<float> found = run(stage, rule);
    std::size_t both = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!stage.judged(i)) continue;
      const double a = 1 - static_cast<double>(alone[0][i]), b = 1 - static_cast<double>(alone[1][i]);
      const double sum = std::min(a + b, 1.0), max = std::max(a, b);
      const std::string name = rule;
      const double hidden = name == "sum"       ? sum
                            : name == "max"     ? max
                            : name == "product" ? 1 - (1 - a) * (1 - b)
                                                : 0.5 * (sum + max);
      both += a > 0 && b > 0 ? 1 : 0;
      ASSERT_NEAR(found[i], 1 - hidden, 3e-7) << rule << ", pixel " << i;
    }
    EXPECT_GT(both, 100U);
  }
}

/// Shares of planar boards are right one by one, so the visible part lies between sum and max (course notes, equation
/// 1.5).
TEST_F(SoftVolumeFusion, BoundsWhatIsVisible) {
  const SoftStage stage(boards(), device(), 48, 36);
  const std::vector<double> exact = stage.exact();
  const std::vector<float> sum = run(stage, "sum"), max = run(stage, "max");
  std::map<std::string, double> rmse;
  for (const char* rule : kRules) rmse[rule] = tests::errors_of(run(stage, rule), exact).rmse();
  std::size_t between = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (std::isnan(exact[i])) continue;
    EXPECT_LE(sum[i], exact[i] + 1e-6) << i;
    EXPECT_GE(max[i], exact[i] - 1e-6) << i;
    between += sum[i] + 1e-3 < exact[i] && exact[i] + 1e-3 < max[i] ? 1 : 0;
  }
  EXPECT_GT(between, 10U);
  for (const auto& [rule, error] : rmse) fmt::print("two boards, {}: RMSE {:.4f}\n", rule, error);
  EXPECT_LT(rmse["product"], rmse["sum"]);
  EXPECT_LT(rmse["average"], rmse["sum"]);
}

/// Parts of the light are fused separately; for one occluder all rules give the same.
TEST_F(SoftVolumeFusion, KeepsTilesPartsAndSingleOccluders) {
  const SoftStage stage(boards(), device(), 48, 36);
  const auto method = make_soft_volume(device(), {{"fusion", "product"}, {"split", "2"}});
  const std::vector<float> whole = stage.run(*method);
  EXPECT_EQ(stage.run(*method, 7), whole);
  const std::vector<double> exact = stage.exact();
  EXPECT_LT(tests::errors_of(whole, exact).rmse(), tests::errors_of(run(stage, "product"), exact).rmse());
  scenes::Scene single = boards();
  single.objects[1].casts_shadow = single.objects[0].casts_shadow = false;
  const SoftStage one(single, device(), 48, 36);
  const std::vector<float> sum = run(one, "sum");
  for (const char* rule : kRules) {
    const std::vector<float> found = run(one, rule);
    for (std::size_t i = 0; i < sum.size(); ++i) ASSERT_NEAR(found[i], sum[i], 2e-7) << rule << ", pixel " << i;
  }
}

/// Nothing below the horizon is hidden: rules fuse shares of the part above it.
TEST_F(SoftVolumeFusion, SharesAreOfWhatIsAboveTheHorizon) {
  FusedShare share;
  share.add(0.2, 0.5);
  share.add(0.1, 0.5);
  EXPECT_NEAR(share.visible(Fusion::sum, 0.5), 0.2, 1e-15);
  EXPECT_NEAR(share.visible(Fusion::max, 0.5), 0.3, 1e-15);
  EXPECT_NEAR(share.visible(Fusion::product, 0.5), 0.5 * 0.6 * 0.8, 1e-15);
  EXPECT_NEAR(share.visible(Fusion::average, 0.5), 0.25, 1e-15);
  share.add(0.4, 0.5);
  EXPECT_EQ(share.visible(Fusion::sum, 0.5), 0.0);
}

/// Edges through the light's centre as seen from a row and a column of pixels.
scenes::Scene edges_at_the_centre() {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  tests::add_object(scene, "boards", tests::quad({0.5, 1, 0.5}, {0.5, 0, 0}, {0, 0, 0.5}));
  tests::add_object(scene, "more", tests::quad({-0.5, 1, -0.5}, {0.5, 0, 0}, {0, 0, 0.5}));
  scene.lights.push_back(tests::ceiling_light(2, 0.5));
  scene.cameras.push_back(tests::camera({0, 0.5, 0}, {0, 0, 0}, 150));
  scene.cameras[0].up = {0, 0, -1};
  return scene;
}

/// With as=published, floats decide on which side of the centre an edge passes. Where they are wrong, the number of
/// layers is off by one, and V by the part of the light on one side of an edge through its centre. With as=repaired, no
/// pixel is wrong.
TEST_F(SoftVolumeFusion, SidesByFloatsAreAWholeLayerOff) {
  const SoftStage stage(edges_at_the_centre(), device(), 65, 65);
  const std::vector<double> right = stage.twin(Viewer::center);
  for (const bool published : {false, true}) {
    const auto method = make_soft_volume(device(), {{"as", published ? "published" : "repaired"}});
    const std::vector<float> found = stage.run(*method);
    std::size_t wrong = 0, half = 0;
    double largest = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (std::isnan(right[i])) continue;
      const double off = std::abs(found[i] - right[i]);
      wrong += off > 1e-6 ? 1 : 0;
      half += off > 0.45 ? 1 : 0;
      largest = std::max(largest, off);
    }
    fmt::print("{}: {} of {} pixels wrong, {} by half of the light or more, at most {:.2f}; {} on the host\n",
               published ? "published" : "repaired", wrong, found.size(), half, largest,
               method->counters().at("pixelsOnHost"));
    if (published) {
      EXPECT_GT(wrong, 30U);
      EXPECT_GT(half, 10U);
      EXPECT_LT(wrong, 129U)
          << "only pixels of the row and the column that see an edge at the light's centre may be wrong";
      EXPECT_EQ(method->counters().at("pixelsOnHost"), 0U);
    } else {
      EXPECT_EQ(wrong, 0U);
    }
  }
}

/// Here one count can be wrong by a whole light; the majority of three counts is right except where a vertex is at the
/// centre.
TEST_F(SoftVolumeFusion, VotesRepairSidesThatFloatsGetWrong) {
  const SoftStage stage(edges_at_the_centre(), device(), 65, 65);
  const std::vector<double> right = stage.twin(Viewer::center);
  const auto method = make_soft_volume(device(), {{"fusion", "vote"}});
  const std::vector<float> found = stage.run(*method);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!std::isnan(right[i]) && std::abs(found[i] - right[i]) > 1e-6) ++wrong;
  }
  const auto counters = method->counters();
  fmt::print("edges at the centre: {} pixels overruled, {} without majority, {} wrong\n",
             counters.at("pixelsOverruled"), counters.at("pixelsWithoutMajority"), wrong);
  EXPECT_GT(counters.at("pixelsOverruled"), 10U);
  EXPECT_LE(wrong, 1U);
}

/// All three counts agree where silhouettes are those of the centre; elsewhere the majority is no worse than one count
/// alone.
TEST_F(SoftVolumeFusion, VotesAgreeOnShippedScenes) {
  for (const char* name : {"parallel-square", "contact", "fusion"}) {
    const SoftStage stage(tests::shipped_scene(name), device(), 48, 36);
    const std::vector<double> exact = stage.exact();
    const auto method = make_soft_volume(device(), {{"fusion", "vote"}});
    const Errors vote = tests::errors_of(stage.run(*method), exact), one = tests::errors_of(run(stage, "sum"), exact);
    fmt::print("{}: RMSE {:.4f} by votes, {:.4f} by one count; {} pixels overruled, {} without majority\n", name,
               vote.rmse(), one.rmse(), method->counters().at("pixelsOverruled"),
               method->counters().at("pixelsWithoutMajority"));
    EXPECT_LE(vote.rmse(), one.rmse() + 0.002) << name;
  }
}

}  // namespace
}  // namespace penumbra::volumes
