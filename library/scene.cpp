// A scene in a program's hands: the scene of scenes/, built or changed piece by piece, each change checked as a file
// is.

#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "library/light_shape.hpp"
#include "library/scene_state.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/formats/json_reader.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/formats/writer.hpp"

#include <fmt/ranges.h>
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

scenes::Camera to_scene(const Camera& camera) {
  scenes::Camera made;
  made.name = camera.name;
  made.eye = to_glm(camera.eye);
  made.target = to_glm(camera.target);
  made.up = to_glm(camera.up);
  made.vertical_fov = camera.vertical_fov;
  made.height = camera.height;
  return made;
}

template <typename Named>
std::size_t find_named(const std::vector<Named>& elements, std::string_view name, const char* what) {
  const auto found = std::ranges::find(elements, name, &Named::name);
  if (found != elements.end()) return static_cast<std::size_t>(found - elements.begin());
  std::vector<std::string> names;
  for (const Named& element : elements) names.push_back(element.name);
  throw UsageError("the scene has no {} \"{}\"; it has: {}{}", what, name, fmt::join(names, ", "),
                   did_you_mean(name, names));
}

void require_coordinates(std::span<const Vector> positions, const std::string& where) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto is_coordinate = [](double x) { return std::abs(x) <= scenes::kLargestCoordinate; };  // not NaN
    if (!std::ranges::all_of(positions[i], is_coordinate)) {
      throw InputError("{}: vertex {} is ({}, {}, {}); expected finite numbers up to {}", where, i, positions[i][0],
                       positions[i][1], positions[i][2], scenes::kLargestCoordinate);
    }
  }
}

scenes::ReadOptions reading(const LoadOptions& options) {
  scenes::ReadOptions read;
  read.allow_outside = options.allow_outside;
  read.lenient = options.lenient;
  read.lamp_radius = options.lamp_radius;
  read.sun_angle = options.sun_angle;
  read.lumens_per_watt = options.lumens_per_watt;
  read.clips = options.clips;
  if (options.frame) {
    if (!(options.fps > 0)) throw UsageError("fps {}: expected frames a second, above 0", options.fps);
    read.time = *options.frame * (1 / options.fps);  // as the command line has it
  }
  return read;
}

/// The mesh's vertices among the scene's.
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

void require_mesh(const std::string& where, std::span<const Vector> positions,
                  std::span<const std::array<std::uint32_t, 3>> triangles) {
  if (triangles.empty()) throw InputError("{}: it has no triangles", where);
  require_coordinates(positions, where);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::uint32_t largest = std::ranges::max(triangles[i]);
    if (largest >= positions.size())
      throw InputError("{}: triangle {} has vertex {}; there are {}", where, i, largest, positions.size());
  }
}

/// A light and its body move together, which the interface cannot do.
void require_no_light(const scenes::Scene& scene, std::uint32_t object, const std::string& name) {
  if (const auto& emits = scene.objects[object].emits)
    throw InputError("mesh \"{}\" is the body of light \"{}\", which would stay behind: remove the light first", name,
                     scene.lights[*emits].name);
}

/// Lists of looks that exist are as long as the soup's positions.
void fill_looks(scenes::Scene& scene) {
  const std::size_t count = scene.soup.positions.size();
  if (!scene.looks.normals.empty()) scene.looks.normals.resize(count, glm::vec3(0));
  if (!scene.looks.colors.empty()) scene.looks.colors.resize(count, glm::vec4(1));
  if (!scene.looks.places.empty()) scene.looks.places.resize(count, glm::dvec2(0));
}

void append(scenes::Scene& scene, std::uint32_t object, const std::string& where, std::span<const Vector> positions,
            std::span<const std::array<std::uint32_t, 3>> triangles) {
  mesh::TriangleSoup& soup = scene.soup;
  if (soup.positions.size() + positions.size() > std::numeric_limits<std::uint32_t>::max())
    throw InputError("{}: the scene has more than 2^32 vertices", where);
  const auto first = static_cast<std::uint32_t>(soup.positions.size());
  for (const Vector& p : positions) soup.positions.push_back(to_glm(p));
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    soup.triangles.push_back({a + first, b + first, c + first});
    soup.object.push_back(object);
    soup.source_face.push_back(i);
  }
  fill_looks(scene);
}

