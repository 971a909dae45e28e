// SPDX-License-Identifier: Apache-2.0
// Tests domes as a user meets them: what `render` computes by default, files that hold light samples, the orientation
// of sky pictures, and refusals.

#include "tests/cli/program.hpp"
#include "tests/report_json.hpp"

#include "base/exr.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class DomeCommands : public ProgramTest {
 protected:
  /// A floor with a wall at x = 1, seen from above, under this light.
  void scene(const std::string& light) const {
    write("scene.json", R"({"format": "penumbra-scene/1", "size": [24, 16],
      "camera": {"eye": [0, 6, 0.01], "target": [0, 0, 0], "verticalFov": 50},
      "meshes": [
        {"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [2, 0, 0], "halfV": [0, 0, -2]}, "color": [0.5, 0.25, 0.75]},
        {"name": "wall", "quad": {"center": [1, 2, 0], "halfU": [0, 2, 0], "halfV": [0, 0, 8]}}],
      "lights": [)" + light +
                            "]}");
  }
  [[nodiscard]] Outcome render(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"render",        path("scene.json"), "-o",
                                          path("out.exr"), "--stats",          path("stats.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  [[nodiscard]] ExrFile image() const { return read_exr(path("out.exr")); }
  [[nodiscard]] json stats() const { return json::parse(read("stats.json")); }
  /// Makes a Radiance picture of 8 by 4 pixels, all black except for one: 1 in red, green and blue.
  void sky(std::size_t column, std::size_t row) const {
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n";
    for (std::size_t i = 0; i < 32; ++i)
      text += i == row * 8 + column ? std::string("\x80\x80\x80\x81", 4) : std::string(4, '\0');
    write("sky.hdr", text);
  }
};

TEST_F(DomeCommands, OfOneRadianceAreExactByDefault) {
  scene(R"({"name": "sky", "dome": {"half": true}, "radiance": [2, 2, 2]})");
  ASSERT_EQ(render({}).code, 0);
  EXPECT_EQ(stats().at("method"), "edge-scatter");
  EXPECT_EQ(stats().at("lights").at(0).at("quantity"), "area");
  const ExrFile by_rows = image();
  ASSERT_EQ(render({"--method", "exact"}).code, 0);
  const ExrFile exact = image();
  for (std::size_t i = 0; i < exact.floats.at("V").size(); ++i) {
    EXPECT_NEAR(by_rows.floats.at("V")[i], exact.floats.at("V")[i], 2e-7);
    EXPECT_NEAR(by_rows.floats.at("R")[i], exact.floats.at("R")[i], 1e-6);
    if (exact.floats.at("A")[i] == 0) {
      EXPECT_EQ(exact.floats.at("V")[i], 1);
      EXPECT_EQ(exact.floats.at("R")[i], 0);  // the background: domes are not visible
    } else if (std::abs(exact.floats.at("N.Y")[i] - 1) < 1e-6F) {
      EXPECT_NEAR(exact.floats.at("R")[i], 2 * 0.5 * exact.floats.at("V")[i], 1e-6);  // irradiance / π times the colour
    }
  }
}

/// --bits holds the directions: V of a floor that faces up is the sum of the visible directions' heights over that of
/// all directions above the horizon.
TEST_F(DomeCommands, BitsHoldDirections) {
  scene(R"({"name": "sky", "dome": {"rotate": 30}})");
  ASSERT_EQ(render({"--method", "view-sample", "--light-samples", "100", "--sample-pattern", "sobol", "--bits",
                    path("out.bits")})
                .code,
            0);
  const ExrFile exr = image();
  const std::string bits = read("out.bits");
  const std::string line = bits.substr(0, bits.find('\n'));
  EXPECT_EQ(line, "penumbra-bits/1 24 16 100");
  std::size_t at = line.size() + 1 + 3 * sizeof(double);
  const auto next = [&](auto& value) {
    std::memcpy(&value, bits.data() + at, sizeof(value));
    at += sizeof(value);
  };
  std::vector<std::array<float, 3>> directions(100);
  for (auto& d : directions) {
    next(d);
    EXPECT_NEAR(std::hypot(d[0], d[1], d[2]), 1, 1e-6);
  }
  std::size_t partly = 0;
  for (std::size_t i = 0; i < 24 * 16; ++i) {
    std::array<float, 3> p{};
    std::int32_t triangle = 0;
    std::array<std::uint32_t, 4> mask{};
    next(p), next(triangle), next(mask);
    if (triangle < 0 || std::abs(exr.floats.at("N.Y")[i] - 1) > 1e-6F) continue;
    double some = 0, all = 0;
    for (std::size_t j = 0; j < 100; ++j) {
      const double height = std::max(0.0F, directions[j][1]);
      all += height;
      if ((mask[j / 32] >> j % 32 & 1U) != 0) {
        some += height;
        EXPECT_GT(directions[j][1], 0) << "a direction below the horizon is not visible";
      }
    }
    EXPECT_NEAR(exr.floats.at("V")[i], some / all, 1e-6);
    partly += some > 0 && some < all ? 1 : 0;
  }
  EXPECT_GT(partly, 50U);
}

/// The report draws a dome's light samples in the unit disk, each at its own place and with its mask.
TEST_F(DomeCommands, ReportsDrawLightSamples) {
  scene(R"({"name": "sky", "dome": {"half": true}})");
  ASSERT_EQ(run({"compare", path("scene.json"), "-o", path("dir"), "--runs", "1", "--methods", "raytrace",
                 "--light-samples", "64", "--reference-samples", "same"})
                .code,
            0);
  const json light = report_json(read("dir/report.html")).at("lights").at(0);
  EXPECT_TRUE(light.at("round").get<bool>());
  ASSERT_EQ(light.at("samples").size(), 64u);
  double within = 0;
  for (const json& place : light.at("samples")) {
    const double radius = std::hypot(place.at(0).get<double>(), place.at(1).get<double>());
    EXPECT_LE(radius, 1 + 1e-4);
    within += radius < std::sqrt(0.5) ? 1 : 0;
  }
  EXPECT_EQ(within, 32) << "half of them are above 30 degrees, where half of the solid angle is";
}

/// The picture's right half is toward +X, where the wall is; after half a turn it is not.
TEST_F(DomeCommands, APictureLooksWhereItIsTurned) {
  sky(6, 1);  // azimuth from 3/4 to 7/8 of a turn, from +X toward +Z; 0 to 45 degrees high
  const auto mean_v = [&](const std::string& dome) {
    scene(fmt::format(R"({{"name": "sky", "dome": {}}})", dome));
    const Outcome outcome = render({});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, testing::Not(HasSubstr("no method gives its exact area")));
    EXPECT_EQ(stats().at("lights").at(0).at("quantity"), "area");
    EXPECT_EQ(stats().at("lightSamples"), 0);
    const ExrFile exr = image();
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < exr.floats.at("V").size(); ++i) {
      if (exr.floats.at("A")[i] == 0 || exr.floats.at("P.X")[i] > 0.9F || exr.floats.at("P.Y")[i] > 0) continue;
      sum += exr.floats.at("V")[i];
      ++count;
    }
    return sum / count;
  };
  EXPECT_LT(mean_v(R"({"image": "sky.hdr"})"), 0.1);
  EXPECT_EQ(mean_v(R"({"image": "sky.hdr", "rotate": 180})"), 1);
  EXPECT_EQ(mean_v(R"({"image": "sky.hdr", "rotate": 270})"), 1);  // from +Z toward −X
  // The floor's irradiance from a texel of radiance 1: its solid angle times the mean height.
  constexpr double kTurn = 2 * 3.14159265358979;
  const double irradiance = kTurn / 8 * 0.25;  // ∫ h dh dφ, h from 0 to cos 45°, φ over an eighth of a turn
  const ExrFile exr = image();
  for (std::size_t i = 0; i < exr.floats.at("V").size(); ++i) {
    if (exr.floats.at("A")[i] == 0 || exr.floats.at("P.Y")[i] > 0) continue;
    EXPECT_NEAR(exr.floats.at("B")[i], exr.floats.at("V")[i] * 10 * 0.75 * irradiance / (kTurn / 2), 1e-6);
  }
}

