// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "library/mesh_arrays.hpp"
#include "library/scene_state.hpp"
#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// Functions for changing meshes and instances of a scene. Objects' triangles are in the soup in the order of the
/// objects.
namespace penumbra {

/// Returns the range of the object's vertices among the scene's; empty for an object without triangles in the soup.
std::pair<std::uint32_t, std::uint32_t> vertices_of(const scenes::Scene& scene, std::uint32_t object);

/// Throws if the mesh is the body of a light: a light and its body move together, which the interface does not support.
void require_no_light(const scenes::Scene& scene, std::uint32_t object, const std::string& name);

/// Returns the positions of the vertices that the scene keeps, among those newly given for a mesh of `count` vertices.
/// Throws InputError for another number than was given with the mesh.
std::vector<glm::dvec3> kept_positions(const Scene::State& state, std::uint32_t object,
                                       std::span<const Vector> positions, std::size_t count, const std::string& where);

/// Reserves room for `more` further elements, in steps that grow with the list.
template <typename List>
void reserve_more(List& list, std::size_t more) {
  const std::size_t wanted = list.size() + more;
  if (wanted > list.capacity()) list.reserve(std::max(wanted, 2 * list.capacity()));
}
/// Reserves room for a mesh, so that append() cannot fail.
void reserve_for(scenes::Scene& scene, const mesh::TriangleSoup& soup, const std::string& where);
void append(scenes::Scene& scene, std::uint32_t object, const mesh::TriangleSoup& soup);
/// Appends one object of a scene with all data of its vertices.
void copy_object(const scenes::Scene& from, std::uint32_t object, scenes::Scene& to);

/// Returns a mesh's or an instance's matrix. Throws InputError, beginning with `where`, for a matrix that is not finite
/// or whose last row is not 0 0 0 1.
scenes::Placement placement_of(const Matrix& matrix, const std::string& where);

/// Returns the scene's origin before any mesh was moved: the centre of the box around all meshes.
glm::dvec3 origin_at_rest(const Scene::State& state);
/// Returns the file's origin, if given. Otherwise, once meshes have moved, the scene's origin stays at its position at
/// rest; before, it follows from the vertices. A scene with instances keeps the origin that it had when the first of
/// its meshes moved.
std::optional<glm::dvec3> settled_origin(const Scene::State& state, std::span<const glm::dvec3> more = {});

/// Returns the instances of an object; empty: its triangles are in the soup.
inline std::span<const scenes::Instance> instances_of(const Scene::State& state, std::uint32_t object) {
  const std::vector<scenes::Instance>& all = state.instances.all;  // clang 14 has no std::ranges::equal_range
  const auto first = std::ranges::lower_bound(all, object, {}, &scenes::Instance::object);
  return {first, std::ranges::upper_bound(all, object, {}, &scenes::Instance::object)};
}
/// Prepares a scene that was read for changes of its instances.
void adopt_instances(Scene::State& state);
void drop_instances(Scene::State& state, std::uint32_t object);
/// Recounts the soup's triangles before each instance.
void number_instances(Scene::State& state);

/// Returns the state in which `fill` has added the triangles of an object to the scene. All other objects stay as they
/// were.
template <typename Fill>
std::unique_ptr<Scene::State> with_object(const Scene::State& state, std::uint32_t object, const Fill& fill) {
  const scenes::Scene& old = state.scene;
  auto changed = std::make_unique<Scene::State>(state);
  changed->scene.soup = {};
  changed->scene.looks = {};
  changed->rest.assign(old.objects.size(), std::nullopt);
  for (std::uint32_t other = 0; other < old.objects.size(); ++other) {
    if (other == object) {
      fill(changed->scene);
      continue;
    }
    if (other < state.rest.size() && state.rest[other]) {
      changed->rest[other] = state.rest[other];
      changed->rest[other]->first = static_cast<std::uint32_t>(changed->scene.soup.positions.size());
    }
    copy_object(old, other, changed->scene);
  }
  number_instances(*changed);
  changed->meshes = next_meshes();
  return changed;
}

/// Change a mesh with instances, in the mesh's own space, as Scene::set_mesh(), set_positions() and set_transform()
/// promise.
std::unique_ptr<Scene::State> with_shared_mesh(const Scene::State& state, std::uint32_t object, GivenMesh given,
                                               const std::string& where);
void set_shared_positions(Scene::State& state, std::uint32_t object, std::span<const Vector> positions,
                          const std::string& where);
void move_instances(Scene::State& state, std::uint32_t object, const scenes::Placement& by, const std::string& where);
/// Returns whether meshes of other objects, nodes of a glTF file, share this object's triangles.
bool shares_with_others(const Scene::State& state, std::uint32_t object);
/// Returns the state in which the object's instances are triangles in the world.
std::unique_ptr<Scene::State> with_copies_of(const Scene::State& state, std::uint32_t object);

}  // namespace penumbra
