// SPDX-License-Identifier: Apache-2.0
// Contours under a textured light: the radiance that they hide against closed forms and exact areas.

#include "tests/analytic/maps/backprojection/contour_scenes.hpp"
#include "tests/analytic/maps/backprojection/octagon_twin.hpp"

namespace penumbra::tests {
namespace {

class MapsContourTexture : public ContourTest {
 protected:
  /// Returns a stage whose light has these texels of grey, the upper row first.
  static Stage stage_of(scenes::Scene scene, std::uint32_t width, const std::vector<float>& greys,
                        std::uint32_t pixels = 40) {
    scenes::Texture texture;
    texture.width = width;
    texture.height = static_cast<std::uint32_t>(greys.size()) / width;
    for (const float grey : greys) texture.texels.emplace_back(grey);
    scene.lights.front().texture = texture;
    return {scene, pixels, pixels, light_samples(4)};
  }
  static double largest_difference(const Masks& a, const Masks& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.visibility.size(); ++i) {
      largest = std::max(largest, static_cast<double>(std::abs(a.visibility[i] - b.visibility[i])));
    }
    return largest;
  }
  /// Root mean square of V − exact over pixels whose whole light is above the tangent plane, or (`horizon`) over those
  /// whose light is partly above it.
  static double rmse(const Stage& stage, const Masks& found, const Masks& truth, bool horizon) {
    double sum = 0;
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (stage.samples.triangle[i] < 0) continue;
      const glm::dvec3 p = stage.samples.p[i], n = stage.samples.n[i];
      std::size_t above = 0;
      for (const glm::vec3& corner : stage.light.outline) above += glm::dot(n, glm::dvec3(corner) - p) > 0 ? 1 : 0;
      if (above == 0 || (above < stage.light.outline.size()) != horizon) continue;
      const double difference = static_cast<double>(found.visibility[i]) - static_cast<double>(truth.visibility[i]);
      sum += difference * difference;
      ++pixels;
    }
    EXPECT_GT(pixels, 20U);
    return std::sqrt(sum / static_cast<double>(pixels));
  }
};

const std::vector<float> kWindow = {1, 8, 3, 0, 5, 9};

// In the closed form each texel is a separate light. The tolerance is that of
// MapsContour.IsTheOctagonOfTheTexelsThatShade, times the brightest column over the mean, 13 / 8.7. A skew light has
// its texture along its own axes.
TEST_F(MapsContourTexture, IsTheOctagonWeighedTexelByTexel) {
  for (const int shape : {0, 3}) {
    const Stage stage = stage_of(under_shape(shape), 3, kWindow);
    const ParallelSquare square(stage);
    const OctagonTwin twin(stage, 96);
    const Masks found = run(maps::make_contour, stage, {{"size", "96"}});
    double largest = 0, moved = 0;
    std::size_t partly = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!square.on_floor(i)) continue;
      const double expected = twin.visibility(i, *stage.light.texture);
      partly += expected > 0.01 && expected < 0.99 ? 1 : 0;
      moved = std::max(moved, std::abs(expected - twin.visibility(i)));
      largest = std::max(largest, std::abs(static_cast<double>(found.visibility[i]) - expected));
    }
    EXPECT_GT(partly, 100U);
    EXPECT_GT(moved, 0.2) << "the texture makes a visible difference";
    EXPECT_LT(largest, 6e-5) << "shape " << shape;
    RecordProperty(fmt::format("shape {}", shape), fmt::format("{:.2g}", largest));
  }
}

// Textured lights sum lines through texels instead of sectors and triangles: for a texture of one radiance both give
// the same. Each edge is rounded to 2⁻²² of the light in either sum; there are a few hundred edges at most.
TEST_F(MapsContourTexture, OneRadianceIsNoTexture) {
  const Stage plain(ball_over_floor(1), 40, 40, light_samples(4));
  const Masks expected = run(maps::make_contour, plain, {{"size", "128"}});
  for (const std::uint32_t width : {1U, 5U}) {
    const Stage textured = stage_of(ball_over_floor(1), width, std::vector<float>(std::size_t{7} * width, 0.7F));
    EXPECT_LT(largest_difference(run(maps::make_contour, textured, {{"size", "128"}}), expected), 2e-5);
  }
}

// Any search for contours, for single pixels or in packets, adds the same integers.
TEST_F(MapsContourTexture, SearchesAndPacketsAgree) {
  const Stage stage = stage_of(ball_over_floor(0.7), 3, kWindow, 24);
  const Masks expected = run(maps::make_contour, stage, {{"size", "64"}});
  EXPECT_EQ(run(maps::make_contour, stage, {{"size", "64"}, {"traversal", "flat"}}).visibility, expected.visibility);
  EXPECT_EQ(run(maps::make_contour, stage, {{"size", "64"}, {"search", "none"}}).visibility, expected.visibility);
  EXPECT_EQ(run(maps::make_packet, stage, {{"size", "64"}}).visibility, expected.visibility);
  EXPECT_EQ(run(maps::make_packet, stage, {{"size", "64"}, {"packet", "1x1"}}).visibility, expected.visibility);
}

// A plate, and a wall whose light is partly below its horizon: the error is about that of a light of one radiance. An
// edge that is off by a share of the light's width moves V by that share times the brightest column over the mean, 13 /
// 8.7.
TEST_F(MapsContourTexture, ErrsAsUnderOneRadiance) {
  scenes::Scene scene = parallel_square();
  add_quad(scene, {2.2, 0.9, -0.5}, {1, 0, 0}, {0, 0.9, 0});
  const Stage plain(scene, 40, 40, light_samples(4)), textured = stage_of(scene, 3, kWindow);
  const Masks white = run(maps::make_contour, plain, {{"size", "128"}}),
              window = run(maps::make_contour, textured, {{"size", "128"}}), white_truth = exact(plain),
              window_truth = exact(textured);
  EXPECT_GT(largest_difference(white_truth, window_truth), 0.2);
  for (const bool horizon : {false, true}) {
    const double before = rmse(plain, white, white_truth, horizon),
                 after = rmse(textured, window, window_truth, horizon);
    RecordProperty(horizon ? "horizon" : "judged", fmt::format("{:.4f}, {:.4f}", before, after));
    fmt::print("{}: RMSE {:.4f}, textured {:.4f}\n", horizon ? "horizon" : "judged", before, after);
    EXPECT_LT(after, 1.6 * before + 0.001);
    EXPECT_LT(before, 0.03);
  }
}

}  // namespace
}  // namespace penumbra::tests
