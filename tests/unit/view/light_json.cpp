// SPDX-License-Identifier: Apache-2.0
// Tests lights and cameras in the page's form: converting there and back changes nothing, and values that a scene file
// could not have are refused.
#include "app/view/light_json.hpp"

#include "base/error.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <numbers>

namespace penumbra::app {
namespace {

using nlohmann::json;

scenes::AreaLight light_of(scenes::LightShape shape) {
  scenes::AreaLight light;
  light.name = "key";
  light.shape = std::move(shape);
  light.radiance = {3, 2, 1};
  return light;
}

TEST(LightJson, EveryShapeComesBack) {
  const std::vector<scenes::LightShape> shapes = {
      scenes::Rectangle{{0, 4, 0}, {0.5, 0, 0}, {0, 0, 0.5}}, scenes::Disk{{1, 2, 3}, {0, -1, 0}, 0.4},
      scenes::Polygon{{{0, 5, 0}, {1, 5, 0}, {0, 5, 1}}},     scenes::Sphere{{0, 4, 2}, 0.2},
      scenes::Ellipse{{0, 5, 0}, {0.6, 0, 0}, {0, 0, 0.3}},   scenes::Sun{{0, -1, 0}, 10}};
  for (const scenes::LightShape& shape : shapes) {
    const scenes::AreaLight light = light_of(shape);
    const json written = light_json(light);
    const scenes::AreaLight read = changed_light(light, written);
    EXPECT_EQ(read.shape.index(), shape.index());
    EXPECT_NEAR(read.radiance.x, 3, 1e-12) << written;
    json again = light_json(read);
    for (const char* bright :
         {"radiance", "irradiance"}) {  // a sun's radiance is an irradiance divided by a number and multiplied again
      if (!again.contains(bright)) continue;
      EXPECT_NEAR(again[bright][0].get<double>(), written[bright][0].get<double>(), 1e-12);
      again[bright] = written[bright];
    }
    EXPECT_EQ(again, written);
  }
}

TEST(LightJson, ASunsIrradianceStaysWhenItsAngleChanges) {
  scenes::AreaLight sun = light_of(scenes::Sun{{0, -1, 0}, 10});
  json written = light_json(sun);
  const double sine = std::sin(5 * std::numbers::pi / 180);
  EXPECT_NEAR(written["irradiance"][0].get<double>(), 3 * std::numbers::pi * sine * sine, 1e-12);
  const double before = written["irradiance"][1].get<double>();
  written["sun"]["angle"] = 0;
  EXPECT_NEAR(changed_light(sun, written).radiance.y, before,
              1e-12);  // the irradiance of a point-like sun is stored itself
}

TEST(LightJson, WhatThePageDoesNotKnowStays) {
  scenes::AreaLight spot = light_of(scenes::Sphere{{0, 4, 0}, 0.1, scenes::Cone{{0, -1, 0}, 10, 20}});
  spot.unshaded_by = {3};
  json written = light_json(spot);
  written["sphere"]["radius"] = 0.2;
  const scenes::AreaLight read = changed_light(spot, written);
  ASSERT_TRUE(std::get<scenes::Sphere>(read.shape).cone);
  EXPECT_EQ(std::get<scenes::Sphere>(read.shape).radius, 0.2);
  EXPECT_EQ(read.unshaded_by, spot.unshaded_by);
}

TEST(LightJson, LightsWithoutAShapeOfTheirOwnChangeTheirBrightness) {
  const scenes::Dome sky{{0, 0, 1}, 30, true, false, "evening.hdr"};
  const scenes::Pieces mesh{{scenes::Rectangle{{0, 4, 0}, {0.5, 0, 0}, {0, 0, 0.5}}}};
  for (const scenes::LightShape& shape : {scenes::LightShape(sky), scenes::LightShape(mesh)}) {
    const scenes::AreaLight light = light_of(shape);
    json written = light_json(light);
    written["radiance"] = {6, 4, 2};
    const scenes::AreaLight read = changed_light(light, written);
    EXPECT_EQ(read.radiance, glm::dvec3(6, 4, 2));
    EXPECT_EQ(json(light_json(read)), written);
    EXPECT_EQ(read.shape.index(), shape.index());
    written["sphere"] = {{"center", {0, 0, 0}}, {"radius", 1}};
    EXPECT_THROW(changed_light(light, written), InputError);
  }
  const scenes::AreaLight light = changed_light(light_of(sky), {{"radiance", {1, 1, 1}}});
  EXPECT_EQ(std::get<scenes::Dome>(light.shape).image, "evening.hdr");
}

TEST(LightJson, RefusesWhatAFileCouldNotSay) {
  const scenes::AreaLight light = light_of(scenes::Rectangle{{0, 4, 0}, {0.5, 0, 0}, {0, 0, 0.5}});
  const json good = light_json(light);
  const auto with = [&](const char* key, const json& value) {
    json changed = good;
    changed[key] = value;
    return changed;
  };
  for (const json& wrong :
       {with("texture", "/etc/passwd"), with("casters", json::object()), with("radiance", {-1, 0, 0}),
        with("rectangle", {{"center", {0, 4, 0}}, {"halfU", {0, 0, 0}}, {"halfV", {0, 0, 1}}}),
        with("rectangle", "large"), json("light"), json::array(), json(nullptr)})
    EXPECT_THROW(changed_light(light, wrong), InputError) << wrong;
  json other = good;
  other.erase("rectangle");
  other["sphere"] = {{"center", {0, 0, 0}}, {"radius", 1}};
  EXPECT_THROW(changed_light(light, other), InputError);
}

TEST(LightJson, Cameras) {
  scenes::Camera camera;
  camera.name = "shot";
  camera.eye = {3, 2, 1};
  camera.aspect = 2;
  camera.shift = {0.1, 0};
  const json written = camera_json(camera);
  json moved = written;
  moved["eye"] = {3, 3, 3};
  const scenes::Camera read = changed_camera(camera, moved);
  EXPECT_EQ(read.eye, glm::dvec3(3, 3, 3));
  EXPECT_EQ(read.name, "shot");
  EXPECT_EQ(read.aspect, 2);
  EXPECT_EQ(read.shift, camera.shift);
  moved["target"] = moved["eye"];
  EXPECT_THROW(changed_camera(camera, moved), InputError);
  moved["target"] = {3, 9, 3};  // parallel to `up`
  EXPECT_THROW(changed_camera(camera, moved), InputError);
}

}  // namespace
}  // namespace penumbra::app