/// A dome may ask for light samples (`sampled`); other lights next to it keep their exact areas. A named method decides
/// for itself.
TEST_F(DomeCommands, SampledOnesAreCountedByDefault) {
  sky(6, 1);
  for (const char* parts : {R"("half": true)", R"("image": "sky.hdr")"}) {
    const auto with = [&](const char* more) {
      scene(fmt::format(R"({{"name": "sky", "dome": {{{}{}}}}},
        {{"name": "day", "sun": {{"direction": [0.4, -1, 0.3], "angle": 5}}}})",
                        parts, more));
    };
    with(R"(, "sampled": true)");
    const Outcome outcome = render({});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("gives its exact area"), std::string::npos) << "nobody must be told what the scene says";
    const json lights = stats().at("lights");
    EXPECT_EQ(lights.at(0).at("quantity"), "count");
    EXPECT_EQ(lights.at(0).at("lightSamples"), 256);
    EXPECT_EQ(lights.at(1).at("quantity"), "area");
    const std::vector<float> counted = image().floats.at("sky.V");
    for (const char* method : {"exact", "edge-scatter:rows=exact"}) {
      ASSERT_EQ(render({"--method", method}).code, 0);
      EXPECT_EQ(stats().at("lights").at(0).at("quantity"), "area") << method;
    }
    EXPECT_NE(image().floats.at("sky.V"), counted);
    ASSERT_EQ(render({"--method", "edge-scatter"}).code, 0);
    EXPECT_EQ(stats().at("lights").at(0).at("quantity"), "count");
    ASSERT_EQ(run({"convert", path("scene.json"), "-o", path("again.json")}).code, 0);
    EXPECT_EQ(json::parse(read("again.json")).at("lights").at(0).at("dome").at("sampled"), true);
    with("");
    ASSERT_EQ(render({}).code, 0);
    EXPECT_EQ(stats().at("lights").at(0).at("quantity"), "area");
    ASSERT_EQ(render({"--light-samples", "256"}).code, 0);
    EXPECT_EQ(image().floats.at("sky.V"), counted);
    ASSERT_EQ(run({"convert", path("scene.json"), "-o", path("again.json")}).code, 0);
    EXPECT_FALSE(json::parse(read("again.json")).at("lights").at(0).at("dome").contains("sampled"));
  }
}

