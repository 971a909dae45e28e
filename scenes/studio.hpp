#pragma once

#include "scenes/scene.hpp"
#include "scenes/whole_view.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What is put around a mesh, or a scene without lights or cameras, so that it can be rendered: a studio. A floor below
/// all there is, one soft rectangle light above it, a camera that sees it.
namespace penumbra::scenes {

/// A light that a user adds; it shines to the middle of what is there.
struct AddedLight {
  enum class Kind : std::uint8_t { rectangle, sphere, sun, dome };
  Kind kind = Kind::rectangle;
  glm::dvec3 at{0};  ///< its centre; of a sun the direction in which its light travels; of a dome none
  double size = 0;   ///< a square's side, a sphere's radius, a sun's apparent diameter in degrees
};

struct StudioWish {
  bool always = false;                  ///< also around a scene that has lights
  bool never = false;                   ///< a scene without lights is an error
  bool floor = true;                    ///< of a studio; where it lies on a floor already, none is put in
  double aspect = 1;                    ///< of the picture, width over height: cameras that see all have it in view
  std::vector<AddedLight> lights = {};  ///< also of a scene that has others
  std::string fit_camera = {};          ///< name of a camera that is put in first and sees all; empty: none is wished
  std::optional<Camera> camera = {};    ///< put in first
};

/// Adds what was wished, and a studio where the scene has no light or `wish.always`, unless `wish.never`; then a
/// camera, if there is none. Says so in the scene's warnings. `rest`: the same scene at rest, around which all is
/// built, so that a studio stays where it is in a sequence.
void put_in_studio(Scene& scene, const Scene& rest, const StudioWish& wish);

}  // namespace penumbra::scenes
