// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual (Khronos, ratified extension of glTF 2.0).

#include "import/gltf/punctual_lights.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "import/gltf/blender_exporter.hpp"
#include "import/gltf/gltf_extras.hpp"

#include <tiny_gltf.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace penumbra::import {
namespace {

constexpr const char* kExtension = "KHR_lights_punctual";
constexpr double kBlendersLumensPerWatt = 683;  // factor of Blender's "Standard" lighting mode
/// Replaces a radius of 0: gives hard shadows in any picture of a scene that is a few units large, as Blender's lamps
/// of radius 0 do. Blender's add-on for this program uses the same value.
constexpr double kHardRadius = 1e-4;

double checked(double value, double least, const std::string& place) {
  if (!std::isfinite(value) || value < least)
    throw InputError("{}: {}; expected a number from {} up", place, value, least);
  return value;
}

/// `smooth`: whether the file says that the cone falls off as Blender's cones do.
scenes::Cone cone_of(const tinygltf::Light& lamp, const glm::dvec3& direction, bool from_blender,
                     std::optional<bool> smooth, const std::string& place) {
  const double outer = lamp.spot.outerConeAngle;
  // Equal angles are a hard edge. A slightly larger inner angle is a result of an exporter's rounding, and viewers
  // treat it as equal.
  const double given = lamp.spot.innerConeAngle;
  const double inner = std::min(given < 0 && given > -1e-6 ? 0 : given, outer);
  // π / 2 in single precision may be slightly larger.
  if (!(inner >= 0 && outer > 0 && outer <= std::numbers::pi / 2 * (1 + 1e-6))) {
    throw InputError("{}/spot: innerConeAngle {} and outerConeAngle {}; expected 0 <= inner <= outer <= pi / 2", place,
                     lamp.spot.innerConeAngle, outer);
  }
  if (from_blender && !smooth) {
    // The file stores (1 − blend) of the outer angle; Blender's lamps fall off over `blend` of the cosines, at least
    // 0.001.
    const double full = std::cos(outer), blend = 1 - inner / outer;
    const double edge = std::acos(std::min(full + std::max((1 - full) * blend, 0.001), 1.0));
    return {direction, glm::degrees(edge), std::min(glm::degrees(outer), 90.0), true};
  }
  return {direction, glm::degrees(inner), std::min(glm::degrees(outer), 90.0), smooth.value_or(false)};
}

}  // namespace

