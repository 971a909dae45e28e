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

TEST(Method, EveryNameIsSaid) {
  EXPECT_STREQ(name_of(Family::geometry), "geometry");
  EXPECT_STREQ(name_of(Output::mask), "mask");
  EXPECT_STREQ(name_of(LightKind::polygon), "polygon");
  EXPECT_STREQ(name_of(SamplePattern::jittered), "jittered");
}

}  // namespace
}  // namespace penumbra::visibility
