// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"
#include "scenes/whole_view.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Puts a studio around a mesh, or a scene without lights or cameras, so that it can be rendered: a floor below
/// everything, one soft rectangle light above, a camera that sees all.
namespace penumbra::scenes {

/// A light added by the user; shines toward the scene's centre.
struct AddedLight {
  enum class Kind : std::uint8_t { rectangle, sphere, sun, dome };
  Kind kind = Kind::rectangle;
  glm::dvec3 at{0};  ///< centre; for a sun the direction in which its light travels; unused for a dome
  double size = 0;   ///< side of a square, radius of a sphere, apparent diameter of a sun in degrees
};

/// Returns whether the light's place depends on the content of the scene.
constexpr bool has_place(const AddedLight& light) {
  return light.kind != AddedLight::Kind::dome;
}

struct StudioWish {
  bool always = false;                  ///< also around a scene that has lights
  bool never = false;                   ///< a scene without lights is an error
  bool floor = true;                    ///< whether a studio has a floor; a scene that already has one gets none
  bool sampled_domes = false;           ///< added domes use light samples (Dome::sampled)
  double aspect = 1;                    ///< aspect of the picture, width over height, for cameras that see all
  std::vector<AddedLight> lights = {};  ///< added also to a scene that has others
  std::string fit_camera = {};          ///< name of an added first camera that sees all; empty: none
  std::optional<Camera> camera = {};    ///< added as the first camera
};

/// Adds the requested objects, and a studio if the scene has no light or `wish.always`, unless `wish.never`; then a
/// camera, if there is none. Adds a warning about this. `rest`: the same scene at rest, around which everything is
/// placed, so that a studio does not move in a sequence.
void put_in_studio(Scene& scene, const Scene& rest, const StudioWish& wish);

}  // namespace penumbra::scenes
