// SPDX-License-Identifier: Apache-2.0
// Tests lamps of glTF scenes: KHR_lights_punctual.
#include "scenes/formats/gltf_reader.hpp"

#include "tests/unit/import/gltf_reader.hpp"

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <utility>

namespace penumbra::scenes {
namespace {

using nlohmann::json;
using test::Gltf;
using ::testing::Contains;
using ::testing::HasSubstr;

/// Makes node 0 a lamp of KHR_lights_punctual; node 0 is also a mesh.
Gltf with_lamp(const json& lamp) {
  Gltf gltf;
  gltf.at("/asset/generator") = "somebody else";
  gltf.at("/scenes/0/nodes") = {0, 2};
  gltf.at("/nodes/1").erase("mesh");
  gltf.document["extensions"] = {{"KHR_lights_punctual", {{"lights", {lamp}}}}};
  gltf.document["extensionsUsed"].push_back("KHR_lights_punctual");
  gltf.at("/nodes/0")["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
  gltf.at("/nodes/0")["translation"] = {1, 2, 3};
  gltf.at("/nodes/0")["scale"] = {2, 2, 2};
  gltf.at("/nodes/0")["rotation"] = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // −Z becomes −Y
  return gltf;
}

/// The extension's units: lux on a surface that faces a sun is π sin²(angle / 2) times the sun's radiance; candela are
/// π r² times a sphere's radiance.
TEST_F(GltfReader, LampsBecomeSunsAndSpheres) {
  Gltf directional =
      with_lamp({{"type", "directional"}, {"intensity", 3}, {"color", {1, 0.5, 0.25}}, {"extras", {{"angle", 60}}}});
  const Scene sunny = read(directional);
  ASSERT_EQ(sunny.lights.size(), 1u);
  EXPECT_THAT(sunny.warnings, ::testing::IsEmpty());
  EXPECT_EQ(sunny.lights[0].name, "Body");
  const auto& sun = std::get<Sun>(sunny.lights[0].shape);
  EXPECT_EQ(sun.angle, 60);
  EXPECT_LT(glm::distance(sun.direction, glm::dvec3(0, -1, 0)), 1e-15);
  EXPECT_LT(glm::distance(sunny.lights[0].radiance * M_PI / 4.0, glm::dvec3(3, 1.5, 0.75)), 1e-14);

  Gltf point = with_lamp({{"type", "point"}, {"intensity", 40}, {"extras", {{"radius", 0.5}}}});
  const Scene lit = read(point);
  const auto& sphere = std::get<Sphere>(lit.lights.at(0).shape);
  EXPECT_EQ(sphere.center, glm::dvec3(1, 2, 3));
  EXPECT_EQ(sphere.radius, 0.5) << "a node's scale must not change its lamp's radius";
  EXPECT_FALSE(sphere.cone);
  EXPECT_NEAR(lit.lights[0].radiance.x, 40 / (M_PI * 0.25), 1e-12);

  Gltf spot = with_lamp({{"type", "spot"},
                         {"intensity", 40},
                         {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}},
                         {"range", 10}});
  spot.at("/nodes/0")["extras"] = {{"radius", 0.25}};
  const Scene shown = read(spot);
  const auto& round = std::get<Sphere>(shown.lights.at(0).shape);
  EXPECT_EQ(round.radius, 0.25);
  ASSERT_TRUE(round.cone);
  EXPECT_LT(glm::distance(round.cone->direction, glm::dvec3(0, -1, 0)), 1e-15);
  EXPECT_NEAR(round.cone->inner, 0.25 * 180 / M_PI, 1e-12);
  EXPECT_NEAR(round.cone->outer, 0.5 * 180 / M_PI, 1e-12);
  EXPECT_THAT(shown.warnings, Contains(HasSubstr("range of 1 lamps is ignored")));
}

/// Blender's exporter writes 683 lumens for each watt of a lamp, but without that factor for emission; and it writes
/// angles where Blender blends the cosines of a cone.
TEST_F(GltfReader, LampsOfBlenderAreAsInBlender) {
  const auto from_blender = [](Gltf gltf) {
    gltf.at("/asset/generator") = "Khronos glTF Blender I/O v3.4.50";
    return gltf;
  };
  const json extras = {{"radius", 0.5}};
  Gltf point = from_blender(with_lamp({{"type", "point"}, {"intensity", 683 * 40}, {"extras", extras}}));
  const Scene lit = read(point);
  EXPECT_NEAR(lit.lights.at(0).radiance.x, 40 / (M_PI * 0.25), 1e-12);
  EXPECT_THAT(lit.warnings, Contains(HasSubstr("--lumens-per-watt 1")));
  const auto path = write("lamp.glb", point.glb());
  const Scene chosen = read_gltf(path, {.lumens_per_watt = 2});
  EXPECT_NEAR(chosen.lights.at(0).radiance.x, 683 * 20 / (M_PI * 0.25), 1e-9);
  EXPECT_THAT(chosen.warnings, ::testing::IsEmpty());

  const double outer = M_PI / 3;
  const auto cone = [&](double inner, const json& more = json::object()) {
    json all = extras;
    all.update(more);
    Gltf spot = with_lamp(
        {{"type", "spot"}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}, {"extras", all}});
    spot = from_blender(spot);
    return *std::get<Sphere>(read(spot).lights.at(0).shape).cone;
  };
  const Cone half = cone(outer / 2);  // a blend of 0.5: from cos 60° = 0.5 to 0.75
  EXPECT_TRUE(half.smooth);
  EXPECT_NEAR(std::cos(half.inner * M_PI / 180), 0.75, 1e-12);
  EXPECT_NEAR(half.outer, 60, 1e-12);
  EXPECT_NEAR(std::cos(cone(0).inner * M_PI / 180), 1, 1e-12);
  EXPECT_NEAR(std::cos(cone(outer * (1 - 1e-9)).inner * M_PI / 180), 0.501, 1e-12)
      << "a cone in a file of Blender never has a sharp edge";
  EXPECT_FALSE(cone(outer / 2, {{"smooth", 0}}).smooth) << "an explicit `smooth` must be used";
}

TEST_F(GltfReader, LampsWithoutASizeTakeTheUsersOrAWarning) {
  for (const auto& [type, option] : {std::pair("point", "--lamp-radius"), {"directional", "--sun-angle"}}) {
    Gltf gltf = with_lamp({{"type", type}, {"intensity", 2}});
    const Scene scene = read(gltf);
    EXPECT_THAT(scene.warnings, Contains(HasSubstr(option)));
    const auto path = write("lamp.glb", gltf.glb());
    const Scene chosen = read_gltf(path, {.lamp_radius = 1.0 / 3, .sun_angle = 0});
    EXPECT_THAT(chosen.warnings, ::testing::IsEmpty());
    if (type == std::string("point")) {
      EXPECT_EQ(std::get<Sphere>(scene.lights.at(0).shape).radius, kLampRadius);
      EXPECT_EQ(std::get<Sphere>(chosen.lights.at(0).shape).radius, 1.0 / 3) << "to the last bit";
    } else {
      EXPECT_EQ(std::get<Sun>(scene.lights.at(0).shape).angle, kSunAngle);
      EXPECT_EQ(std::get<Sun>(chosen.lights.at(0).shape).angle, 0);
      EXPECT_EQ(chosen.lights[0].radiance, glm::dvec3(2)) << "a point-like sun has its irradiance in `radiance`";
    }
  }
}

/// Blender's exporter before version 3.4.36 wrote a lamp's power in Blender's units: watts, and for a sun watts per
/// square metre.
TEST_F(GltfReader, LampsOfOlderBlendersAreInWatts) {
  const auto radiance = [&](const std::string& version, const json& lamp) {
    Gltf gltf = with_lamp(lamp);
    gltf.at("/asset/generator") = "Khronos glTF Blender I/O v" + version;
    const Scene scene = read(gltf);
    EXPECT_THAT(scene.warnings, Contains(HasSubstr(version == "3.4.36" ? "683 per watt" : "are in watts")));
    return scene.lights.at(0).radiance.x;
  };
  const json point = {{"type", "point"}, {"intensity", 100}, {"extras", {{"radius", 1}}}};
  const json sun = {{"type", "directional"}, {"intensity", 3}, {"extras", {{"angle", 0}}}};
  for (const char* version : {"1.7.33", "3.3.27", "3.4.35"}) {
    // 100 watts over the whole sphere of directions, from a disk of radius 1.
    EXPECT_NEAR(radiance(version, point), 100 / (4 * M_PI) / M_PI, 1e-12) << version;
    EXPECT_NEAR(radiance(version, sun), 3, 1e-12) << version;
  }
  EXPECT_NEAR(radiance("3.4.36", point), 100.0 / 683 / M_PI, 1e-12);
}

TEST_F(GltfReader, LampsOfRadiusZeroThrowHardShadows) {
  Gltf gltf = with_lamp({{"type", "point"}, {"intensity", 2}, {"extras", {{"radius", 0}}}});
  const Scene scene = read(gltf);
  EXPECT_EQ(std::get<Sphere>(scene.lights.at(0).shape).radius, 1e-4);
  EXPECT_NEAR(scene.lights[0].radiance.x, 2 / (M_PI * 1e-8), 1e-4);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("1 lamps of radius 0")));
}

