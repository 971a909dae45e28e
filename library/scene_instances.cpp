// SPDX-License-Identifier: Apache-2.0
// Instances in the public interface's scene: meshes that appear several times, stored once. A call that throws changes
// nothing.

#include "library/as_error.hpp"
#include "library/named.hpp"
#include "library/scene_objects.hpp"
#include "mesh/soup_memory.hpp"
#include "scenes/formats/checks.hpp"
#include "session/pictures/request.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace penumbra {
namespace {

ObjectBox box_of(const mesh::TriangleSoup& soup) {
  ObjectBox box{soup.positions.front(), soup.positions.front()};
  for (const glm::dvec3& position : soup.positions)
    box.lower = glm::min(box.lower, position), box.upper = glm::max(box.upper, position);
  return box;
}

/// Throws InputError if a corner of the box would be too far away.
void require_near(const ObjectBox& box, const scenes::Placement& placement, const std::string& where) {
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p =
        placement({(corner & 1) != 0 ? box.upper.x : box.lower.x, (corner & 2) != 0 ? box.upper.y : box.lower.y,
                   (corner & 4) != 0 ? box.upper.z : box.lower.z});
    if (!(glm::length(p) <= scenes::kLargestCoordinate))
      throw InputError("{}: a corner of the box around it would be at ({}, {}, {})", where, p.x, p.y, p.z);
  }
}

/// Returns the placement that applies `inner` first, then `outer`.
scenes::Placement placed_by(const scenes::Placement& outer, const scenes::Placement& inner) {
  return {outer.to_world * inner.to_world, true};
}

std::size_t first_of(const Scene::State& state, std::span<const scenes::Instance> instances) {
  return static_cast<std::size_t>(instances.data() - state.instances.all.data());
}

/// Moves all instances of an object back to their individual placements (State::placed).
void move_back(Scene::State& state, std::uint32_t object) {
  state.moved.erase(object);
  const std::span<const scenes::Instance> instances = instances_of(state, object);
  const std::size_t first = first_of(state, instances);
  for (std::size_t i = first; i < first + instances.size(); ++i) state.instances.all[i].placement = state.placed[i];
}

/// Called before instances move: the scene keeps the origin that it has before the first move.
void begin_moving(Scene::State& state) {
  if (!state.scene.origin) state.scene.origin = origin_at_rest(state);
  state.instances_moved = true;
  state.meshes = next_meshes();
}

/// Returns the triangles of an object, as they are, and its vertices' looks.
scenes::SharedMesh shared_mesh_of(const scenes::Scene& scene, std::uint32_t object) {
  scenes::Scene one;
  copy_object(scene, object, one);
  scenes::SharedMesh mesh;
  mesh.soup = std::move(one.soup);
  mesh.soup.object.assign(mesh.soup.triangles.size(), 0);
  mesh.normals.assign(one.looks.normals.begin(), one.looks.normals.end());
  mesh.colors = std::move(one.looks.colors);
  mesh.places = std::move(one.looks.places);
  return mesh;
}

/// Replaces the mesh of an object's instances; no other object may have instances of that mesh.
void set_shared_mesh(Scene::State& state, std::uint32_t object, scenes::SharedMesh mesh, const std::string& where) {
  const std::span<const scenes::Instance> instances = instances_of(state, object);
  const ObjectBox box = box_of(mesh.soup);
  const std::size_t first = first_of(state, instances);
  for (std::size_t i = 0; i < instances.size(); ++i) require_near(box, state.placed[first + i], where);
  auto made = std::make_shared<const scenes::SharedMesh>(std::move(mesh));
  const std::uint32_t number = instances.front().mesh;
  move_back(state, object);
  state.instances.meshes[number] = std::move(made);
  state.boxes[number] = box;
  state.meshes = next_meshes();
}

}  // namespace

void adopt_instances(Scene::State& state) {
  scenes::Instances& instances = state.instances;
  if (!std::ranges::is_sorted(instances.all, {}, &scenes::Instance::object) ||
      !std::ranges::is_sorted(state.scene.soup.object)) {
    const std::uint64_t bytes = session::bytes_per_copy({}, state.scene.lights);
    state.scene = scenes::copied(std::move(state.scene), std::exchange(instances, {}), bytes);
    state.scene.warnings.emplace_back(
        "instances are copied: the file's nodes are in another order than its meshes, which cannot share triangles "
        "here");
    return;
  }
  for (const auto& mesh : instances.meshes) state.boxes.push_back(box_of(mesh->soup));
  for (const scenes::Instance& instance : instances.all) state.placed.push_back(instance.placement);
}

void drop_instances(Scene::State& state, std::uint32_t object) {
  const std::span<const scenes::Instance> instances = instances_of(state, object);
  const auto first = static_cast<std::ptrdiff_t>(first_of(state, instances));
  const auto end = first + static_cast<std::ptrdiff_t>(instances.size());
  state.instances.all.erase(state.instances.all.begin() + first, state.instances.all.begin() + end);
  state.placed.erase(state.placed.begin() + first, state.placed.begin() + end);
  state.moved.erase(object);
}

bool shares_with_others(const Scene::State& state, std::uint32_t object) {
  const std::span<const scenes::Instance> own = instances_of(state, object);
  return !own.empty() && std::ranges::any_of(state.instances.all, [&](const scenes::Instance& other) {
    return other.mesh == own.front().mesh && other.object != object;
  });
}