/// The centre of the bounding box of all vertices at rest.
glm::dvec3 rest_center(const Scene::State& state) {
  std::vector<glm::dvec3> positions = state.scene.soup.positions;
  for (const auto& rest : state.rest) {
    if (rest) std::ranges::copy(rest->positions, positions.begin() + rest->first);
  }
  glm::dvec3 low = positions.front(), high = low;
  for (const glm::dvec3& p : positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  return 0.5 * (low + high);
}

/// Once meshes have moved, the scene's origin stays where it was at rest.
void settle_origin(Scene::State& state) {
  state.scene.origin.reset();
  if (std::ranges::any_of(state.rest, [](const auto& rest) { return rest.has_value(); }))
    state.scene.origin = rest_center(state);
}

/// Appends one object of a scene with all that its vertices have.
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

}  // namespace

std::uint64_t next_meshes() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

Scene::Scene() : state_(std::make_unique<State>()) {
  state_->scene.name = "scene";
}
Scene::Scene(const Scene& other) : state_(std::make_unique<State>(*other.state_)) {}
Scene::Scene(Scene&& other) noexcept = default;
Scene& Scene::operator=(const Scene& other) {
  if (this != &other) state_ = std::make_unique<State>(*other.state_);
  return *this;
}
Scene& Scene::operator=(Scene&& other) noexcept = default;
Scene::~Scene() = default;

Scene Scene::load(const std::filesystem::path& file, const LoadOptions& options) {
  Scene scene;
  scene.state_->scene = scenes::read_scene(file, reading(options));
  return scene;
}

Scene Scene::parse(std::string_view json, const std::filesystem::path& folder, const LoadOptions& options) {
  Scene scene;
  const std::filesystem::path file = folder / "scene";
  scene.state_->scene = scenes::read_json_text(json, file, reading(options));
  scenes::check_scene(scene.state_->scene, "scene");
  return scene;
}

MeshId Scene::add_mesh(std::string name, std::span<const Vector> positions,
                       std::span<const std::array<std::uint32_t, 3>> triangles, const MeshOptions& options) {
  const std::string where = fmt::format("mesh \"{}\"", name);
  for (const double part : options.color) {
    if (!(part >= 0 && part <= 1))
      throw InputError("{}: color ({}, {}, {}): expected 0 to 1", where, options.color[0], options.color[1],
                       options.color[2]);
  }
  require_mesh(where, positions, triangles);
  scenes::Object made;
  made.name = std::move(name);
  made.color = to_glm(options.color);
  made.casts_shadow = options.casts_shadow;
  made.receives_shadow = options.receives_shadow;
  auto changed = std::make_unique<State>(*state_);
  const auto object = static_cast<std::uint32_t>(changed->scene.objects.size());
  changed->scene.objects.push_back(std::move(made));
  append(changed->scene, object, where, positions, triangles);
  settle_origin(*changed);
  changed->meshes = next_meshes();
  state_ = std::move(changed);
  return {object};
}

