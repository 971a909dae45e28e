// SPDX-License-Identifier: Apache-2.0
#include "visibility/scene_floats.hpp"

#include "base/error.hpp"
#include "tests/unit/visibility/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace penumbra::visibility {
namespace {

TEST(SceneFloats, OriginIsTheCentreOfTheBoundsAndPositionsAreRoundedOnce) {
  scenes::Scene scene;
  tests::add_object(scene, "a", {{glm::dvec3(1000.1, 0, 0), glm::dvec3(1001.3, 2, 0), glm::dvec3(1000.1, 0, 5)}});
  const SceneFloats floats = make_scene_floats(scene);
  EXPECT_EQ(floats.origin, 0.5 * glm::dvec3(1000.1, 0, 0) + 0.5 * glm::dvec3(1001.3, 2, 5));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(floats.positions[i], glm::vec3(scene.soup.positions[i] - floats.origin));
  }
  EXPECT_EQ(floats.lower, glm::vec3(floats.positions[0].x, -1, -2.5f));
  EXPECT_EQ(floats.upper, glm::vec3(floats.positions[1].x, 1, 2.5f));
}

TEST(SceneFloats, VerticesAreSortedAndMinusZeroIsZero) {
  scenes::Scene scene;
  tests::add_object(scene, "a",
                    {{glm::dvec3(1, 1, 1), glm::dvec3(-1, -1, -1), glm::dvec3(-0.0, 0.0, -0.0)},
                     {glm::dvec3(0.0, 0.0, 0.0), glm::dvec3(1, 1, 1), glm::dvec3(0, -1, 1)}});
  const SceneFloats floats = make_scene_floats(scene);
  EXPECT_FALSE(std::signbit(floats.positions[2].x));
  const auto first = floats.corners(0), second = floats.corners(1);
  EXPECT_EQ(first[0], glm::vec3(-1));
  EXPECT_EQ(first[1], glm::vec3(0));
  EXPECT_EQ(first[2], glm::vec3(1));
  EXPECT_EQ(second[0], glm::vec3(0, -1, 1));
  EXPECT_EQ(second[1], glm::vec3(0));
}

TEST(SceneFloats, RanksFollowTheSortedVerticesAndTwinsShareOne) {
  const glm::dvec3 a(-1, 0, 0), b(0, 1, 0), c(1, 0, 0), d(0, -1, 2);
  scenes::Scene scene;
  tests::add_object(scene, "a", {{b, c, d}, {c, a, b}, {a, b, c}, {d, a, b}});
  const SceneFloats floats = make_scene_floats(scene);
  // Sorted: (a, b, c) twice, (a, d, b), (d, b, c): d = (0, −1, 2) comes before b = (0, 1, 0).
  EXPECT_EQ(ranks(floats), (std::vector<std::uint32_t>{2, 1, 1, 0}));
}

TEST(SceneFloats, FlagsComeFromObjectsAndZeroAreaCastsNothing) {
  scenes::Scene scene;
  const tests::Corners triangle = {glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)};
  const tests::Corners flat = {glm::dvec3(0, 0, 0), glm::dvec3(1, 1, 1), glm::dvec3(3, 3, 3)};
  tests::add_object(scene, "plain", {triangle, flat});
  tests::add_object(scene, "ghost", {triangle}).casts_shadow = false;
  tests::add_object(scene, "sky", {triangle}).receives_shadow = false;
  tests::add_object(scene, "lamp", {triangle}).emits = 2;
  const SceneFloats floats = make_scene_floats(scene);
  EXPECT_EQ(floats.casts_shadow, (std::vector<std::uint8_t>{1, 0, 0, 1, 1}));
  EXPECT_EQ(floats.receives_shadow, (std::vector<std::uint8_t>{1, 1, 1, 0, 1}));
  EXPECT_EQ(floats.emits, (std::vector<std::int32_t>{-1, -1, -1, -1, 2}));
  EXPECT_EQ(floats.plane[1], SceneFloats::kNoPlane);
  EXPECT_EQ(floats.plane[0], floats.plane[2]);
}

TEST(SceneFloats, RefusesScenesSoSmallThatFloatsLoseDigits) {
  for (const int exponent : {-100, -119, -125, -140}) {
    const double size = std::ldexp(1.0, exponent);
    scenes::Scene scene;
    tests::add_object(scene, "a", {{glm::dvec3(size, 0, 0), glm::dvec3(-size, 0, 0), glm::dvec3(0, size, size)}});
    if (exponent >= -120) {
      EXPECT_NO_THROW(make_scene_floats(scene)) << exponent;
    } else {
      EXPECT_THROW(make_scene_floats(scene), InputError) << exponent;
    }
  }
}

TEST(SceneFloats, RefusesPositionsThatFloatsCannotHold) {
  for (const double bad : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN(), 1e300}) {
    scenes::Scene scene;
    tests::add_object(scene, "fine", {{glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}});
    tests::add_object(scene, "broken", {{glm::dvec3(0, bad, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}});
    try {
      make_scene_floats(scene);
      FAIL() << bad;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("is not finite in float32"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace penumbra::visibility
