// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/instances.hpp"
#include "scenes/scene.hpp"

#include <penumbra/scene.hpp>

#include <glm/vec3.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace penumbra {

/// Mesh as added or read: the positions to which set_transform() applies its matrix.
struct RestMesh {
  std::uint32_t first = 0;  ///< index of its first vertex among the scene's; its vertices are consecutive
  std::vector<glm::dvec3> positions;
  std::vector<glm::vec3> normals;  ///< empty: the scene has none
};

/// Vertices given for a mesh.
struct GivenVertices {
  std::vector<std::uint32_t> used;  ///< indices of the given vertices that the scene keeps, in order; empty: all
  std::size_t count = 0;            ///< number of given vertices
};

/// Returns a number that no scene has had before.
std::uint64_t next_meshes();

/// Box around a mesh with instances, in its own space.
struct ObjectBox {
  glm::dvec3 lower{0}, upper{0};
};

struct Scene::State {
  scenes::Scene scene;
  /// Meshes with instances, whose triangles are not in scene.soup; in the order of their objects.
  scenes::Instances instances = {};
  std::vector<ObjectBox> boxes = {};  ///< box of each of instances.meshes
  /// Placement of each of instances.all by add_instance(), set_transform() or the file, before `moved` is applied.
  std::vector<scenes::Placement> placed = {};
  /// For objects whose instances were moved together: the common movement.
  std::map<std::uint32_t, scenes::Placement> moved = {};
  bool instances_moved = false;  ///< any instance was moved since the scene was made
  /// Positions of each object at rest; set by its first set_transform().
  std::vector<std::optional<RestMesh>> rest = {};
  /// Vertices given for the first objects, one entry each; objects without an entry keep all their vertices.
  std::vector<GivenVertices> given = {};
  /// The origin given by the file, which scenes that move have: it stays unchanged when meshes are added.
  std::optional<glm::dvec3> file_origin = {};
  /// Differs between any two scenes of the process whose triangles, pictures or vertices' looks differ.
  std::uint64_t meshes = next_meshes();
  std::optional<std::size_t> camera = {};  ///< default camera; nullopt: the first
};

}  // namespace penumbra
