#include "visibility/method.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

namespace penumbra::visibility {
namespace {

MethodDescription description() {
  MethodDescription result;
  result.name = "pcss";
  result.lights = {LightKind::rectangle, LightKind::disk};
  result.options = {{"resolution", "64 … 16384", "2048", "texels a side"}};
  return result;
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
    EXPECT_NE(std::string(error.what()).find("light \"bulb\" is a sphere; method pcss can do: rectangle, disk"),
              std::string::npos);
  }
}

TEST(Method, RefusesOptionsItDoesNotHave) {
  EXPECT_NO_THROW(check_options(description(), {{"resolution", "512"}}));
  try {
    check_options(description(), {{"resolutoin", "512"}});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "method pcss has no option \"resolutoin\"; it has resolution (64 … 16384)");
  }
}

TEST(Method, RefusesValuesThatAnOptionCannotHave) {
  MethodDescription method = description();
  method.options.push_back({"bias", "0.0 … 8.5", "0.5", "in texels"});
  method.options.push_back({"engine", "auto|native", "auto", "where"});
  for (const MethodOptions& right : {MethodOptions{{"resolution", "64"}, {"bias", "8.5"}},
                                     {{"resolution", "16384"}},
                                     {{"bias", "0"}},
                                     {{"bias", "1e-3"}},
                                     {{"engine", "native"}}}) {
    EXPECT_NO_THROW(check_options(method, right));
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
                                     {{"engine", ""}}}) {
    EXPECT_THROW(check_options(method, wrong), UsageError) << wrong.begin()->first << "=" << wrong.begin()->second;
  }
}

TEST(Method, EveryNameIsSaid) {
  EXPECT_STREQ(name_of(Family::geometry), "geometry");
  EXPECT_STREQ(name_of(Output::mask), "mask");
  EXPECT_STREQ(name_of(LightKind::polygon), "polygon");
  EXPECT_STREQ(name_of(SamplePattern::jittered), "jittered");
}

}  // namespace
}  // namespace penumbra::visibility
