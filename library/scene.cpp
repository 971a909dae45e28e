// SPDX-License-Identifier: Apache-2.0
// Scene of the public interface: reading, writing, lights and cameras. Each change is checked as a file's content is.

#include "base/error.hpp"
#include "library/as_error.hpp"
#include "library/library_progress.hpp"
#include "library/light_shape.hpp"
#include "library/mesh_arrays.hpp"
#include "library/named.hpp"
#include "library/scene_objects.hpp"
#include "library/scene_state.hpp"
#include "mesh/input_file.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/formats/json_reader.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/formats/writer.hpp"
#include "scenes/light_texture.hpp"
#include "session/pictures/request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
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
  if (camera.aperture != 0) made.lens = {camera.aperture, camera.focus_distance};
  return made;
}

scenes::ReadOptions reading(const LoadOptions& options) {
  scenes::ReadOptions read;
  read.allow_outside = options.allow_outside;
  read.lenient = options.lenient;
  read.lamp_radius = options.lamp_radius;
  read.sun_angle = options.sun_angle;
  read.lumens_per_watt = options.lumens_per_watt;
  read.clips = options.clips;
  read.studio.always = options.studio;
  if (options.frame) {
    if (!(options.fps > 0)) throw UsageError("fps {}: expected frames a second, above 0", options.fps);
    read.time = *options.frame * (1 / options.fps);  // as on the command line
  }
  return read;
}

/// Calls `read` with options that report progress to the calling program's function, and end on its request.
template <typename Read>
void read_watched(const LoadOptions& options, const Read& read) {
  const RendererOptions host{.progress = options.progress};
  LibraryProgress progress(host);
  const std::function<void()> step = [&] { progress.begin("reading", 1); };
  try {
    scenes::ReadOptions given = reading(options);
    if (options.progress) given.step = &step;
    read(given);
  } catch (...) {
    progress.rethrow();
    throw_as_error();
  }
}

std::unique_ptr<Scene::State> empty_state() {
  auto state = std::make_unique<Scene::State>();
  state->scene.name = "scene";
  return state;
}

}  // namespace

Scene::Scene() : state_(empty_state()) {}
Scene::Scene(const Scene& other) : state_(std::make_unique<State>(*other.state_)) {}
Scene::Scene(Scene&& other) noexcept : state_(std::exchange(other.state_, empty_state())) {}
Scene& Scene::operator=(const Scene& other) {
  if (this != &other) state_ = std::make_unique<State>(*other.state_);
  return *this;
}
Scene& Scene::operator=(Scene&& other) noexcept {
  if (this != &other) state_ = std::exchange(other.state_, empty_state());
  return *this;
}
Scene::~Scene() = default;

Scene Scene::load(const std::filesystem::path& file, const LoadOptions& options) {
  if (!options.arrays.empty())
    throw UsageError("arrays are for a text (Scene::parse), and {} is a file", file.string());
  Scene scene;
  read_watched(options, [&](scenes::ReadOptions read) {
    read.instances = &scene.state_->instances;
    read.bytes_per_copy = session::bytes_per_copy({}, {});
    scene.state_->scene = scenes::read_scene(file, read);
    adopt_instances(*scene.state_);
  });
  scene.state_->file_origin = scene.state_->scene.origin;
  return scene;
}

