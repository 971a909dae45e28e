// SPDX-License-Identifier: Apache-2.0
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

/// The part of a scene that affects V of a picture's view samples, with instances copied where they matter: triangles
/// that pixels see, and triangles that may lie between these and the lights. View samples, V and masks are those of the
/// whole scene, to the last bit: a triangle that is left out is nearest in no pixel, and on no segment to a light.
struct SeenPart {
  scenes::Scene scene;                 ///< with the whole scene's origin, objects, lights and cameras
  std::vector<std::uint32_t> numbers;  ///< each triangle's number in the whole scene
  std::uint64_t triangles = 0;         ///< of the whole scene
  glm::vec3 lower{0}, upper{0};        ///< bounding box of the whole scene's scene floats
};

struct PartOptions {
  /// True: of a dome only the light samples are evaluated, so that one blocker of each suffices. False: areas of a dome
  /// need all triangles, since its directions go everywhere.
  bool dome_samples = false;
  /// The triangles that the rows' pixels see are appended to this list, for viewed_part(); null: not requested.
  std::vector<std::uint64_t>* viewed = nullptr;
};

/// Finds the part for the view samples in some rows of the picture. `lights`: all lights that shine on these, with the
/// pieces of one light next to one another. Throws ResourceError, with the figures, if memory does not suffice.
SeenPart seen_part(const PlacedMeshes& meshes, const PinholeCamera& camera, std::span<const Light> lights,
                   const Tile& rows, const PartOptions& options = {});

/// Returns only the triangles that pixels see, without those between them and the lights. `viewed`: as filled by
/// seen_part().
SeenPart viewed_part(const PlacedMeshes& meshes, std::span<const std::uint64_t> viewed);

}  // namespace penumbra::visibility