/// Equal angles mean a hard edge; only files from Blender, where Blend is 0, get its falloff over 0.001 of the cosine.
TEST_F(GltfReader, SpotsWithAHardEdge) {
  const json lamp = {{"type", "spot"},
                     {"intensity", 2},
                     {"extras", {{"radius", 1}}},
                     {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}}};
  Gltf gltf = with_lamp(lamp);
  const Cone hard = *std::get<Sphere>(read(gltf).lights.at(0).shape).cone;
  EXPECT_EQ(hard.inner, hard.outer);
  gltf.at("/asset/generator") = "Khronos glTF Blender I/O v3.4.50";
  const Cone soft = *std::get<Sphere>(read(gltf).lights.at(0).shape).cone;
  EXPECT_NEAR(std::cos(soft.inner * M_PI / 180), std::cos(0.5) + 0.001, 1e-12);
  gltf.at("/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle") = 2;
  EXPECT_THAT(refusal(gltf), HasSubstr("/lights/0/spot: innerConeAngle 0.5 and outerConeAngle 2"));
}

TEST_F(GltfReader, ExtrasOfAnotherToolAreLeftOut) {
  Gltf gltf = with_lamp({{"type", "point"}, {"name", "Bulb"}, {"intensity", 2}, {"extras", {{"radius", "big"}}}});
  const Scene scene = read(gltf);
  EXPECT_EQ(std::get<Sphere>(scene.lights.at(0).shape).radius, kLampRadius);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("'Bulb' has extras \"radius\" of another tool")));
}