TEST_F(DomeCommands, AVisibleOneIsTheBackground) {
  scene(R"({"name": "sky", "dome": {}, "radiance": [3, 2, 1], "visible": true})");
  ASSERT_EQ(run({"render", path("scene.json"), "-o", path("out.exr"), "--camera", "0,6,0.01:0,0,0:100"}).code, 0);
  const ExrFile exr = image();
  std::size_t background = 0;
  for (std::size_t i = 0; i < exr.floats.at("A").size(); ++i) {
    if (exr.floats.at("A")[i] != 0) continue;
    ++background;
    EXPECT_EQ(exr.floats.at("R")[i], 3);
    EXPECT_EQ(exr.floats.at("B")[i], 1);
  }
  EXPECT_GT(background, 10U);
}

TEST_F(DomeCommands, GoThroughJsonWithTheirPicture) {
  sky(6, 1);
  scene(R"({"name": "sky", "dome": {"image": "sky.hdr", "rotate": 20, "half": true}, "visible": true})");
  ASSERT_EQ(render({}).code, 0);
  const std::vector<float> before = image().floats.at("R");
  ASSERT_EQ(run({"convert", path("scene.json"), "-o", path("again.json")}).code, 0);
  ASSERT_EQ(run({"render", path("again.json"), "-o", path("out.exr")}).code, 0);
  EXPECT_EQ(image().floats.at("R"), before);
  const Outcome glb = run({"convert", path("scene.json"), "-o", path("again.glb")});
  EXPECT_EQ(glb.code, 3);
  EXPECT_THAT(glb.err, HasSubstr("dome"));
}

TEST_F(DomeCommands, WhatCannotDoThemSaysSo) {
  scene(R"({"name": "sky", "dome": {}})");
  for (const char* method :
       {"view-sample-planar", "alias-free", "hierarchical-penumbra", "view-sample:variant=sintorn"}) {
    const Outcome outcome = render({"--method", method});
    EXPECT_EQ(outcome.code, 3) << method;
    EXPECT_THAT(outcome.err, HasSubstr("light \"sky\" is a dome")) << method;
  }
  EXPECT_EQ(run({"wedges", path("scene.json"), "--validate"}).code, 3);
  sky(6, 1);
  scene(R"({"name": "sky", "dome": {"image": "sky.hdr"}})");
  EXPECT_EQ(render({"--method", "exact"}).code, 0);
  ASSERT_EQ(render({"--add-light", "dome", "--light", "dome"}).code, 0);
}

TEST_F(DomeCommands, BadOnesAreRefusedWithTheirPlace) {
  sky(6, 3);
  write("text.hdr", "no picture");
  const std::vector<std::pair<std::string, std::string>> cases{
      {R"({"dome": {"image": "none.hdr"}})", "none.hdr"},
      {R"({"dome": {"image": "text.hdr"}})", "no Radiance"},
      {R"({"dome": {"image": "sky.hdr", "half": true}})", "black above the horizon"},
      {R"({"dome": {"up": [0, 0, 0]}})", "up is zero"},
      {R"({"dome": {"radius": 1}})", "radius"},
      {R"({"sun": {"direction": [0, -1, 0], "angle": 1}, "visible": true})", "only a \"dome\" can be visible"},
  };
  for (const auto& [light, words] : cases) {
    scene(light);
    const Outcome outcome = render({});
    EXPECT_EQ(outcome.code, 3) << light;
    EXPECT_THAT(outcome.err, HasSubstr(words)) << light;
  }
}

}  // namespace
}  // namespace penumbra::tests
