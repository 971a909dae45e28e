// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"
#include "scenes/scene.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// Largest number of triangles that the 3D view draws; meshes with more are coarsened.
inline constexpr std::size_t kMostShownTriangles = 500'000;
/// Largest number of places of one kind of defect that are shown for an object.
inline constexpr std::size_t kMostShownDefects = 20'000;

/// Triangles as drawn.
struct ShownTriangles {
  std::vector<glm::vec3> positions;
  std::vector<mesh::Triangle> triangles;
  std::vector<std::uint32_t> objects;  ///< for each triangle
};

/// Returns the triangles with positions merged in the cells of a cubic grid, each with the first position in the cell,
/// and without the triangles that thereby lose a corner. The grid is the finest of 1024, 512, 256, … cells along the
/// longest side that leaves at most `most` triangles; nothing is merged if there are no more than `most`.
ShownTriangles shown_triangles(std::span<const glm::vec3> positions, std::span<const mesh::Triangle> triangles,
                               std::span<const std::uint32_t> objects, std::size_t most);

/// Returns the message of a scene's meshes: `positions` (x, y, z relative to `origin`), `triangles` (three indices
/// each) and `objects` (one each); in the header `objects` have a name, a linear colour and whether they cast shadows.
std::string meshes_message(const scenes::Scene& scene, const visibility::SceneFloats& floats);

/// Returns the message of the meshes' defects (mesh/diagnosis), object by object, in the colours of `inspect
/// --export-defects`: `lines` and `points` with a colour each, and `triangles` that are not sound, relative to
/// `origin`. Intersections are not searched.
std::string defects_message(const scenes::Scene& scene, const glm::dvec3& origin);

}  // namespace penumbra::app
