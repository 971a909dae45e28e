// SPDX-License-Identifier: Apache-2.0
#include "visibility/method.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

namespace penumbra::visibility {
namespace {

enum class Engine { automatic, native };

constexpr IntegerOption kResolution{"resolution", 64, 16384, 2048, "texels a side"};
constexpr RealOption kBias{"bias", 0, 8.5, 0.5, "in texels"};
constexpr ChoiceOption kEngine{
    "engine", {{"auto", Engine::automatic}, {"native", Engine::native}}, Engine::automatic, "where"};
constexpr auto kCrop = flag_option("crop", true, "less to do");

MethodDescription description() {
  MethodDescription result;
  result.name = "pcss";
  result.lights = {LightKind::rectangle, LightKind::disk};
  result.options = {kResolution.description(), kBias.description(), kEngine.description(), kCrop.description()};
  return result;
}

std::string refusal(const MethodOptions& options) {
  try {
    parse_options(description(), options);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "none";
}

TEST(Method, RefusesLightsItCannotDoAndSaysWhichItCan) {
  Light light;
  light.name = "bulb";
  light.kind = LightKind::disk;
  EXPECT_NO_THROW(check_light(description(), light));
  light.kind = LightKind::sphere;
  try {
    check_light(description(), light);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("light \"bulb\" is a sphere; method pcss, with these options, supports: rectangle, disk"),
              std::string::npos);
  }
}

TEST(Method, OptionsHaveTheDeclaredDefaults) {
  const ParsedOptions options = parse_options(description(), {});
  EXPECT_EQ(options[kResolution], 2048U);
  EXPECT_EQ(options[kBias], 0.5);
  EXPECT_EQ(options[kEngine], Engine::automatic);
  EXPECT_TRUE(options[kCrop]);
  EXPECT_FALSE(options.given(kCrop));
}

TEST(Method, ReadsOptionsAsTheirTypes) {
  const ParsedOptions options =
      parse_options(description(), {{"resolution", "64"}, {"bias", "1e-3"}, {"engine", "native"}, {"crop", "off"}});
  EXPECT_EQ(options[kResolution], 64U);
  EXPECT_EQ(options[kBias], 1e-3);
  EXPECT_EQ(options[kEngine], Engine::native);
  EXPECT_FALSE(options[kCrop]);
  EXPECT_TRUE(options.given(kCrop));
}

TEST(Method, DescribesOptionsAsDeclared) {
  std::vector<std::string> texts;
  for (const OptionDescription& option : description().options) {
    texts.push_back(option.name + "=" + option.values() + " " + option.default_value);
  }
  EXPECT_EQ(texts, (std::vector<std::string>{"resolution=64 … 16384 2048", "bias=0.0 … 8.5 0.5",
                                             "engine=auto|native auto", "crop=on|off on"}));
}

TEST(Method, RefusesOptionsItDoesNotHave) {
  const std::string it_has = "; it has resolution (64 … 16384), bias (0.0 … 8.5), engine (auto|native), crop (on|off)";
  EXPECT_EQ(refusal({{"resolutoin", "512"}}),
            "method pcss has no option \"resolutoin\"" + it_has + "; did you mean resolution?");
  EXPECT_EQ(refusal({{"size", "512"}}), "method pcss has no option \"size\"" + it_has);
}

TEST(Method, RefusesValuesThatAnOptionCannotHave) {
  for (const MethodOptions& right : {MethodOptions{{"resolution", "64"}, {"bias", "8.5"}},
                                     {{"resolution", "16384"}},
                                     {{"bias", "0"}},
                                     {{"bias", "1e-3"}},
                                     {{"engine", "native"}}}) {
    EXPECT_EQ(refusal(right), "none");
  }
  for (const MethodOptions& wrong : {MethodOptions{{"resolution", "63"}},
                                     {{"resolution", "16385"}},
                                     {{"resolution", "100.5"}},
                                     {{"resolution", ""}},
                                     {{"resolution", "1e3"}},
                                     {{"bias", "-0.1"}},
                                     {{"bias", "9"}},
                                     {{"bias", "nan"}},
                                     {{"bias", "1x"}},
                                     {{"engine", "nativ"}},
                                     {{"engine", "auto|native"}},
                                     {{"engine", ""}},
                                     {{"crop", "true"}}}) {
    EXPECT_THROW(parse_options(description(), wrong), UsageError)
        << wrong.begin()->first << "=" << wrong.begin()->second;
  }
  EXPECT_EQ(refusal({{"engine", "nativ"}}),
            "method pcss: option engine is \"nativ\"; it must be auto|native; did you mean native?");
  EXPECT_EQ(refusal({{"resolution", "63"}}), "method pcss: option resolution is \"63\"; it must be 64 … 16384");
}

TEST(Method, EveryNameIsSaid) {
  EXPECT_STREQ(name_of(Family::geometry), "geometry");
  EXPECT_STREQ(name_of(Output::mask), "mask");
  EXPECT_STREQ(name_of(LightKind::polygon), "polygon");
  EXPECT_STREQ(name_of(SamplePattern::jittered), "jittered");
  EXPECT_STREQ(name_of(SamplePattern::rgss), "rgss");
}

}  // namespace
}  // namespace penumbra::visibility
