// SPDX-License-Identifier: Apache-2.0
// Parses --studio, --floor, --add-light and --camera into the studio that is added to a scene.

#include "session/studio_options.hpp"

#include "base/error.hpp"
#include "scenes/formats/checks.hpp"
#include "session/parse.hpp"

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include <cmath>
#include <optional>
#include <string_view>

namespace penumbra::session {
namespace {

/// Parses "X,Y,Z"; returns nullopt for any other text.
std::optional<glm::dvec3> parse_point(std::string_view text) {
  const auto parts = split(text, ',');
  if (parts.size() != 3) return std::nullopt;
  glm::dvec3 point;
  for (int i = 0; i < 3; ++i) {
    const auto number = parse_number(parts[static_cast<std::size_t>(i)]);
    if (!number || !(std::abs(*number) <= scenes::kLargestCoordinate)) return std::nullopt;
    point[i] = *number;
  }
  return point;
}

scenes::AddedLight parse_light(const std::string& text) {
  using Kind = scenes::AddedLight::Kind;
  const auto parts = split(text, ':');
  const auto refuse = [&](std::string_view why) {
    return UsageError(
        "--add-light {}: {}; expected rectangle:X,Y,Z:SIZE, sphere:X,Y,Z:RADIUS, sun:X,Y,Z:ANGLE (the direction in "
        "which its light travels, and its diameter in degrees) or dome (all around, of radiance 1)",
        text, why);
  };
  scenes::AddedLight light;
  if (parts[0] == "rectangle")
    light.kind = Kind::rectangle;
  else if (parts[0] == "sphere")
    light.kind = Kind::sphere;
  else if (parts[0] == "sun")
    light.kind = Kind::sun;
  else if (parts[0] == "dome")
    light.kind = Kind::dome;
  else
    throw refuse(fmt::format("\"{}\" is not a kind of light", parts[0]));
  if (light.kind == Kind::dome) {
    if (parts.size() != 1) throw refuse("a dome has neither place nor size");
    return light;
  }
  if (parts.size() != 3) throw refuse("it does not have three parts");
  const auto at = parse_point(parts[1]);
  if (!at) throw refuse(fmt::format("\"{}\" is not three numbers", parts[1]));
  const auto size = parse_number(parts[2]);
  const bool is_sun = light.kind == Kind::sun;
  if (!size || !(is_sun ? *size >= 0 && *size < 180 : *size > 0 && *size <= scenes::kLargestCoordinate))
    throw refuse(
        fmt::format("\"{}\" is not a valid {}", parts[2], is_sun ? "angle from 0 to less than 180" : "length above 0"));
  if (is_sun && *at == glm::dvec3(0)) throw refuse("its direction is zero");
  light.at = *at;
  light.size = *size;
  return light;
}

/// Returns nullopt for a text that can only be a name.
std::optional<scenes::Camera> parse_camera(const std::string& text) {
  const auto parts = split(text, ':');
  if (parts.size() != 2 && parts.size() != 3) return std::nullopt;
  const auto eye = parse_point(parts[0]), target = parse_point(parts[1]);
  if (!eye || !target) return std::nullopt;
  scenes::Camera camera;
  camera.name = text;
  camera.eye = *eye;
  camera.target = *target;
  if (eye->x == target->x && eye->z == target->z) camera.up = {0, 0, -1};  // the camera looks straight up or down
  if (parts.size() == 3) {
    const auto angle = parse_number(parts[2]);
    if (!angle || !(*angle > 0 && *angle < 180))
      throw UsageError("--camera {}: \"{}\" is not a vertical field of view above 0 and below 180 degrees", text,
                       parts[2]);
    camera.vertical_fov = *angle;
  }
  if (*eye == *target) throw UsageError("--camera {}: eye and target are the same point", text);
  return camera;
}

}  // namespace

scenes::StudioWish parse_studio(const StudioOptions& options, const std::string& camera) {
  scenes::StudioWish wish;
  wish.always = options.always;
  wish.never = options.never;
  if (options.floor != "auto" && options.floor != "none")
    throw UsageError("--floor {}: expected none or auto", options.floor);
  wish.floor = options.floor == "auto";
  for (const std::string& light : options.lights) wish.lights.push_back(parse_light(light));
  if (camera == "fit")
    wish.fit_camera = camera;
  else
    wish.camera = parse_camera(camera);
  return wish;
}

}  // namespace penumbra::session
