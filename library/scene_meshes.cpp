// Meshes of the interface's scene: adding, replacing, moving. A call that throws changes nothing.

#include "library/as_error.hpp"
#include "library/light_shape.hpp"
#include "library/mesh_arrays.hpp"
#include "library/named.hpp"
#include "library/scene_state.hpp"
#include "mesh/unused_vertices.hpp"
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

/// Returns the range of the mesh's vertices among the scene's.
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

/// Throws if the mesh is the body of a light: a light and its body move together, which the interface does not support.
void require_no_light(const scenes::Scene& scene, std::uint32_t object, const std::string& name) {
  if (const auto& emits = scene.objects[object].emits)
    throw InputError("mesh \"{}\" is the body of light \"{}\", which would stay behind: remove the light first", name,
                     scene.lights[*emits].name);
}

/// Mesh as given by a program, without the vertices that no triangle uses.
struct GivenMesh {
  mesh::TriangleSoup soup;
  GivenVertices vertices;
  std::string warning;  ///< empty: all vertices are used
};

GivenMesh given_mesh(const std::string& where, std::span<const Vector> positions,
                     std::span<const std::array<std::uint32_t, 3>> triangles) {
  GivenMesh given{.soup = soup_of(positions, triangles, where), .vertices = {}, .warning = {}};
  given.vertices.used = mesh::drop_unused_vertices(given.soup);
  given.vertices.count = positions.size();
  if (const std::size_t unused = positions.size() - given.soup.positions.size(); unused > 0)
    given.warning = fmt::format("{}: left out {} vertices that no triangle uses", where, unused);
  return given;
}

/// Reserves room for `more` further elements, in steps that grow with the list.
template <typename List>
void reserve_more(List& list, std::size_t more) {
  const std::size_t wanted = list.size() + more;
  if (wanted > list.capacity()) list.reserve(std::max(wanted, 2 * list.capacity()));
}

/// Reserves room for a mesh, so that append() cannot fail.
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

bool any_has_moved(const Scene::State& state) {
  return std::ranges::any_of(state.rest, [](const auto& rest) { return rest.has_value(); });
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

/// Returns the file's origin, if given. Otherwise, once meshes have moved, the scene's origin stays at its position at
/// rest; before, it follows from the vertices.
std::optional<glm::dvec3> settled_origin(const Scene::State& state, std::span<const glm::dvec3> more = {}) {
  if (state.file_origin || !any_has_moved(state)) return state.file_origin;
  return rest_center(state, more);
}

/// Appends one object of a scene with all data of its vertices.
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
  if (!state.scene.origin) state.scene.origin = rest_center(state);
  rest = std::move(made);
  return *rest;
}

/// Records the indices of a mesh's given vertices that the scene keeps.
void note_given(Scene::State& state, std::uint32_t object, GivenVertices vertices) {
  if (vertices.used.empty() && object >= state.given.size()) return;
  if (object >= state.given.size()) state.given.resize(object + 1);
  state.given[object] = std::move(vertices);
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
    // Object by object, so that triangles stay in the order of the objects.
    const scenes::Scene& old = state_->scene;
    auto changed = std::make_unique<State>(*state_);
    changed->scene.soup = {};
    changed->scene.looks = {};
    changed->rest.assign(old.objects.size(), std::nullopt);
    changed->scene.origin.reset();
    for (std::uint32_t object = 0; object < old.objects.size(); ++object) {
      if (object == mesh.index) {
        reserve_for(changed->scene, given.soup, where);
        append(changed->scene, object, given.soup);
        changed->scene.objects[object].picture.reset();
      } else {
        if (object < state_->rest.size() && state_->rest[object]) {
          changed->rest[object] = state_->rest[object];
          changed->rest[object]->first = static_cast<std::uint32_t>(changed->scene.soup.positions.size());
        }
        copy_object(old, object, changed->scene);
      }
    }
    note_given(*changed, mesh.index, std::move(given.vertices));
    if (!given.warning.empty()) changed->scene.warnings.push_back(std::move(given.warning));
    changed->scene.origin = settled_origin(*changed);
    changed->meshes = next_meshes();
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
  const bool is_affine = m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1;
  if (!is_affine || !std::ranges::all_of(m, [](double x) { return std::isfinite(x); }))
    throw InputError("transform of mesh \"{}\": expected finite numbers, and 0 0 0 1 in the last row", mesh_name(mesh));
  const glm::dmat3 linear(m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]);  // by columns
  const glm::dvec3 offset(m[3], m[7], m[11]);
  with_errors([&] {
    RestMesh& rest = rest_of(*state_, mesh.index);
    std::vector<glm::dvec3> moved;
    moved.reserve(rest.positions.size());
    for (const glm::dvec3& p : rest.positions) moved.push_back(linear * p + offset);
    for (const glm::dvec3& p : moved) {
      if (!(glm::length(p) <= scenes::kLargestCoordinate))
        throw InputError("transform of mesh \"{}\": a vertex would be at ({}, {}, {})", mesh_name(mesh), p.x, p.y, p.z);
    }
    state_->meshes = next_meshes();
    std::ranges::copy(moved, state_->scene.soup.positions.begin() + rest.first);
    // Normals transform as planes: by the matrix of cofactors, which also exists for a singular matrix.
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
    RestMesh& rest = rest_of(*state_, mesh.index);
    static const GivenVertices kAll;
    const GivenVertices& given = mesh.index < state_->given.size() ? state_->given[mesh.index] : kAll;
    const std::size_t count = given.used.empty() ? rest.positions.size() : given.count;
    if (positions.size() != count) throw InputError("{}: {} positions; it has {}", where, positions.size(), count);
    state_->meshes = next_meshes();
    for (std::size_t i = 0; i < rest.positions.size(); ++i) {
      rest.positions[i] = to_glm(positions[given.used.empty() ? i : given.used[i]]);
      state_->scene.soup.positions[rest.first + i] = rest.positions[i];
    }
    std::ranges::copy(rest.normals, state_->scene.looks.normals.begin() + rest.first);
  });
}

std::size_t Scene::triangle_count() const {
  return state_->scene.soup.triangles.size();
}

}  // namespace penumbra
