// SPDX-License-Identifier: Apache-2.0
// Tests the tables of light kinds: how scene files represent each kind, and that no row is missing.
#include "scenes/formats/writer.hpp"
#include "scenes/light_kind.hpp"
#include "tests/unit/scenes/support.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <fstream>
#include <set>
#include <string>

namespace penumbra::test {
namespace {

using scenes::LightKind;
using scenes::LightKinds;

/// The value of each kind's key, in the order of the table. None of them equals a default-constructed shape.
constexpr std::array kValues{
    R"({"center": [0, 5, 0], "halfU": [0.1, 0, 0], "halfV": [0, 0, 0.3]})",
    R"({"center": [2, 5, 0], "normal": [0.6, -0.8, 0], "radius": 0.4})",
    R"({"center": [0, 5, 0.1], "halfU": [0.6, 0, 0], "halfV": [0, 0.1, 0.3]})",
    R"([[0, 5, 0], [1, 5, 0], [1.25, 5, 1], [0, 5, 1]])",
    R"({"center": [0, 4, -2], "radius": 0.1, "cone": {"direction": [0, -1, 0], "inner": 10, "outer": 25}})",
    R"({"direction": [0, -0.6, -0.8], "angle": 0.53})",
    R"({"rotate": 30, "up": [0.6, 0.8, 0], "half": true, "sampled": true})",
};
static_assert(kValues.size() == scenes::kLightTraits.size(), "a value for each kind");

std::string light_text(std::size_t kind) {
  return fmt::format(R"({{"name": "one", "{}": {}}})", scenes::kLightTraits[kind].name, kValues[kind]);
}

TEST(LightKinds, RowsStandInTheOrderOfKinds) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < scenes::kLightTraits.size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(scenes::kLightTraits[i].kind), i);
    names.insert(scenes::kLightTraits[i].name);
  }
  EXPECT_EQ(names.size(), scenes::kLightTraits.size());
}

TEST(LightKinds, SchemaKnowsEachNameAndNoOther) {
  std::ifstream file(std::filesystem::path(PENUMBRA_SCENES) / "penumbra-scene.schema.json");
  const auto schema = nlohmann::json::parse(file);
  std::set<std::string> keys, expected{"pieces"};
  for (const auto& choice : schema.at("definitions").at("light").at("oneOf")) keys.insert(choice.at("required").at(0));
  for (const scenes::LightTraits& row : scenes::kLightTraits) expected.insert(row.name);
  EXPECT_EQ(keys, expected);
}

/// Reading and writing a light twice keeps its kind and its text.
TEST(LightKinds, GoThroughJsonUnchanged) {
  for (std::size_t i = 0; i < kValues.size(); ++i) {
    const scenes::Scene scene = read_text(scene_text(kMesh, light_text(i)));
    EXPECT_EQ(scenes::kind_of(scene.lights.at(0).shape), scenes::kLightTraits[i].kind);
    const TemporaryFolder folder;
    scenes::write_scene(scene, folder / "first.json");
    const std::string first = read_file(folder / "first.json");
    const auto written = nlohmann::json::parse(first).at("lights").at(0).at(scenes::kLightTraits[i].name);
    const auto given = nlohmann::json::parse(kValues[i]);
    EXPECT_EQ(written, given) << scenes::kLightTraits[i].name;
    scenes::write_scene(scenes::read_scene(folder / "first.json"), folder / "second.json");
    EXPECT_EQ(read_file(folder / "second.json"), first);
  }
}

TEST(LightKinds, GoIntoGltfAsLampsOrMeshes) {
  for (std::size_t i = 0; i < kValues.size(); ++i) {
    const scenes::Scene scene = read_text(scene_text(kMesh, light_text(i)));
    const TemporaryFolder folder;
    if (scenes::is_dome(scenes::kLightTraits[i].kind)) {  // core glTF has no kind of light for a sky
      EXPECT_THROW(scenes::write_scene(scene, folder / "scene.glb"), InputError);
      continue;
    }
    scenes::write_scene(scene, folder / "scene.glb");
    const bool is_lamp = read_file(folder / "scene.glb").find("KHR_lights_punctual") != std::string::npos;
    EXPECT_EQ(is_lamp, !scenes::is_planar(scenes::kLightTraits[i].kind)) << scenes::kLightTraits[i].name;
  }
}

TEST(LightKinds, APropertyIsTrueOfTheseKinds) {
  using enum LightKind;
  EXPECT_EQ(scenes::kEveryLight, (LightKinds{rectangle, disk, ellipse, polygon, sphere, sun, dome}));
  EXPECT_EQ(scenes::kPlanarLights, (LightKinds{rectangle, disk, ellipse, polygon}));
  EXPECT_EQ(scenes::kDomes, LightKinds{dome});
  EXPECT_EQ(scenes::kBodies, LightKinds{sphere});
  EXPECT_EQ(scenes::kParallelograms, LightKinds{rectangle});
  EXPECT_EQ(scenes::kPolygons, LightKinds{polygon});
  EXPECT_EQ(scenes::kRoundLights, (LightKinds{disk, ellipse, sphere, sun}));
  EXPECT_EQ(scenes::kCircles, (LightKinds{disk, sphere, sun}));
}

TEST(LightKinds, SetsAreListedInTheOrderOfTheTable) {
  using enum LightKind;
  const LightKinds some{sun, disk};
  EXPECT_EQ(some.list(), (std::vector{disk, sun}));
  EXPECT_EQ((some | LightKinds{polygon}).words(), "disk, polygon, sun");
  EXPECT_EQ((scenes::kEveryLight - some).words(" or "), "rectangle, ellipse, polygon, sphere or dome");
  EXPECT_EQ((some & scenes::kPlanarLights).words(" or "), "disk");
  EXPECT_EQ(LightKinds().words(), "");
}

TEST(LightKinds, PiecesAreOfTheKindsOfAll) {
  scenes::Pieces pieces;
  pieces.pieces = {scenes::Sphere{{0, 1, 0}, 1}, scenes::Rectangle{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}};
  EXPECT_EQ(scenes::kind_of(pieces), std::nullopt);
  EXPECT_EQ(scenes::kinds_of(pieces).words(), "rectangle, sphere");
}

}  // namespace
}  // namespace penumbra::test