TEST_F(GltfReader, LampsThatAreNoneAreRefused) {
  const auto expect = [&](const json& lamp, const std::string& what) {
    Gltf gltf = with_lamp(lamp);
    EXPECT_THAT(refusal(gltf), HasSubstr(what));
  };
  expect({{"type", "area"}}, "'Body' (a lamp of a type that KHR_lights_punctual");
  expect({{"type", "point"}, {"intensity", -1}}, "/lights/0/intensity");
  expect({{"type", "point"}, {"color", {1, -1, 0}}}, "/lights/0/color");
  expect({{"type", "point"}, {"extras", {{"radius", -1}}}}, "/nodes/0: the lamp's radius is -1");
  expect({{"type", "directional"}, {"extras", {{"angle", 180}}}}, "/nodes/0: the sun's angle is 180");
  expect({{"type", "spot"}, {"spot", {{"innerConeAngle", -0.5}, {"outerConeAngle", 0.5}}}}, "/lights/0/spot");
  expect({{"type", "spot"}, {"spot", {{"outerConeAngle", 2}}}}, "/lights/0/spot");
  Gltf gltf = with_lamp({{"type", "point"}});
  gltf.at("/nodes/0/extensions/KHR_lights_punctual/light") = 7;
  EXPECT_THAT(refusal(gltf), HasSubstr("/nodes/0/extensions/KHR_lights_punctual/light"));
}

/// Makes node 0 an area lamp in extras, half as high as wide, turned to shine down.
Gltf with_area_lamp(const json& lamp) {
  Gltf gltf = with_lamp({{"type", "point"}, {"intensity", 0}, {"extras", {{"radius", 1}}}});
  gltf.at("/nodes/0")["scale"] = {2, 3, 5};
  gltf.at("/nodes/0")["extras"] = {{"areaLamp", lamp}};
  return gltf;
}

