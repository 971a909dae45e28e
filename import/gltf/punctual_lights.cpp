// KHR_lights_punctual (Khronos, ratified extension of glTF 2.0).

#include "import/gltf/punctual_lights.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "import/gltf/gltf_load.hpp"

#include <tiny_gltf.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace penumbra::scenes {
namespace {

constexpr const char* kExtension = "KHR_lights_punctual";
constexpr double kBlendersLumensPerWatt = 683;  // its "Standard" lighting mode

/// A number of the extras, of the lamp or of its node.
std::optional<double> extra(const tinygltf::Value& extras, const char* key, const std::string& place) {
  if (!extras.IsObject() || !extras.Has(key)) return std::nullopt;
  const tinygltf::Value& value = extras.Get(key);
  if (!value.IsNumber()) throw InputError("{}/extras/{}: expected a number", place, key);
  return value.GetNumberAsDouble();
}

double checked(double value, double least, const std::string& place) {
  if (!std::isfinite(value) || value < least)
    throw InputError("{}: {}; expected a number from {} up", place, value, least);
  return value;
}

Cone cone_of(const tinygltf::Light& lamp, const glm::dvec3& direction, bool from_blender, const std::string& place) {
  const auto own_smooth = extra(lamp.extras, "smooth", place);
  const double smooth = own_smooth.value_or(0);
  if (smooth != 0 && smooth != 1) throw InputError("{}/extras/smooth: {}; expected 0 or 1", place, smooth);
  const double inner = lamp.spot.innerConeAngle, outer = lamp.spot.outerConeAngle;
  // Half a turn over four in single precision may be a hair more.
  if (!(inner >= 0 && inner < outer && outer <= std::numbers::pi / 2 * (1 + 1e-6))) {
    throw InputError("{}/spot: innerConeAngle {} and outerConeAngle {}; expected 0 <= inner < outer <= pi / 2", place,
                     inner, outer);
  }
  if (from_blender && !own_smooth) {
    // The file has (1 − blend) of the outer angle; Blender's lamps fall over `blend` of the cosines, at least 0.001.
    const double full = std::cos(outer), blend = 1 - inner / outer;
    const double edge = std::acos(std::min(full + std::max((1 - full) * blend, 0.001), 1.0));
    return {direction, glm::degrees(edge), std::min(glm::degrees(outer), 90.0), true};
  }
  return {direction, glm::degrees(inner), std::min(glm::degrees(outer), 90.0), smooth == 1};
}

}  // namespace

AreaLight PunctualLights::light_of(const tinygltf::Node& node, const PlacedNode& placed) {
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
    if (const auto own = extra(lamp.extras, key, place)) return *own;
    if (const auto nodes = extra(node.extras, key, node_place)) return *nodes;
    if (!chosen) ++missing;
    return chosen.value_or(otherwise);
  };

  // A lamp shines along −Z of its node; nothing but position and direction is taken of the node's transform.
  const glm::dvec3 along(placed.to_world * glm::dvec4(0, 0, -1, 0));
  glm::dvec3 color(1);
  if (lamp.color.size() >= 3) color = {lamp.color[0], lamp.color[1], lamp.color[2]};
  for (glm::length_t i = 0; i < 3; ++i) checked(color[i], 0, place + "/color");
  const bool from_blender = is_from_blender(model_);
  const double per_watt = options_.lumens_per_watt.value_or(from_blender ? kBlendersLumensPerWatt : 1.0);
  if (from_blender && !options_.lumens_per_watt) ++in_lumens_;
  const double intensity = checked(lamp.intensity, 0, place + "/intensity") / per_watt;

  AreaLight light;
  if (lamp.type == "directional") {
    if (!(glm::length(along) > 0)) throw InputError("{}: its transform leaves the lamp no direction", node_place);
    const Sun sun{glm::normalize(along), size("angle", options_.sun_angle, kSunAngle, without_angle_)};
    if (!(sun.angle >= 0 && sun.angle < 180)) {
      throw InputError("{}: the sun's angle is {} degrees; expected 0 to less than 180", node_place, sun.angle);
    }
    light.shape = sun;
    light.radiance = intensity * color / (sun.angle > 0 ? irradiance_of_radiance(sun) : 1.0);
    return light;
  }
  if (lamp.type != "point" && lamp.type != "spot") {
    throw InputError("{}/type: \"{}\"; expected directional, point or spot", place, lamp.type);
  }
  if (lamp.range > 0) ++ranges_;
  Sphere sphere{glm::dvec3(placed.to_world[3]), size("radius", options_.lamp_radius, kLampRadius, without_radius_), {}};
  if (lamp.type == "spot") {
    if (!(glm::length(along) > 0)) throw InputError("{}: its transform leaves the lamp no direction", node_place);
    sphere.cone = cone_of(lamp, glm::normalize(along), from_blender, place);
  }
  if (!(sphere.radius > 0) || !std::isfinite(sphere.radius)) {
    throw InputError("{}: the lamp's radius is {}; expected a length above 0", node_place, sphere.radius);
  }
  light.shape = sphere;
  light.radiance = intensity * color / (std::numbers::pi * sphere.radius * sphere.radius);
  return light;
}

void PunctualLights::add_warnings(std::vector<std::string>& warnings) const {
  if (in_lumens_ > 0) {
    warnings.push_back(
        fmt::format("{} lamps are in lumens, {} to a watt, as Blender's exporter writes them; of one exported with "
                    "Lighting Mode Unitless say --lumens-per-watt 1",
                    in_lumens_, kBlendersLumensPerWatt));
  }
  if (without_radius_ > 0) {
    warnings.push_back(
        fmt::format("{} point or spot lamps have no size in the file (extras \"radius\"); taken as spheres of "
                    "radius {} (--lamp-radius)",
                    without_radius_, kLampRadius));
  }
  if (without_angle_ > 0) {
    warnings.push_back(
        fmt::format("{} sun lamps have no size in the file (extras \"angle\"); taken as {} degrees wide (--sun-angle)",
                    without_angle_, kSunAngle));
  }
  if (ranges_ > 0) warnings.push_back(fmt::format("the range of {} lamps ignored: light has no end", ranges_));
}

}  // namespace penumbra::scenes
