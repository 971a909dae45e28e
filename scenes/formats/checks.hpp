// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/instances.hpp"
#include "scenes/scene.hpp"

#include <string>

/// Requirements that every scene must meet, regardless of its file format. `where` begins the message: a file and a
/// place in it.
namespace penumbra::scenes {

/// The largest absolute coordinate in a scene: scene floats are float32 and predicates multiply three differences.
inline constexpr double kLargestCoordinate = 1e12;

/// Throws InputError unless the light is finite, has an area, and a polygon is flat and convex; the message names the
/// vertex and its deviation.
void check_light(const AreaLight& light, const std::string& where);

/// Requires a view direction, an up direction that is not along it, and a field of view between 0 and 180 degrees.
void check_camera(const Camera& camera, const std::string& where);

/// Requires objects with triangles, finite positions, lights (if `needs_light`) with unique names, and cameras. Checks
/// each light and camera, too. `instances`: triangles that are not in the scene's soup.
void check_scene(const Scene& scene, const std::string& where, bool needs_light = true,
                 const Instances& instances = {});

/// Requires finite coordinates within kLargestCoordinate. `what` names the position in the message.
void check_position(const glm::dvec3& position, const std::string& where, const char* what);

/// Returns "(x, y, z)" for messages.
std::string show_vector(const glm::dvec3& v);

/// Returns the polygon's unit normal by Newell's method: it points to the side from which the vertices run
/// counter-clockwise.
glm::dvec3 polygon_normal(const Polygon& polygon);

}  // namespace penumbra::scenes
