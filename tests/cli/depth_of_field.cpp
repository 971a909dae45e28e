// SPDX-License-Identifier: Apache-2.0
// Tests `render` through a thin lens against the closed form of circles of confusion.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr std::uint32_t kSize = 48;
constexpr double kHalfFov = 0.25;  // tangent of half the field of view; for an orthographic picture, half its height

/// A card in the plane z = −depth, seen along −z from the origin, under a lamp.
class DepthOfField : public ProgramTest {
 protected:
  struct Card {
    double left, right, bottom, top, depth;
  };
  /// `lens`: further members of the camera.
  void write_scene(const Card& card, const json& lens, bool orthographic = false) const {
    json scene = {{"format", "penumbra-scene/1"},
                  {"size", {kSize, kSize}},
                  {"camera", {{"eye", {0, 0, 0}}, {"target", {0, 0, -1}}}},
                  {"meshes",
                   {{{"quad",
                      {{"center", {(card.left + card.right) / 2, (card.bottom + card.top) / 2, -card.depth}},
                       {"halfU", {(card.right - card.left) / 2, 0, 0}},
                       {"halfV", {0, (card.top - card.bottom) / 2, 0}}}}}}},
                  {"lights", {{{"rectangle", {{"center", {0, 0, 9}}, {"halfU", {-1, 0, 0}}, {"halfV", {0, 1, 0}}}}}}}};
    if (orthographic)
      scene["camera"]["orthographicHeight"] = 2 * kHalfFov;
    else
      scene["camera"]["verticalFov"] = 360 / std::numbers::pi * std::atan(kHalfFov);
    if (!lens.empty()) scene["camera"].update(lens);
    write("scene.json", scene.dump());
  }
  [[nodiscard]] ExrFile picture(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"render", path("scene.json"), "-o", path("out.exr")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return read_exr(path("out.exr"));
  }
};

/// Returns the share of a disk of radius 1 to the left of x.
double share_left_of(double x) {
  x = std::clamp(x, -1.0, 1.0);
  return 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / std::numbers::pi;
}

/// Across an edge, A is the share of the circle of confusion that is on the card; its radius is R |1 − z / d| at depth
/// z with the focus at d. All rows are alike, so that their mean has little of the noise of 64 points.
TEST_F(DepthOfField, AnEdgeIsAsWideAsItsCircleOfConfusion) {
  for (const bool orthographic : {false, true}) {
    const double radius = orthographic ? 0.2 : 0.5;
    for (const auto& [depth, focus] : {std::pair{2.0, 3.0}, {4.0, 2.5}}) {
      SCOPED_TRACE(depth);
      const double edge = 0.03;
      write_scene({-9, edge, -9, 9, depth}, {{"aperture", radius}, {"focusDistance", focus}}, orthographic);
      const ExrFile blurred = picture({"--pixel-samples", "64"});
      const double circle = radius * std::abs(1 - depth / focus);
      double most = 0;
      std::size_t between = 0;
      for (std::uint32_t x = 0; x < kSize; ++x) {
        double mean = 0, expected = 0;
        for (std::uint32_t y = 0; y < kSize; ++y) mean += double{blurred.floats.at("A")[y * kSize + x]} / kSize;
        for (int part = 0; part < 8; ++part) {
          const double at = (2 * (x + (part + 0.5) / 8) / kSize - 1) * kHalfFov * (orthographic ? 1 : depth);
          expected += share_left_of((edge - at) / circle) / 8;
        }
        most = std::max(most, std::abs(mean - expected));
        between += expected > 0.01 && expected < 0.99 ? 1 : 0;
      }
      EXPECT_LT(most, 0.01);  // over 48 rows of 64 points; a single pixel is off by 0.02 (RMS)
      EXPECT_GT(between, 8u);
    }
  }
}

/// A small card is spread over a disk: its total area and its middle are the same as without a lens, and its variance
/// along each axis is that of a disk, a quarter of the radius squared.
TEST_F(DepthOfField, APointIsADisk) {
  constexpr double kRadius = 0.2, kDepth = 2, kFocus = 4, kHalf = 0.05, kMiddle = 0.05;
  constexpr std::uint32_t kWide = 96;
  write_scene({kMiddle - kHalf, kMiddle + kHalf, -kHalf, kHalf, kDepth}, {});
  const ExrFile blurred =
      picture({"--size", "96x96", "--pixel-samples", "64", "--aperture", "0.2", "--focus-distance", "4"});
  double sum = 0, mean_x = 0, square_x = 0, square_y = 0;
  const double pixel = 2 * kHalfFov * kDepth / kWide;
  for (std::uint32_t i = 0; i < kWide * kWide; ++i) {
    const double share = double{blurred.floats.at("A")[i]}, x = (i % kWide + 0.5 - kWide / 2.0) * pixel,
                 y = (i / kWide + 0.5 - kWide / 2.0) * pixel;
    sum += share, mean_x += share * x, square_x += share * x * x, square_y += share * y * y;
  }
  const double circle = kRadius * std::abs(1 - kDepth / kFocus);
  const double spread = circle * circle / 4 + kHalf * kHalf / 3 + pixel * pixel / 12;
  // Each pixel of the disk sees the card through this share of the lens. `noise` is four times the relative standard
  // deviation of the sum over the disk's pixels for independent points (stratified ones have less noise). For the mean
  // of x it is scaled by half the radius, for that of x² by a quarter of the radius squared: the standard deviations of
  // x and x² over a disk.
  const double share = 4 * kHalf * kHalf / (std::numbers::pi * circle * circle);
  const double pixels = std::numbers::pi * circle * circle / (pixel * pixel);
  const double noise = 4 * std::sqrt((1 - share) / (64 * share * pixels));
  EXPECT_NEAR(sum * pixel * pixel, 4 * kHalf * kHalf, noise * 4 * kHalf * kHalf);
  EXPECT_NEAR(mean_x / sum, kMiddle, noise * circle / 2);
  EXPECT_NEAR(square_x / sum - mean_x / sum * mean_x / sum, spread, noise * circle * circle / 4);
  EXPECT_NEAR(square_y / sum, spread, noise * circle * circle / 4);
}

