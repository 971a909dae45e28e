// SPDX-License-Identifier: Apache-2.0
// Objects of the public interface's scene, their vertices, and the scene's origin, for all functions that change them.

#include "library/scene_objects.hpp"

#include "base/error.hpp"
#include "library/light_shape.hpp"
#include "library/mesh_arrays.hpp"
#include "visibility/seen/placed_meshes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace penumbra {
namespace {

bool any_has_moved(const Scene::State& state) {
  return state.instances_moved || std::ranges::any_of(state.rest, [](const auto& rest) { return rest.has_value(); });
}

/// Returns the centre of the bounding box of all vertices at rest, and of the added ones.
glm::dvec3 rest_center(const Scene::State& state, std::span<const glm::dvec3> more = {}) {
  std::vector<glm::dvec3> positions = state.scene.soup.positions;
  for (const auto& rest : state.rest) {
    if (rest) std::ranges::copy(rest->positions, positions.begin() + rest->first);
  }
  positions.insert(positions.end(), more.begin(), more.end());
  glm::dvec3 low = positions.front(), high = low;
  for (const glm::dvec3& p : positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  return 0.5 * (low + high);
}

}  // namespace

std::pair<std::uint32_t, std::uint32_t> vertices_of(const scenes::Scene& scene, std::uint32_t object) {
  std::uint32_t first = std::numeric_limits<std::uint32_t>::max(), end = 0;
  for (std::size_t i = 0; i < scene.soup.triangles.size(); ++i) {
    if (scene.soup.object[i] != object) continue;
    for (const std::uint32_t vertex : scene.soup.triangles[i]) {
      first = std::min(first, vertex);
      end = std::max(end, vertex + 1);
    }
  }
  return {std::min(first, end), end};
}

void require_no_light(const scenes::Scene& scene, std::uint32_t object, const std::string& name) {
  if (const auto& emits = scene.objects[object].emits)
    throw InputError("mesh \"{}\" is the body of light \"{}\", which would stay behind: remove the light first", name,
                     scene.lights[*emits].name);
}

std::vector<glm::dvec3> kept_positions(const Scene::State& state, std::uint32_t object,
                                       std::span<const Vector> positions, std::size_t count, const std::string& where) {
  static const GivenVertices all;
  const GivenVertices& given = object < state.given.size() ? state.given[object] : all;
  const std::size_t wanted = given.used.empty() ? count : given.count;
  if (positions.size() != wanted) throw InputError("{}: {} positions; it has {}", where, positions.size(), wanted);
  std::vector<glm::dvec3> kept(count);
  for (std::size_t i = 0; i < count; ++i) kept[i] = to_glm(positions[given.used.empty() ? i : given.used[i]]);
  return kept;
}

void reserve_for(scenes::Scene& scene, const mesh::TriangleSoup& soup, const std::string& where) {
  if (scene.soup.positions.size() + soup.positions.size() > std::numeric_limits<std::uint32_t>::max())
    throw InputError("{}: the scene has more than 2^32 vertices", where);
  reserve_more(scene.soup.positions, soup.positions.size());
  reserve_more(scene.soup.triangles, soup.triangles.size());
  reserve_more(scene.soup.object, soup.triangles.size());
  reserve_more(scene.soup.source_face, soup.triangles.size());
  // Non-empty lists of looks have the length of the soup's positions.
  if (!scene.looks.normals.empty()) reserve_more(scene.looks.normals, soup.positions.size());
  if (!scene.looks.colors.empty()) reserve_more(scene.looks.colors, soup.positions.size());
  if (!scene.looks.places.empty()) reserve_more(scene.looks.places, soup.positions.size());
}

void append(scenes::Scene& scene, std::uint32_t object, const mesh::TriangleSoup& soup) {
  mesh::TriangleSoup& all = scene.soup;
  const auto first = static_cast<std::uint32_t>(all.positions.size());
  all.positions.insert(all.positions.end(), soup.positions.begin(), soup.positions.end());
  for (const auto& [a, b, c] : soup.triangles) all.triangles.push_back({a + first, b + first, c + first});
  all.object.insert(all.object.end(), soup.triangles.size(), object);
  all.source_face.insert(all.source_face.end(), soup.source_face.begin(), soup.source_face.end());
  const std::size_t count = all.positions.size();
  if (!scene.looks.normals.empty()) scene.looks.normals.resize(count, glm::vec3(0));
  if (!scene.looks.colors.empty()) scene.looks.colors.resize(count, glm::vec4(1));
  if (!scene.looks.places.empty()) scene.looks.places.resize(count, glm::dvec2(0));
}

void copy_object(const scenes::Scene& from, std::uint32_t object, scenes::Scene& to) {
  const auto [first, end] = vertices_of(from, object);
  const std::size_t start = to.soup.positions.size();
  const auto copy = [&, first = first, end = end](const auto& list, auto& into, const auto& filler) {
    if (list.empty()) return;
    into.resize(start, filler);
    into.insert(into.end(), list.begin() + first, list.begin() + end);
  };
  to.soup.positions.insert(to.soup.positions.end(), from.soup.positions.begin() + first,
                           from.soup.positions.begin() + end);
  copy(from.looks.normals, to.looks.normals, glm::vec3(0));
  copy(from.looks.colors, to.looks.colors, glm::vec4(1));
  copy(from.looks.places, to.looks.places, glm::dvec2(0));
  for (std::size_t i = 0; i < from.soup.triangles.size(); ++i) {
    if (from.soup.object[i] != object) continue;
    mesh::Triangle triangle = from.soup.triangles[i];
    for (std::uint32_t& vertex : triangle) vertex = static_cast<std::uint32_t>(vertex - first + start);
    to.soup.triangles.push_back(triangle);
    to.soup.object.push_back(object);
    to.soup.source_face.push_back(from.soup.source_face[i]);
  }
}

scenes::Placement placement_of(const Matrix& m, const std::string& where) {
  const bool is_affine = m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1;
  if (!is_affine || !std::ranges::all_of(m, [](double x) { return std::isfinite(x); }))
    throw InputError("{}: expected finite numbers, and 0 0 0 1 in the last row", where);
  return {
      glm::dmat4(m[0], m[4], m[8], 0, m[1], m[5], m[9], 0, m[2], m[6], m[10], 0, m[3], m[7], m[11], 1),  // by columns
      true};
}

glm::dvec3 origin_at_rest(const Scene::State& state) {
  if (state.instances.empty()) return rest_center(state);
  scenes::Scene scene;
  scene.soup = state.scene.soup;
  scene.objects = state.scene.objects;
  return visibility::PlacedMeshes(scene, state.instances).origin();
}

std::optional<glm::dvec3> settled_origin(const Scene::State& state, std::span<const glm::dvec3> more) {
  if (state.file_origin || !any_has_moved(state)) return state.file_origin;
  return state.instances.empty() ? rest_center(state, more) : state.scene.origin;
}

void number_instances(Scene::State& state) {
  const mesh::TriangleSoup& soup = state.scene.soup;
  std::uint64_t before = 0;
  for (scenes::Instance& instance : state.instances.all) {
    while (before < soup.triangles.size() && soup.object[before] < instance.object) ++before;
    instance.soup_before = before;
  }
}

}  // namespace penumbra
