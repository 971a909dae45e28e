#pragma once

#include "scenes/scene.hpp"

#include <string>

/// What must hold of a scene whatever file it came from. `where` begins the message: a file and a place in it.
namespace penumbra::scenes {

/// The largest absolute coordinate in a scene: scene floats are float32 and predicates multiply three differences.
inline constexpr double kLargestCoordinate = 1e12;

/// Finite, with an area, and a polygon flat and convex: InputError otherwise, naming the vertex and how far it is off.
void check_light(const AreaLight& light, const std::string& where);

/// A view direction, an up direction that is not along it, and a field of view between 0 and 180 degrees.
void check_camera(const Camera& camera, const std::string& where);

/// Objects with triangles, finite positions, lights (if it needs one) with unique names, cameras. Checks each light and
/// camera too.
void check_scene(const Scene& scene, const std::string& where, bool needs_light = true);

/// Finite and within kLargestCoordinate. `what` it is, for the message.
void check_position(const glm::dvec3& position, const std::string& where, const char* what);

/// "(x, y, z)", as messages have it.
std::string show_vector(const glm::dvec3& v);

/// The polygon's unit normal, by Newell's method: the side from which its vertices run counter-clockwise.
glm::dvec3 polygon_normal(const Polygon& polygon);

}  // namespace penumbra::scenes
