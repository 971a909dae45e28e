// SPDX-License-Identifier: Apache-2.0
// Meshes of the public interface's scene: adding, replacing, moving. A call that throws changes nothing.

#include "library/as_error.hpp"
#include "library/light_shape.hpp"
#include "library/mesh_arrays.hpp"
#include "library/named.hpp"
#include "library/scene_objects.hpp"
#include "library/scene_state.hpp"
#include "scenes/formats/checks.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

namespace penumbra {
namespace {

RestMesh& rest_of(Scene::State& state, std::uint32_t object) {
  state.rest.resize(state.scene.objects.size());
  std::optional<RestMesh>& rest = state.rest[object];
  if (rest) return *rest;
  const auto [first, end] = vertices_of(state.scene, object);
  const auto part = [first = first, end = end](const auto& list) {
    return std::vector(list.begin() + first, list.begin() + end);
  };
  RestMesh made{first, part(state.scene.soup.positions), {}};
  if (!state.scene.looks.normals.empty()) made.normals = part(state.scene.looks.normals);
  if (!state.scene.origin) state.scene.origin = origin_at_rest(state);
  rest = std::move(made);
  return *rest;
}

/// Replaces the positions of a mesh whose triangles are in the soup. Throws InputError, before any change, for a wrong
/// number.
void put_positions(Scene::State& state, std::uint32_t object, std::span<const Vector> positions,
                   const std::string& where) {
  RestMesh& rest = rest_of(state, object);
  std::vector<glm::dvec3> kept = kept_positions(state, object, positions, rest.positions.size(), where);
  state.meshes = next_meshes();
  rest.positions = std::move(kept);
  std::ranges::copy(rest.positions, state.scene.soup.positions.begin() + rest.first);
  std::ranges::copy(rest.normals, state.scene.looks.normals.begin() + rest.first);
}

}  // namespace

std::uint64_t next_meshes() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

MeshId Scene::add_mesh(std::string name, std::span<const Vector> positions,
                       std::span<const std::array<std::uint32_t, 3>> triangles, const MeshOptions& options) {
  const std::string where = fmt::format("mesh \"{}\"", name);
  for (const double part : options.color) {
    if (!(part >= 0 && part <= 1))
      throw InputError("{}: color ({}, {}, {}): expected 0 to 1", where, options.color[0], options.color[1],
                       options.color[2]);
  }
  return with_errors([&] {
    GivenMesh given = given_mesh(where, positions, triangles);
    scenes::Object made;
    made.name = std::move(name);
    made.color = to_glm(options.color);
    made.casts_shadow = options.casts_shadow;
    made.receives_shadow = options.receives_shadow;
    // All operations that can fail come first.
    scenes::Scene& scene = state_->scene;
    const auto object = static_cast<std::uint32_t>(scene.objects.size());
    reserve_for(scene, given.soup, where);
    reserve_more(scene.objects, 1);
    reserve_more(scene.warnings, 1);
    note_given(*state_, object, std::move(given.vertices));
    const std::optional<glm::dvec3> origin = settled_origin(*state_, given.soup.positions);
    append(scene, object, given.soup);
    scene.objects.push_back(std::move(made));
    if (!given.warning.empty()) scene.warnings.push_back(std::move(given.warning));
    scene.origin = origin;
    state_->meshes = next_meshes();
    return MeshId{object};
  });
}

void Scene::set_mesh(MeshId mesh, std::span<const Vector> positions,
                     std::span<const std::array<std::uint32_t, 3>> triangles) {
  const std::string where = fmt::format("mesh \"{}\"", mesh_name(mesh));
  require_no_light(state_->scene, mesh.index, mesh_name(mesh));
  with_errors([&] {
    GivenMesh given = given_mesh(where, positions, triangles);
    std::unique_ptr<State> changed;
    if (!instances_of(*state_, mesh.index).empty() && !shares_with_others(*state_, mesh.index)) {
      changed = with_shared_mesh(*state_, mesh.index, std::move(given), where);
    } else {
      changed = with_object(*state_, mesh.index, [&](scenes::Scene& scene) {
        reserve_for(scene, given.soup, where);
        append(scene, mesh.index, given.soup);
        scene.objects[mesh.index].picture.reset();
      });
      drop_instances(*changed, mesh.index);
      note_given(*changed, mesh.index, std::move(given.vertices));
      if (!given.warning.empty()) changed->scene.warnings.push_back(std::move(given.warning));
    }
    changed->scene.origin = settled_origin(*changed);
    state_ = std::move(changed);
  });
}

MeshId Scene::mesh(std::string_view name) const {
  return {static_cast<std::uint32_t>(find_named(state_->scene.objects, name, "mesh"))};
}

std::size_t Scene::mesh_count() const {
  return state_->scene.objects.size();
}

const std::string& Scene::mesh_name(MeshId mesh) const {
  if (mesh.index >= mesh_count()) throw UsageError("the scene has {} meshes, and none {}", mesh_count(), mesh.index);
  return state_->scene.objects[mesh.index].name;
}

void Scene::set_transform(MeshId mesh, const Matrix& m) {
  require_no_light(state_->scene, mesh.index, mesh_name(mesh));
  const std::string where = fmt::format("transform of mesh \"{}\"", mesh_name(mesh));
  const scenes::Placement placement = placement_of(m, where);
  with_errors([&] {
    if (!instances_of(*state_, mesh.index).empty()) return move_instances(*state_, mesh.index, placement, where);
    RestMesh& rest = rest_of(*state_, mesh.index);
    std::vector<glm::dvec3> moved;
    moved.reserve(rest.positions.size());
    for (const glm::dvec3& p : rest.positions) moved.push_back(placement(p));
    for (const glm::dvec3& p : moved) {
      if (!(glm::length(p) <= scenes::kLargestCoordinate))
        throw InputError("{}: a vertex would be at ({}, {}, {})", where, p.x, p.y, p.z);
    }
    state_->meshes = next_meshes();
    std::ranges::copy(moved, state_->scene.soup.positions.begin() + rest.first);
    // Normals transform as planes: by the matrix of cofactors, which also exists for a singular matrix.
    const glm::dmat3 linear(placement.to_world);
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    for (std::size_t i = 0; i < rest.normals.size(); ++i) {
      const glm::dvec3 turned = cofactors * glm::dvec3(rest.normals[i]);
      const double length = glm::length(turned);
      state_->scene.looks.normals[rest.first + i] = length > 0 ? glm::vec3(turned / length) : glm::vec3(0);
    }
  });
}

void Scene::set_positions(MeshId mesh, std::span<const Vector> positions) {
  const std::string where = fmt::format("mesh \"{}\"", mesh_name(mesh));
  require_no_light(state_->scene, mesh.index, mesh_name(mesh));
  require_coordinates(positions, where);
  with_errors([&] {
    if (!instances_of(*state_, mesh.index).empty()) {
      if (!shares_with_others(*state_, mesh.index)) return set_shared_positions(*state_, mesh.index, positions, where);
      std::unique_ptr<State> changed = with_copies_of(*state_, mesh.index);
      put_positions(*changed, mesh.index, positions, where);
      state_ = std::move(changed);
      return;
    }
    put_positions(*state_, mesh.index, positions, where);
  });
}

std::size_t Scene::triangle_count() const {
  return scenes::triangle_count(state_->scene, state_->instances);
}

}  // namespace penumbra