std::unique_ptr<Scene::State> with_shared_mesh(const Scene::State& state, std::uint32_t object, GivenMesh given,
                                               const std::string& where) {
  auto changed = std::make_unique<Scene::State>(state);
  set_shared_mesh(*changed, object, {std::move(given.soup)}, where);
  changed->scene.objects[object].picture.reset();
  note_given(*changed, object, std::move(given.vertices));
  if (!given.warning.empty()) changed->scene.warnings.push_back(std::move(given.warning));
  return changed;
}

void set_shared_positions(Scene::State& state, std::uint32_t object, std::span<const Vector> positions,
                          const std::string& where) {
  scenes::SharedMesh mesh = *state.instances.meshes[instances_of(state, object).front().mesh];
  mesh.soup.positions = kept_positions(state, object, positions, mesh.soup.positions.size(), where);
  set_shared_mesh(state, object, std::move(mesh), where);
}

void move_instances(Scene::State& state, std::uint32_t object, const scenes::Placement& by, const std::string& where) {
  const std::span<const scenes::Instance> instances = instances_of(state, object);
  const std::size_t first = first_of(state, instances);
  for (std::size_t i = 0; i < instances.size(); ++i)
    require_near(state.boxes[instances[i].mesh], placed_by(by, state.placed[first + i]), where);
  begin_moving(state);
  state.moved.insert_or_assign(object, by);
  for (std::size_t i = first; i < first + instances.size(); ++i)
    state.instances.all[i].placement = placed_by(by, state.placed[i]);
}

std::unique_ptr<Scene::State> with_copies_of(const Scene::State& state, std::uint32_t object) {
  scenes::Instances own;
  own.meshes = state.instances.meshes;
  for (const scenes::Instance& instance : instances_of(state, object)) {
    own.all.push_back(instance);
    own.all.back().soup_before = 0;
  }
  // The changed scene holds the copies a second time; a triangle has up to three positions that it does not share.
  const scenes::Scene copies = scenes::copied({}, own, mesh::soup_bytes(1, 3));
  auto changed = with_object(state, object, [&](scenes::Scene& to) { copy_object(copies, object, to); });
  drop_instances(*changed, object);
  return changed;
}

InstanceId Scene::add_instance(MeshId mesh, const Matrix& matrix) {
  const std::string where = fmt::format("instance of mesh \"{}\"", mesh_name(mesh));
  require_no_light(state_->scene, mesh.index, mesh_name(mesh));
  const scenes::Placement placement = placement_of(matrix, where);
  return with_errors([&] {
    const std::span<const scenes::Instance> before = instances_of(*state_, mesh.index);
    if (before.empty()) {
      scenes::SharedMesh shared = shared_mesh_of(state_->scene, mesh.index);
      const ObjectBox box = box_of(shared.soup);
      require_near(box, placement, where);
      auto changed = with_object(*state_, mesh.index, [](scenes::Scene&) {});
      // A mesh that was moved keeps the scene's origin where it is, also as an instance.
      if (mesh.index < state_->rest.size() && state_->rest[mesh.index]) changed->instances_moved = true;
      scenes::Instances& instances = changed->instances;
      instances.meshes.push_back(std::make_shared<const scenes::SharedMesh>(std::move(shared)));
      changed->boxes.push_back(box);
      const auto number = static_cast<std::uint32_t>(instances.meshes.size() - 1);
      const auto at = std::ranges::upper_bound(instances.all, mesh.index, {}, &scenes::Instance::object);
      changed->placed.insert(changed->placed.begin() + (at - instances.all.begin()), placement);
      instances.all.insert(at, {number, mesh.index, placement, 0});
      number_instances(*changed);
      changed->scene.origin = settled_origin(*changed);
      state_ = std::move(changed);
      return InstanceId{mesh, 0};
    }
    scenes::Instance made = before.back();
    const std::size_t count = before.size(), end = first_of(*state_, before) + count;
    require_near(state_->boxes[made.mesh], placement, where);
    if (count == std::numeric_limits<std::uint32_t>::max()) throw InputError("{}: there are 2^32 already", where);
    const auto moved = state_->moved.find(mesh.index);
    made.placement = moved == state_->moved.end() ? placement : placed_by(moved->second, placement);
    reserve_more(state_->instances.all, 1);
    reserve_more(state_->placed, 1);
    state_->instances.all.insert(state_->instances.all.begin() + static_cast<std::ptrdiff_t>(end), made);
    state_->placed.insert(state_->placed.begin() + static_cast<std::ptrdiff_t>(end), placement);
    state_->meshes = next_meshes();
    return InstanceId{mesh, static_cast<std::uint32_t>(count)};
  });
}

std::size_t Scene::instance_count(MeshId mesh) const {
  static_cast<void>(mesh_name(mesh));  // throws for a mesh that the scene does not have
  return instances_of(*state_, mesh.index).size();
}

void Scene::set_transform(InstanceId instance, const Matrix& matrix) {
  const std::size_t count = instance_count(instance.mesh);
  if (instance.number >= count)
    throw UsageError("mesh \"{}\" has {} instances, and none {}", mesh_name(instance.mesh), count, instance.number);
  const std::string where =
      fmt::format("transform of instance {} of mesh \"{}\"", instance.number, mesh_name(instance.mesh));
  const scenes::Placement placement = placement_of(matrix, where);
  with_errors([&] {
    State& state = *state_;
    const std::size_t number = first_of(state, instances_of(state, instance.mesh.index)) + instance.number;
    const auto moved = state.moved.find(instance.mesh.index);
    const scenes::Placement all = moved == state.moved.end() ? placement : placed_by(moved->second, placement);
    require_near(state.boxes[state.instances.all[number].mesh], all, where);
    begin_moving(state);
    state.placed[number] = placement;
    state.instances.all[number].placement = all;
  });
}

}  // namespace penumbra
