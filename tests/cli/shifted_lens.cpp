// SPDX-License-Identifier: Apache-2.0
// Tests `render` through a shifted lens: it shows a part of a larger picture.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace penumbra::tests {
namespace {

using nlohmann::json;

/// A picture of 40 × 30 whose lens is shifted 15 pixels to the right and 6 down shows that part of a picture of 70 ×
/// 42, with any method, including those that draw volumes on the screen.
TEST_F(ProgramTest, AShiftedLensShowsPartOfALargerPicture) {
  constexpr std::uint32_t kWidth = 40, kHeight = 30, kRight = 15, kDown = 6;
  constexpr std::uint32_t kWide = kWidth + 2 * kRight, kHigh = kHeight + 2 * kDown;
  json scene = {{"format", "penumbra-scene/1"},
                {"meshes",
                 {{{"quad", {{"center", {0, 0, 0}}, {"halfU", {4, 0, 0}}, {"halfV", {0, 0, -4}}}}},
                  {{"quad", {{"center", {0.4, 1, 0}}, {"halfU", {0.7, 0.1, 0}}, {"halfV", {0, 0.1, -0.5}}}}}}},
                {"lights", {{{"rectangle", {{"center", {0, 3, 0}}, {"halfU", {0.4, 0, 0}}, {"halfV", {0, 0, 0.4}}}}}}}};
  const json camera = {{"eye", {-1.2, 2.5, 4}}, {"target", {-1, 1, 0}}};
  const double half = std::tan(std::numbers::pi / 8);
  scene["size"] = {kWidth, kHeight};
  scene["camera"] = camera;
  scene["camera"]["shift"] = {static_cast<double>(kRight) / kHeight, -static_cast<double>(kDown) / kHeight};
  write("part.json", scene.dump());
  scene["size"] = {kWide, kHigh};
  scene["camera"] = camera;
  scene["camera"]["verticalFov"] = 360 / std::numbers::pi * std::atan(half * kHigh / kHeight);
  write("whole.json", scene.dump());
  for (const char* method : {"raytrace", "view-sample", "hard-volume", "wedge-ramp", "soft-volume", "pcss"}) {
    SCOPED_TRACE(method);
    for (const char* name : {"part", "whole"}) {
      const std::string file = name;
      ASSERT_EQ(
          run({"render", path(file + ".json"), "-o", path(file + ".exr"), "--method", method, "--light-samples", "64"})
              .code,
          0);
    }
    const ExrFile part = read_exr(path("part.exr")), whole = read_exr(path("whole.exr"));
    std::size_t shadowed = 0, differing = 0;
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        const std::size_t here = std::size_t{y} * kWidth + x,
                          there = (std::size_t{y} + 2 * kDown) * kWide + x + 2 * kRight;
        // The two results are two roundings of the tangent apart.
        EXPECT_NEAR(part.floats.at("P.X")[here], whole.floats.at("P.X")[there], 1e-5f);
        EXPECT_NEAR(part.floats.at("Z")[here], whole.floats.at("Z")[there], 1e-5f);
        differing += std::abs(part.floats.at("V")[here] - whole.floats.at("V")[there]) > 1.5f / 64 ? 1 : 0;
        shadowed += part.floats.at("A")[here] > 0 && part.floats.at("V")[here] < 1 ? 1 : 0;
      }
    }
    EXPECT_EQ(differing, 0u);
    EXPECT_GT(shadowed, 20u);
  }
}

}  // namespace
}  // namespace penumbra::tests