/// At the focus distance the whole lens sees one point. Channels of the pixel's centre do not depend on the lens.
TEST_F(DepthOfField, WhatIsInFocusIsSharp) {
  const Card card{-0.1, 0.171, -0.3, 0.222, 2};
  write_scene(card, {{"aperture", 0.2}});  // sharp at the target, one away
  const ExrFile moved = picture({"--pixel-samples", "16", "--focus-distance", "2"});
  const ExrFile without = picture({"--pixel-samples", "16", "--aperture", "0"});
  EXPECT_EQ(moved.floats.at("A"), without.floats.at("A"));
  const ExrFile blurred = picture({"--pixel-samples", "16"});
  EXPECT_NE(blurred.floats.at("A"), without.floats.at("A"));
  const Outcome few = run({"render", path("scene.json"), "-o", path("one.exr")});
  EXPECT_EQ(few.code, 0);
  EXPECT_THAT(few.err,
              HasSubstr("has an aperture: with one view sample per pixel, it looks through the lens's middle"));
  const ExrFile one = read_exr(path("one.exr"));
  for (const char* name : {"P.X", "P.Y", "N.Z", "Z", "object.X"}) {
    EXPECT_EQ(blurred.floats.at(name), one.floats.at(name)) << name;
  }
  EXPECT_EQ(blurred.integers.at("id"), one.integers.at("id"));
  EXPECT_EQ(picture({"--pixel-samples", "16"}).floats, blurred.floats) << "the points are fixed";
}

/// Moments share the lens: for what does not move, sixteen moments of one view sample cover the lens like one moment of
/// sixteen.
TEST_F(DepthOfField, MomentsShareTheLens) {
  (void)moving_scene();
  const auto blurred = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {
        "render", path("scene.glb"), "--size",           "24x16", "--frame", "3", "--fps", "10", "--shutter", "0",
        "-o",     path("out.exr"),   "--focus-distance", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return read_exr(path("out.exr")).floats;
  };
  const auto sharp = blurred({"--aperture", "1e-9", "--pixel-samples", "1", "--motion-samples", "4"});
  const auto wide = blurred({"--aperture", "0.2", "--pixel-samples", "1", "--motion-samples", "16"});
  const auto judge = blurred({"--aperture", "0.2", "--pixel-samples", "64"});
  const auto still = [&] {
    EXPECT_EQ(
        run({"render", path("scene.glb"), "--size", "24x16", "--frame", "3", "--fps", "10", "-o", path("out.exr")})
            .code,
        0);
    return read_exr(path("out.exr")).floats;
  }();
  const auto distance = [](const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(double{a[i]} - double{b[i]}, 2);
    return std::sqrt(sum / static_cast<double>(a.size()));
  };
  EXPECT_LT(distance(sharp.at("V"), still.at("V")), 1e-3);
  const double off = distance(wide.at("V"), judge.at("V"));
  EXPECT_LT(off, 0.5 * distance(still.at("V"), judge.at("V")));
  EXPECT_GT(distance(still.at("V"), judge.at("V")), 0.02);
}

TEST_F(DepthOfField, WhatCannotBeMeantIsRefused) {
  write_scene({-1, 1, -1, 1, 2}, {});
  const auto refused = [&](std::vector<std::string> more, const std::string& why, int code = 2) {
    std::vector<std::string> arguments = {"render", path("scene.json"), "-o", path("out.exr")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, code) << why;
    EXPECT_THAT(outcome.err, HasSubstr(why));
  };
  const std::vector<std::string> four = {"--pixel-samples", "4"};
  const auto with_four = [&](std::vector<std::string> more) {
    more.insert(more.end(), four.begin(), four.end());
    return more;
  };
  refused({"--aperture", "0.1", "--focus-distance", "2"}, "blur needs --pixel-samples 4 or more");
  refused(with_four({"--aperture", "0.1"}), "has no focus distance");
  refused(with_four({"--focus-distance", "2"}), "has no lens");
  refused(with_four({"--aperture", "-1"}), "expected a lens's radius");
  refused(with_four({"--aperture", "0.1", "--focus-distance", "0"}), "expected a distance above 0");
  refused(with_four({"--aperture", "0", "--focus-distance", "1"}), "there is no lens with --aperture 0");
  refused(with_four({"--aperture", "0.1", "--focus-distance", "2", "--bits", path("b.bits")}), "--bits");
  refused(with_four({"--aperture", "0.1", "--focus-distance", "2", "--method", "soft-volume"}),
          "has a lens with an aperture; methods that draw shadow volumes need a pinhole camera", 3);
  write_scene({-1, 1, -1, 1, 2}, {{"focusDistance", 2}});
  refused({}, "everything is sharp without an aperture", 3);
  write_scene({-1, 1, -1, 1, 2}, {{"aperture", -0.5}});
  refused({}, "/camera/aperture", 3);
}

}  // namespace
}  // namespace penumbra::tests
