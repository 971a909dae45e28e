// SPDX-License-Identifier: Apache-2.0
#include "session/options.hpp"

#include "base/error.hpp"
#include "session/pictures/frames.hpp"
#include "session/sample_pixels.hpp"
#include "session/session.hpp"

#include <gmock/gmock.h>

namespace penumbra::session {
namespace {

using testing::ElementsAre;

TEST(Options, LightSamples) {
  RunOptions options;
  options.light_samples = "100";
  options.sample_pattern = "sobol";
  options.sample_seed = 7;
  EXPECT_EQ(parse_light_samples(options).count, 100u);
  EXPECT_EQ(parse_light_samples(options).seed, 7u);
  EXPECT_EQ(parse_light_samples(options).pattern, visibility::SamplePattern::sobol);
  options.light_samples = "3x5";
  EXPECT_EQ(parse_light_samples(options).rows, 3u);
  EXPECT_EQ(parse_light_samples(options).columns, 5u);
  EXPECT_EQ(parse_light_samples(options).count, 15u);
  options.light_samples = "";  // not asked for
  EXPECT_EQ(parse_light_samples(options).count, 256u);
  for (const char* wrong : {"0", "-1", "4097", "x", "3x", "x3", "0x3", "3x5x7", " 3", "3 ", "1e3", "4294967297"}) {
    options.light_samples = wrong;
    EXPECT_THROW(parse_light_samples(options), UsageError) << wrong;
  }
}

TEST(Options, FramePaths) {
  EXPECT_EQ(frame_path("a/out.exr", 7), "a/out.0007.exr");
  EXPECT_EQ(frame_path("out.exr", 12345), "out.12345.exr");
  EXPECT_EQ(frame_path("out.%04d.exr", 7), "out.0007.exr");
  EXPECT_EQ(frame_path("f%dx.exr", 7), "f7x.exr");
  EXPECT_EQ(frame_path("100%.exr", 7), "100%.0007.exr");
  EXPECT_EQ(frame_path("d/g.####.exr", 7), "d/g.0007.exr");
  EXPECT_EQ(frame_path("g##.png", 123), "g123.png");
  EXPECT_EQ(frame_path("take#1.%03d.exr", 7), "take#1.007.exr");
  EXPECT_EQ(frame_path("g.####.exr", -7), "g.-007.exr");
  EXPECT_TRUE(has_frame_number("g.####.exr") && has_frame_number("%d.exr") && !has_frame_number("100%.exr"));
  EXPECT_EQ(camera_path("a/out.exr", "Shot_1"), "a/out.Shot_1.exr");
  EXPECT_EQ(frame_path(camera_path("out.####.exr", "B"), 3), "out.B.0003.exr");
}

TEST(Options, CamerasHaveEachAnotherWord) {
  std::string umlauts;
  for (int i = 0; i < 60; ++i) umlauts += "\u00c4";
  const std::vector<std::string> names = {"Shot 1", "Shot/1", "Ä", "Ö", "..", "*", "?", umlauts, umlauts + "!"};
  const auto words = camera_words(names);
  EXPECT_EQ(words.at("Shot 1"), "Shot_1");
  EXPECT_EQ(words.at("Shot/1"), "Shot_1_2");
  EXPECT_EQ(words.at("Ä"), "Ä");
  EXPECT_EQ(words.at("Ö"), "Ö");
  EXPECT_EQ(words.at("*"), "_");
  EXPECT_EQ(words.at("?"), "__2");
  EXPECT_EQ(words.at(umlauts), umlauts.substr(0, 100));
  EXPECT_EQ(words.at(umlauts + "!"), umlauts.substr(0, 100) + "_2");
}

TEST(Options, Frames) {
  EXPECT_EQ(parse_frames("3-9").first, 3);
  EXPECT_EQ(parse_frames("3-9").last, 9);
  EXPECT_EQ(parse_frames("-2-1").first, -2);
  EXPECT_THAT(numbers_of(parse_frames("1-10x4")), ElementsAre(1, 5, 9));
  EXPECT_THAT(numbers_of(parse_frames("-1-1")), ElementsAre(-1, 0, 1));
  for (const char* wrong : {"", "3", "-", "-3", "3-", "9-3", "a-b", "0-1000000000", "1-3x0", "1-3x", "1-3x-1", "1x2"})
    EXPECT_THROW(parse_frames(wrong), UsageError) << wrong;
}

TEST(Options, MethodEntriesAreNamedApart) {
  const auto entries = parse_methods("raytrace,raytrace");
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].label, "raytrace");
  EXPECT_EQ(entries[1].label, "raytrace-2");
  EXPECT_THROW(parse_methods(""), UsageError);
  EXPECT_THROW(parse_methods("raytrace,"), UsageError);
  EXPECT_THROW(parse_methods("raytrace:speed=high"), UsageError);
  EXPECT_THROW(parse_method_options({"a=1", "a=2"}), UsageError);
}

TEST(Options, SamplePixels) {
  const std::vector<std::uint32_t> pixels = {1, 2, 5, 8, 13, 21};
  EXPECT_EQ(sample_pixels(pixels, "all", 8, 4), pixels);
  EXPECT_EQ(sample_pixels(pixels, "100", 8, 4), pixels);
  EXPECT_THAT(sample_pixels(pixels, "3", 8, 4), ElementsAre(1, 5, 13));
  EXPECT_THAT(sample_pixels(pixels, "5,2;5,0;0,0;5,2", 8, 4), ElementsAre(5, 21));
  for (const char* wrong : {"", "0", "-1", "1,2,3", "8,0", "0,4", "1,2;", "some"}) {
    EXPECT_THROW(sample_pixels(pixels, wrong, 8, 4), UsageError) << wrong;
  }
}

TEST(Median, IsTheMiddle) {
  EXPECT_EQ(median({3}), 3);
  EXPECT_EQ(median({5, 1, 3}), 3);
  EXPECT_EQ(median({4, 1, 2, 10}), 3);
}

}  // namespace
}  // namespace penumbra::session