void Scene::set_mesh(MeshId mesh, std::span<const Vector> positions,
                     std::span<const std::array<std::uint32_t, 3>> triangles) {
  const std::string where = fmt::format("mesh \"{}\"", mesh_name(mesh));
  require_no_light(state_->scene, mesh.index, mesh_name(mesh));
  require_mesh(where, positions, triangles);
  // Object by object, so that triangles stay in the order of the objects.
  const scenes::Scene& old = state_->scene;
  auto changed = std::make_unique<State>(*state_);
  changed->scene.soup = {};
  changed->scene.looks = {};
  changed->rest.assign(old.objects.size(), std::nullopt);
  changed->scene.origin.reset();
  for (std::uint32_t object = 0; object < old.objects.size(); ++object) {
    if (object == mesh.index) {
      append(changed->scene, object, where, positions, triangles);
      changed->scene.objects[object].picture.reset();
    } else {
      if (object < state_->rest.size() && state_->rest[object]) {
        changed->rest[object] = state_->rest[object];
        changed->rest[object]->first = static_cast<std::uint32_t>(changed->scene.soup.positions.size());
      }
      copy_object(old, object, changed->scene);
    }
  }
  settle_origin(*changed);
  changed->meshes = next_meshes();
  state_ = std::move(changed);
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

namespace {

RestMesh& rest_of(Scene::State& state, std::uint32_t object) {
  state.rest.resize(state.scene.objects.size());
  std::optional<RestMesh>& rest = state.rest[object];
  if (rest) return *rest;
  const auto [first, end] = vertices_of(state.scene, object);
  const auto part = [first = first, end = end](const auto& list) {
    return std::vector(list.begin() + first, list.begin() + end);
  };
  rest = RestMesh{first, part(state.scene.soup.positions), {}};
  if (!state.scene.looks.normals.empty()) rest->normals = part(state.scene.looks.normals);
  if (!state.scene.origin) state.scene.origin = rest_center(state);
  return *rest;
}

}  // namespace

void Scene::set_transform(MeshId mesh, const Matrix& m) {
  require_no_light(state_->scene, mesh.index, mesh_name(mesh));
  const bool is_affine = m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1;
  if (!is_affine || !std::ranges::all_of(m, [](double x) { return std::isfinite(x); }))
    throw InputError("transform of mesh \"{}\": expected finite numbers, and 0 0 0 1 in the last row", mesh_name(mesh));
  const glm::dmat3 linear(m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]);  // column by column
  const glm::dvec3 offset(m[3], m[7], m[11]);
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
  // Normals turn as planes do: by the matrix of cofactors, which also a singular matrix has.
  const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                             glm::cross(linear[0], linear[1]));
  for (std::size_t i = 0; i < rest.normals.size(); ++i) {
    const glm::dvec3 turned = cofactors * glm::dvec3(rest.normals[i]);
    const double length = glm::length(turned);
    state_->scene.looks.normals[rest.first + i] = length > 0 ? glm::vec3(turned / length) : glm::vec3(0);
  }
}

void Scene::set_positions(MeshId mesh, std::span<const Vector> positions) {
  const std::string where = fmt::format("mesh \"{}\"", mesh_name(mesh));
  require_no_light(state_->scene, mesh.index, mesh_name(mesh));
  require_coordinates(positions, where);
  RestMesh& rest = rest_of(*state_, mesh.index);
  if (positions.size() != rest.positions.size())
    throw InputError("{}: {} positions; it has {}", where, positions.size(), rest.positions.size());
  state_->meshes = next_meshes();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    rest.positions[i] = to_glm(positions[i]);
    state_->scene.soup.positions[rest.first + i] = rest.positions[i];
  }
}

namespace {

/// Changes a copy of a light, and takes it if it is one.
template <typename Change>
void change_light(scenes::Scene& scene, std::string_view name, Change change) {
  scenes::AreaLight& light = scene.lights[find_named(scene.lights, name, "light")];
  scenes::AreaLight changed = light;
  change(changed);
  scenes::check_light(changed, fmt::format("light \"{}\"", name));
  light = std::move(changed);
}

void set_options(scenes::AreaLight& light, const LightOptions& options) {
  for (const double part : options.radiance) {
    if (!(part >= 0) || !std::isfinite(part))
      throw InputError("light \"{}\": radiance ({}, {}, {}): expected finite numbers from 0 on", light.name,
                       options.radiance[0], options.radiance[1], options.radiance[2]);
  }
  light.radiance = to_glm(options.radiance);
  light.two_sided = options.two_sided;
}

}  // namespace

void Scene::add_light(std::string name, const LightShape& shape, const LightOptions& options) {
  if (std::ranges::find(state_->scene.lights, name, &scenes::AreaLight::name) != state_->scene.lights.end())
    throw UsageError("the scene has a light \"{}\" already", name);
  scenes::AreaLight light;
  light.name = std::move(name);
  light.shape = to_scene(shape);
  set_options(light, options);
  scenes::check_light(light, fmt::format("light \"{}\"", light.name));
  state_->scene.lights.push_back(std::move(light));
}

