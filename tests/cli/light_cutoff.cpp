// SPDX-License-Identifier: Apache-2.0
// Tests --light-cutoff: which lights are left out of which pixels, compared with the light of the same scene when
// nothing in it casts a shadow.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace penumbra::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr std::array kLamps = {"key", "red", "spot"};
constexpr std::array kChannels = {"R", "G", "B"};

class LightCutoff : public ProgramTest {
 protected:
  LightCutoff() {
    write("shadows.json", scene(true).dump());
    write("open.json", scene(false).dump());
  }
  /// A floor, and two blocks of color under three lamps.
  [[nodiscard]] static json scene(bool casts) {
    const auto quad = [&](json center, json u, json v, json color) {
      return json{{"quad", {{"center", std::move(center)}, {"halfU", std::move(u)}, {"halfV", std::move(v)}}},
                  {"color", std::move(color)},
                  {"castsShadow", casts}};
    };
    return {{"format", "penumbra-scene/1"},
            {"size", {32, 24}},
            {"camera", {{"eye", {0, 5, 6}}, {"target", {0, 0, 0}}}},
            {"meshes",
             {quad({0, 0, 0}, {5, 0, 0}, {0, 0, -5}, {0.6, 0.5, 0.4}),
              quad({0.3, 0.8, 0}, {0.6, 0.1, 0}, {0, 0.1, -0.6}, {0.2, 0.9, 0.7}),
              quad({-1.5, 0.6, 0.4}, {0.3, 0, 0}, {0, 0, -0.8}, {0.5, 0.5, 0.5})}},
            {"lights",
             {{{"name", "key"},
               {"rectangle", {{"center", {2, 3, 0}}, {"halfU", {0.4, 0, 0}}, {"halfV", {0, 0, 0.3}}}},
               {"radiance", {20, 20, 20}}},
              {{"name", "red"}, {"sphere", {{"center", {-2, 1.6, 1}}, {"radius", 0.1}}}, {"radiance", {9, 1, 1}}},
              {{"name", "spot"},
               {"sphere",
                {{"center", {0, 2.5, -0.5}},
                 {"radius", 0.1},
                 {"cone", {{"direction", {0, -1, 0}}, {"inner", 15}, {"outer", 30}, {"smooth", true}}}}},
               {"radiance", {30, 40, 50}}}}}};
  }
  [[nodiscard]] ExrFile picture(const std::string& scene, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"render", path(scene), "-o", path("out.exr"), "--stats", path("stats.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return read_exr(path("out.exr"));
  }
  [[nodiscard]] json cutoff() const { return json::parse(read("stats.json")).value("lightCutoff", json()); }
};

TEST_F(LightCutoff, LeavesOutWhatIsFaintAlone) {
  constexpr double kBelow = 0.05;
  for (const char* method : {"", "view-sample", "raytrace"}) {
    std::vector<std::string> with;
    if (*method != 0) with = {"--method", method};
    const ExrFile open = picture("open.json", with), all = picture("shadows.json", with);
    EXPECT_TRUE(cutoff().is_null());
    with.insert(with.end(), {"--light-cutoff", "0.05"});
    const ExrFile some = picture("shadows.json", with);
    EXPECT_EQ(some.attributes.at("penumbra.lightCutoff"), "0.05");
    std::size_t left_out = 0, kept = 0, hidden = 0;
    double largest_share = 0;
    for (std::size_t i = 0; i < std::size_t{32} * 24; ++i) {
      if (all.floats.at("A")[i] == 0) continue;
      std::array<double, 3> left{};
      const auto of = [&](const ExrFile& file, const char* lamp, const char* channel) {
        return double{file.floats.at(fmt::format("{}.{}", lamp, channel))[i]};
      };
      for (const char* lamp : kLamps) {
        double most = 0;  // largest of R, G and B, over all lamps' light
        for (const char* channel : kChannels)
          most = std::max(most, of(open, lamp, channel) / double{open.floats.at(channel)[i]});
        ASSERT_GT(std::abs(most - kBelow), 1e-6) << "decided by a rounding: choose another scene";
        if (most > kBelow) {
          for (const char* channel : {"R", "G", "B", "V"})
            ASSERT_EQ(of(some, lamp, channel), of(all, lamp, channel)) << method << lamp << channel << i;
          kept += of(some, lamp, "V") > 0 ? 1 : 0;
          continue;
        }
        for (const char* channel : {"R", "G", "B", "V"}) ASSERT_EQ(of(some, lamp, channel), 0) << method << lamp << i;
        left_out += most > 0 ? 1 : 0;
        hidden += of(all, lamp, "V") > 0 && most == 0 ? 1 : 0;
        for (std::size_t c = 0; c < 3; ++c) left.at(c) += of(open, lamp, kChannels.at(c));
      }
      for (std::size_t c = 0; c < 3; ++c) {
        const double whole = open.floats.at(kChannels.at(c))[i];
        largest_share = std::max(largest_share, left.at(c) / whole);
        const double change = double{all.floats.at(kChannels.at(c))[i]} - double{some.floats.at(kChannels.at(c))[i]};
        ASSERT_LE(change, left.at(c) + 1e-6 * whole) << "more is missing than what was left out";
        ASSERT_GE(change, -1e-6 * whole);
      }
    }
    EXPECT_GT(left_out, 100u);
    EXPECT_GT(kept, 500u);
    EXPECT_GT(hidden, 50u) << "beside the spot lamp's cone";
    EXPECT_EQ(cutoff().at("below"), kBelow);
    EXPECT_EQ(cutoff().at("pairs"), left_out) << method;
    EXPECT_NEAR(cutoff().at("largestShare").get<double>(), largest_share, 1e-6);
    EXPECT_LE(largest_share, 2 * kBelow) << "of three lamps one is at least a third";
  }
}

/// The cutoff is decided for each view sample.
TEST_F(LightCutoff, HoldsForEachViewSampleOfAPixel) {
  const std::vector<std::string> cut = {"--light-cutoff", "0.05"};
  std::vector<std::string> several = cut, large = cut;
  several.insert(several.end(), {"--pixel-samples", "4"});
  large.insert(large.end(), {"--size", "64x48"});
  const ExrFile fine = picture("shadows.json", large), interpolated = picture("shadows.json", several);
  several.insert(several.end(), {"--pixel-tolerance", "0"});
  const ExrFile whole = picture("shadows.json", several);
  EXPECT_GT(cutoff().at("pairs"), 400u);
  for (const char* channel : {"R", "V", "red.V", "spot.V", "spot.B"}) {
    for (std::size_t i = 0; i < std::size_t{32} * 24; ++i) {
      const std::size_t first = i / 32 * 128 + i % 32 * 2;
      double sum = 0;
      for (const std::size_t at : {first, first + 1, first + 64, first + 65})
        sum += double{fine.floats.at(channel)[at]} / 4;
      ASSERT_NEAR(whole.floats.at(channel)[i], sum, 1e-5 * std::max(sum, 1.0)) << channel << i;
      // Where a lamp begins to be left out its V is extrapolated; the lamp is faint there.
      if (channel[0] == 'R') {
        ASSERT_NEAR(interpolated.floats.at(channel)[i], sum, 2e-3) << channel << i;
      }
    }
  }
}

TEST_F(LightCutoff, IsOffByDefaultAndRefusesNonsense) {
  (void)picture("shadows.json");
  const std::string before = read("out.exr");
  (void)picture("shadows.json", {"--light-cutoff", "0"});
  EXPECT_EQ(read("out.exr"), before);
  const std::vector<std::string> render = {"render", path("shadows.json"), "-o", path("out.exr"), "--light-cutoff"};
  for (const char* wrong : {"-0.1", "1.5", "nan", "few"}) {
    std::vector<std::string> arguments = render;
    arguments.emplace_back(wrong);
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << wrong;
    EXPECT_THAT(outcome.err, HasSubstr("--light-cutoff"));
  }
  std::vector<std::string> bits = render;
  bits.insert(bits.end(), {"0.1", "--bits", path("bits"), "--method", "view-sample"});
  EXPECT_EQ(run(bits).code, 2);
}

}  // namespace
}  // namespace penumbra::tests
