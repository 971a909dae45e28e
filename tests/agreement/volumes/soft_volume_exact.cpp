// SPDX-License-Identifier: Apache-2.0
// Compares soft-volume with exact areas: it is right where its model holds, and elsewhere wrong by as much as the model
// predicts.

#include "tests/agreement/volumes/soft_stage.hpp"

#include "volumes/soft/methods.hpp"

namespace penumbra::volumes {
namespace {

using tests::Errors;
using tests::SoftStage;

class SoftVolumeExact : public tests::DeviceTest {
 protected:
  static std::vector<float> run(const SoftStage& stage, const visibility::MethodOptions& options = {}) {
    return stage.run(*make_soft_volume(device(), options));
  }
};

/// Tilted convex boards side by side, at different heights, no two of which are behind one another as seen from a point
/// of the light: each has its own cell of a 3 × 3 grid, and shadows of cells stay apart.
TEST_F(SoftVolumeExact, PlanarConvexOccludersThatDoNotOverlap) {
  for (const double half : {0.1, 0.4}) {
    scenes::Scene scene = tests::floor_and_light(half);
    std::mt19937 random(3);
    const auto draw = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int i = 0; i < 9; ++i) {
      const int column = i % 3, row = i / 3;
      const glm::dvec3 center((column - 1) * 1.2, draw(0.3, 0.9), (row - 1) * 1.2);
      const double reach = draw(0.15, 0.35), turn = draw(0, 3);
      const glm::dvec3 u = reach * glm::dvec3(std::cos(turn), draw(-0.3, 0.3), std::sin(turn));
      const glm::dvec3 v = reach * glm::dvec3(-std::sin(turn), draw(-0.3, 0.3), std::cos(turn));
      std::vector<tests::Corners> board = tests::quad(center, u, v);
      if (i % 2 == 0) board.resize(1);
      tests::add_object(scene, "board", board);
    }
    const SoftStage stage(scene, device(), 64, 48);
    const Errors errors = tests::errors_of(run(stage), stage.exact());
    fmt::print("boards, light {}: {} pixels, {} in penumbra, off by {:.1e} at most\n", half, errors.pixels,
               errors.penumbra, errors.largest);
    EXPECT_LE(errors.largest, 2e-3);
    EXPECT_GT(errors.penumbra, 40U);
  }
}

/// A solid's silhouette from the centre is not the receiver's. The twin predicts the error: the difference of the same
/// integral with either silhouette.
TEST_F(SoftVolumeExact, ASolidIsOffByWhatItsSilhouettesPredict) {
  for (const bool cube : {false, true}) {
    for (const double half : {0.25, 0.5, 1.0}) {
      scenes::Scene scene = tests::floor_and_light(half);
      const mesh::TriangleSoup solid =
          cube ? mesh::make_box({0, 1, 0}, {0.5, 0.5, 0.5}) : mesh::make_icosphere({0, 1, 0}, 0.5, 3);
      tests::add_object(scene, "solid", tests::triangles_of(solid));
      const SoftStage stage(scene, device(), 48, 36);
      const std::vector<float> found = run(stage);
      const std::vector<double> exact = stage.exact(), by_center = stage.twin(Viewer::center),
                                by_receiver = stage.twin(Viewer::receiver);
      double worst = 0, largest = 0;
      for (std::size_t i = 0; i < exact.size(); ++i) {
        if (std::isnan(exact[i])) continue;
        const double measured = static_cast<double>(found[i]) - exact[i], predicted = by_center[i] - by_receiver[i];
        worst = std::max(worst, std::abs(measured - predicted));
        largest = std::max(largest, std::abs(measured));
      }
      fmt::print("{}, light {}: off by {:.4f} at most, as predicted within {:.1e}\n", cube ? "cube" : "sphere", half,
                 largest, worst);
      EXPECT_LE(worst, 1e-3);
      // A cube under a light no wider than itself has no error to predict: the whole light sees only the cube's top.
      EXPECT_GT(largest, !cube || half > 0.5 ? 1e-3 : 0.0);
    }
  }
}

/// Two equal boards, one exactly behind the other as seen from the light's centre and some p: they hide as much as one,
/// but soft-volume adds them.
TEST_F(SoftVolumeExact, FusionIsAdded) {
  scenes::Scene scene = tests::floor_and_light(0.5);
  tests::add_object(scene, "low", tests::quad({0, 1, 0}, {0.4, 0, 0}, {0, 0, -0.4}));
  tests::add_object(scene, "high", tests::quad({0, 1.25, 0}, {0.4, 0, 0}, {0, 0, -0.4}));
  const SoftStage stage(scene, device(), 64, 48);
  const std::vector<double> exact = stage.exact();
  // A board at height y with half-size r covers, as seen from p at height 0, the product of two overlaps with [−1, 1]²
  // of the light (half-size s at height h).
  const std::vector<double> sum = stage.at_judged([&](std::size_t i) {
    const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
    if (p.y > 0.5) return std::numeric_limits<double>::quiet_NaN();
    double blocked = 0;
    for (const double y : {1.0, 1.25}) {
      const auto overlap = [&](double at) {
        const double scale = 5 / y, low = at + scale * (-0.4 - at), high = at + scale * (0.4 - at);
        return std::max(0.0, std::min(high, 0.5) - std::max(low, -0.5));
      };
      blocked += overlap(p.x) * overlap(p.z);
    }
    return std::max(0.0, 1 - blocked);
  });
  const std::vector<float> whole = run(stage);
  const Errors predicted = tests::errors_of(whole, sum);
  EXPECT_LE(predicted.largest, 1e-5);  // p is stored in float32: 2⁻²⁴ · 5 of a penumbra half a unit wide
  double last = tests::errors_of(whole, exact).rmse();
  fmt::print("fusion: RMSE {:.4f}, the sum itself within {:.1e}", last, predicted.largest);
  EXPECT_GT(last, 0.01);
  for (const char* split : {"2", "3"}) {
    const double rmse = tests::errors_of(run(stage, {{"split", split}}), exact).rmse();
    fmt::print("; split {}: {:.4f}", split, rmse);
    EXPECT_LT(rmse, last);
    last = rmse;
  }
  fmt::print("\n");
}

TEST_F(SoftVolumeExact, SplittingBringsSilhouettesCloser) {
  scenes::Scene scene = tests::floor_and_light(1);
  tests::add_object(scene, "cube", tests::triangles_of(mesh::make_box({0.1, 1, 0.15}, {0.4, 0.5, 0.4})));
  const SoftStage stage(scene, device(), 64, 48);
  const std::vector<double> exact = stage.exact();
  double last = 1;
  for (const char* split : {"1", "2", "3"}) {
    const Errors errors = tests::errors_of(run(stage, {{"split", split}}), exact);
    fmt::print("cube, split {}: RMSE {:.4f}, at most {:.4f}\n", split, errors.rmse(), errors.largest);
    EXPECT_LT(errors.rmse(), last);
    last = errors.rmse();
  }
}

}  // namespace
}  // namespace penumbra::volumes