void Scene::set_light(std::string_view name, const LightShape& shape) {
  const scenes::Scene& scene = state_->scene;
  const auto number = static_cast<std::uint32_t>(find_named(scene.lights, name, "light"));
  for (const scenes::Object& object : scene.objects) {
    if (object.emits == number)
      throw InputError(
          "light \"{}\" has a body, mesh \"{}\", which would stay behind: remove the light, and add another", name,
          object.name);
  }
  change_light(state_->scene, name, [&](scenes::AreaLight& light) {
    scenes::LightShape made = to_scene(shape);
    const auto* const before = std::get_if<scenes::Sphere>(&light.shape);
    auto* const after = std::get_if<scenes::Sphere>(&made);
    if (before != nullptr && after != nullptr) after->cone = before->cone;  // a spot lamp stays one
    light.shape = std::move(made);
  });
}

void Scene::set_light(std::string_view name, const LightOptions& options) {
  change_light(state_->scene, name, [&](scenes::AreaLight& light) { set_options(light, options); });
}

void Scene::remove_light(std::string_view name) {
  scenes::Scene& scene = state_->scene;
  const auto at = static_cast<std::uint32_t>(find_named(scene.lights, name, "light"));
  scene.lights.erase(scene.lights.begin() + at);
  for (scenes::Object& object : scene.objects) {
    if (object.emits && *object.emits == at) object.emits.reset();
    if (object.emits && *object.emits > at) --*object.emits;
    if (!object.lit_by) continue;
    std::erase(*object.lit_by, at);
    for (std::uint32_t& light : *object.lit_by) light -= light > at ? 1 : 0;
  }
}

std::vector<std::string> Scene::lights() const {
  std::vector<std::string> names;
  for (const scenes::AreaLight& light : state_->scene.lights) names.push_back(light.name);
  return names;
}

std::optional<LightShape> Scene::light_shape(std::string_view name) const {
  return from_scene(state_->scene.lights[find_named(state_->scene.lights, name, "light")].shape);
}

LightOptions Scene::light_options(std::string_view name) const {
  const scenes::AreaLight& light = state_->scene.lights[find_named(state_->scene.lights, name, "light")];
  return {from_glm(light.radiance), light.two_sided};
}

void Scene::set_camera(const Camera& camera) {
  const scenes::Camera made = to_scene(camera);
  scenes::check_camera(made, fmt::format("camera \"{}\"", made.name));
  if (made.height && !(*made.height > 0 && std::isfinite(*made.height)))
    throw InputError("camera \"{}\": height {}: expected a length above 0", made.name, *made.height);
  std::vector<scenes::Camera>& cameras = state_->scene.cameras;
  auto place = std::ranges::find(cameras, made.name, &scenes::Camera::name);
  if (place == cameras.end()) place = cameras.insert(cameras.end(), made);
  const scenes::Camera before = *place;
  *place = made;
  place->aspect = before.aspect;  // of a camera that was read, and is moved
  place->shift = before.shift;
  state_->camera = static_cast<std::size_t>(place - cameras.begin());
}

std::vector<Camera> Scene::cameras() const {
  std::vector<Camera> cameras;
  for (const scenes::Camera& camera : state_->scene.cameras) {
    cameras.push_back({from_glm(camera.eye), from_glm(camera.target), from_glm(camera.up), camera.vertical_fov,
                       camera.height, camera.name});
  }
  return cameras;
}

std::size_t Scene::triangle_count() const {
  return state_->scene.soup.triangles.size();
}

std::array<std::uint32_t, 2> Scene::size() const {
  return {state_->scene.width, state_->scene.height};
}

void Scene::set_size(std::uint32_t width, std::uint32_t height) {
  if (width == 0 || height == 0) throw UsageError("size {}x{}: expected at least a pixel", width, height);
  state_->scene.width = width;
  state_->scene.height = height;
}

const std::vector<std::string>& Scene::warnings() const {
  return state_->scene.warnings;
}

std::vector<std::string> Scene::save(const std::filesystem::path& file) const {
  return scenes::write_scene(state_->scene, file);
}

}  // namespace penumbra
