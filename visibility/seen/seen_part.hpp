#pragma once

#include "scenes/instances.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/method.hpp"
#include "visibility/seen/placed_meshes.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// What of a scene plays a part in V of a picture's view samples, with copies of instances' triangles where they do:
/// what pixels see, and what may lie between that and the lights. View samples, V and masks of it are those of the
/// scene, to the last bit: what is left out is nearer to no pixel, and on no way to a light.
struct SeenPart {
  scenes::Scene scene;                 ///< with the whole one's origin, objects, lights and cameras
  std::vector<std::uint32_t> numbers;  ///< of each of its triangles, in the whole scene
  std::uint64_t triangles = 0;         ///< of the whole scene
  glm::vec3 lower{0}, upper{0};        ///< bounding box of the whole scene's scene floats
};

/// Of the view samples in some rows of the picture. `lights`: all that shine on these, pieces of one beside each other.
/// A dome's ways go everywhere, so that it needs all triangles. Throws ResourceError, with the numbers, where memory
/// does not suffice.
SeenPart seen_part(const PlacedMeshes& meshes, const PinholeCamera& camera, std::span<const Light> lights,
                   const Tile& rows);

}  // namespace penumbra::visibility