Scene Scene::parse(std::string_view json, const std::filesystem::path& folder, const LoadOptions& options) {
  Scene scene;
  State& state = *scene.state_;
  const std::filesystem::path file = folder / "scene";
  const auto place_of = [&](const MeshArrays& mesh) { return fmt::format("{}: /meshes/{}", file.string(), mesh.mesh); };
  read_watched(options, [&](scenes::ReadOptions read) {
    std::map<std::size_t, mesh::TriangleSoup> soups;
    std::vector<GivenVertices> vertices;
    std::vector<std::string> warnings;
    for (const MeshArrays& mesh : options.arrays) {
      GivenMesh given = given_mesh(place_of(mesh), mesh.positions, mesh.triangles);
      if (!soups.emplace(mesh.mesh, std::move(given.soup)).second)
        throw UsageError("{}: arrays are given twice", place_of(mesh));
      vertices.push_back(std::move(given.vertices));
      if (!given.warning.empty()) warnings.push_back(std::move(given.warning));
    }
    if (!soups.empty()) read.given = &soups;
    read.instances = &state.instances;
    state.scene = scenes::read_json_text(json, file, read);
    for (std::size_t i = 0; i < options.arrays.size(); ++i) {
      const MeshArrays& mesh = options.arrays[i];
      if (mesh.mesh >= state.scene.objects.size())
        throw UsageError("{}: the scene has {} meshes", place_of(mesh), state.scene.objects.size());
      note_given(state, mesh.mesh, std::move(vertices[i]));
    }
    std::ranges::move(warnings, std::back_inserter(state.scene.warnings));
    scenes::check_scene(state.scene, "scene", true, state.instances);
    adopt_instances(state);
  });
  return scene;
}

namespace {

/// Changes a copy of a light, and replaces the light if the copy is valid.
template <typename Change>
void change_light(scenes::Scene& scene, std::string_view name, Change change) {
  scenes::AreaLight& light = scene.lights[find_named(scene.lights, name, "light")];
  scenes::AreaLight changed = light;
  change(changed);
  scenes::check_light(changed, fmt::format("light \"{}\"", name));
  light = std::move(changed);
}

/// Sets a light's shape; reads a dome's picture unless the light already has this picture, and adds its warnings.
void set_shape(scenes::AreaLight& light, scenes::LightShape shape, std::vector<std::string>& warnings) {
  const auto* const before = std::get_if<scenes::Dome>(&light.shape);
  const auto* const after = std::get_if<scenes::Dome>(&shape);
  const bool same = before != nullptr && after != nullptr && before->image == after->image;
  if ((before != nullptr || after != nullptr) && !same) light.texture.reset();
  if (after != nullptr && !after->image.empty() && !same)
    light.texture =
        with_errors([&] { return scenes::read_sky_picture(mesh::open_input(after->image), after->image, warnings); });
  light.shape = std::move(shape);
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
  std::vector<std::string> warnings;
  set_shape(light, to_scene(shape), warnings);
  set_options(light, options);
  scenes::check_light(light, fmt::format("light \"{}\"", light.name));
  reserve_more(state_->scene.warnings, warnings.size());
  state_->scene.lights.push_back(std::move(light));
  std::ranges::move(warnings, std::back_inserter(state_->scene.warnings));
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
  std::vector<std::string> warnings;
  change_light(state_->scene, name, [&](scenes::AreaLight& light) {
    scenes::LightShape made = to_scene(shape);
    const auto* const before = std::get_if<scenes::Sphere>(&light.shape);
    auto* const after = std::get_if<scenes::Sphere>(&made);
    if (before != nullptr && after != nullptr) after->cone = before->cone;  // a spot lamp stays a spot lamp
    set_shape(light, std::move(made), warnings);
    reserve_more(state_->scene.warnings, warnings.size());
  });
  std::ranges::move(warnings, std::back_inserter(state_->scene.warnings));
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
  // The public Camera has neither aspect nor shift: a camera that was read from a file keeps both when it is moved.
  place->aspect = before.aspect;
  place->shift = before.shift;
  state_->camera = static_cast<std::size_t>(place - cameras.begin());
}

std::vector<Camera> Scene::cameras() const {
  std::vector<Camera> cameras;
  for (const scenes::Camera& camera : state_->scene.cameras) {
    cameras.push_back({from_glm(camera.eye), from_glm(camera.target), from_glm(camera.up), camera.vertical_fov,
                       camera.height, camera.name, camera.lens ? camera.lens->radius : 0,
                       camera.lens ? camera.lens->focus_distance : 0});
  }
  return cameras;
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
  return with_errors([&] { return scenes::write_scene(state_->scene, file, {}, state_->instances); });
}

}  // namespace penumbra