std::optional<scenes::AreaLight> PunctualLights::light_of(const tinygltf::Node& node, const PlacedNode& placed,
                                                          const std::string& name) {
  const auto extension = node.extensions.find(kExtension);
  PENUMBRA_ASSERT(extension != node.extensions.end(), "node {} has no lamp", placed.number);
  const std::string node_place = fmt::format("/nodes/{}", placed.number);
  const tinygltf::Value& reference = extension->second;
  const int number =
      reference.Has("light") && reference.Get("light").IsInt() ? reference.Get("light").GetNumberAsInt() : -1;
  if (number < 0 || static_cast<std::size_t>(number) >= model_.lights.size()) {
    throw InputError("{}/extensions/{}/light: expected the number of one of the file's {} lamps", node_place,
                     kExtension, model_.lights.size());
  }
  const tinygltf::Light& lamp = model_.lights[static_cast<std::size_t>(number)];
  const std::string place = fmt::format("/extensions/{}/lights/{}", kExtension, number);
  const auto size = [&](const char* key, const std::optional<double>& chosen, double otherwise,
                        std::uint64_t& missing) {
    if (const auto own = number_of_extras(lamp.extras, key, lamp.name, losses_)) return *own;
    if (const auto nodes = number_of_extras(node.extras, key, node.name, losses_)) return *nodes;
    if (!chosen) ++missing;
    return chosen.value_or(otherwise);
  };

  // A lamp shines along −Z of its node; only position and direction of the node's transform are used.
  const glm::dvec3 along(placed.to_world * glm::dvec4(0, 0, -1, 0));
  glm::dvec3 color(1);
  if (lamp.color.size() >= 3) color = {lamp.color[0], lamp.color[1], lamp.color[2]};
  for (glm::length_t i = 0; i < 3; ++i) checked(color[i], 0, place + "/color");
  const double intensity = checked(lamp.intensity, 0, place + "/intensity") / divisor_of(lamp.type);

  scenes::AreaLight light;
  if (lamp.type == "directional") {
    if (!(glm::length(along) > 0)) throw InputError("{}: its transform leaves the lamp no direction", node_place);
    const scenes::Sun sun{glm::normalize(along), size("angle", options_.sun_angle, scenes::kSunAngle, without_angle_)};
    if (!(sun.angle >= 0 && sun.angle < 180)) {
      throw InputError("{}: the sun's angle is {} degrees; expected 0 to less than 180", node_place, sun.angle);
    }
    light.shape = sun;
    light.radiance = intensity * color / (sun.angle > 0 ? scenes::irradiance_of_radiance(sun) : 1.0);
    return light;
  }
  if (lamp.type != "point" && lamp.type != "spot") {
    losses_.refuse(fmt::format("is a lamp of type \"{}\", which is none of directional, point and spot", lamp.type),
                   name);
    return std::nullopt;
  }
  if (lamp.range > 0) ++ranges_;
  scenes::Sphere sphere{
      glm::dvec3(placed.to_world[3]), size("radius", options_.lamp_radius, scenes::kLampRadius, without_radius_), {}};
  if (lamp.type == "spot") {
    if (!(glm::length(along) > 0)) throw InputError("{}: its transform leaves the lamp no direction", node_place);
    sphere.cone = cone_of(lamp, glm::normalize(along), is_from_blender(model_),
                          flag_of_extras(lamp.extras, "smooth", lamp.name, losses_), place);
  }
  if (!(sphere.radius >= 0) || !std::isfinite(sphere.radius)) {
    throw InputError("{}: the lamp's radius is {}; expected a length of 0 or more", node_place, sphere.radius);
  }
  if (sphere.radius == 0) {
    sphere.radius = kHardRadius;
    ++hard_;
  }
  light.shape = sphere;
  light.radiance = intensity * color / (std::numbers::pi * sphere.radius * sphere.radius);
  return light;
}

double PunctualLights::divisor_of(const std::string& type) {
  if (options_.lumens_per_watt) return *options_.lumens_per_watt;
  if (writes_watts(model_)) {
    ++in_watts_;
    return type == "directional" ? 1 : 4 * std::numbers::pi;
  }
  if (!is_from_blender(model_)) return 1;
  ++in_lumens_;
  return kBlendersLumensPerWatt;
}

void PunctualLights::add_warnings(std::vector<std::string>& warnings) const {
  if (in_lumens_ > 0) {
    warnings.push_back(
        fmt::format("{} lamps are in lumens, {} per watt, as Blender's exporter writes them; for a file exported with "
                    "Lighting Mode Unitless use --lumens-per-watt 1",
                    in_lumens_, kBlendersLumensPerWatt));
  }
  if (in_watts_ > 0) {
    warnings.push_back(
        fmt::format("{} lamps are in watts (suns: watts a square metre), as Blender's exporter before version 3.4.36 "
                    "writes them; --lumens-per-watt 1 takes them as candela and lux",
                    in_watts_));
  }
  if (hard_ > 0) {
    warnings.push_back(
        fmt::format("{} lamps of radius 0 are taken as spheres of radius {}: hard shadows", hard_, kHardRadius));
  }
  if (without_radius_ > 0) {
    warnings.push_back(
        fmt::format("{} point or spot lamps have no size in the file (extras \"radius\"); taken as spheres of "
                    "radius {} (--lamp-radius)",
                    without_radius_, scenes::kLampRadius));
  }
  if (without_angle_ > 0) {
    warnings.push_back(
        fmt::format("{} sun lamps have no size in the file (extras \"angle\"); taken as {} degrees wide (--sun-angle)",
                    without_angle_, scenes::kSunAngle));
  }
  if (ranges_ > 0)
    warnings.push_back(fmt::format("the range of {} lamps is ignored: light does not end at a distance", ranges_));
}

}  // namespace penumbra::import