/// Extras hold lamps that KHR_lights_punctual cannot express.
TEST_F(GltfReader, AreaLampsOfExtras) {
  Gltf gltf = with_area_lamp({{"shape", "rectangle"}, {"size", {1, 0.5}}, {"radiance", {4, 2, 1}}});
  const Scene scene = read(gltf);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].name, "Body");
  EXPECT_EQ(scene.lights[0].radiance, glm::dvec3(4, 2, 1));
  EXPECT_FALSE(scene.lights[0].two_sided);
  EXPECT_TRUE(scene.lights[0].unshaded_by.empty());
  const auto& panel = std::get<Rectangle>(scene.lights[0].shape);
  EXPECT_LT(glm::distance(panel.center, glm::dvec3(1, 2, 3)), 1e-15);
  EXPECT_LT(glm::distance(panel.half_u, glm::dvec3(1, 0, 0)), 1e-15);
  EXPECT_LT(glm::distance(glm::cross(panel.half_u, panel.half_v), glm::dvec3(0, -0.75, 0)), 1e-15) << "it shines down";
  for (const auto& object : scene.objects) EXPECT_FALSE(object.emits) << "it has no body";

  gltf.at("/nodes/0/extras/areaLamp/shape") = "ellipse";
  EXPECT_NEAR(glm::length(std::get<Ellipse>(read(gltf).lights.at(0).shape).half_v), 0.75, 1e-15);
  gltf.at("/nodes/0/extras/areaLamp/size") = {1.5, 1};
  const Scene round = read(gltf);
  EXPECT_NEAR(std::get<Disk>(round.lights.at(0).shape).radius, 1.5, 1e-15);
  EXPECT_LT(glm::distance(std::get<Disk>(round.lights[0].shape).normal, glm::dvec3(0, -1, 0)), 1e-15);

  gltf.at("/nodes/0/scale") = {-2, 3, 5};  // a mirroring scale does not change where it shines
  EXPECT_LT(glm::distance(std::get<Disk>(read(gltf).lights.at(0).shape).normal, glm::dvec3(0, -1, 0)), 1e-15);
}

TEST_F(GltfReader, LampsMayCastNoShadows) {
  Gltf gltf = with_area_lamp({{"shape", "rectangle"}, {"size", {1, 1}}, {"radiance", {1, 1, 1}}});
  gltf.at("/nodes/0/extras")["castsShadow"] = false;
  const Scene scene = read(gltf);
  ASSERT_EQ(scene.lights.at(0).unshaded_by.size(), scene.objects.size());
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) EXPECT_EQ(scene.lights[0].unshaded_by[i], i);
  EXPECT_TRUE(scene.objects.at(0).casts_shadow == false) << "properties of the node's mesh count, too";
}

TEST_F(GltfReader, AreaLampsThatAreNoneAreRefused) {
  const json good = {{"shape", "rectangle"}, {"size", {1, 1}}, {"radiance", {1, 1, 1}}};
  const auto expect = [&](const char* key, const json& value, const std::string& what) {
    json lamp = good;
    lamp[key] = value;
    Gltf gltf = with_area_lamp(lamp);
    EXPECT_THAT(refusal(gltf), HasSubstr("/nodes/0/extras/areaLamp" + what));
  };
  expect("shape", "star", "/shape: expected \"rectangle\" or \"ellipse\"");
  expect("size", {1}, "/size: expected 2 numbers from 0 up");
  expect("size", {1, -1}, "/size");
  expect("size", {1, "x"}, "/size");
  expect("size", {1, 0}, ": it has no area");
  expect("radiance", {1, 1, -1}, "/radiance");
  Gltf gltf = with_area_lamp("big");
  EXPECT_TRUE(read(gltf).lights.empty()) << "a property of another tool is no lamp";
}

TEST_F(GltfReader, ALampThatIsOffIsNoLight) {
  Gltf gltf = with_lamp({{"type", "point"}, {"intensity", 0}, {"extras", {{"radius", 1}}}});
  EXPECT_TRUE(read(gltf).lights.empty());
}

}  // namespace
}  // namespace penumbra::scenes
