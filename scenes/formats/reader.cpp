// SPDX-License-Identifier: Apache-2.0
// Reads a scene of any format, and puts a studio around a scene without light or camera.

#include "scenes/formats/reader.hpp"

#include "base/error.hpp"
#include "mesh/import.hpp"
#include "mesh/unused_vertices.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/formats/gltf_reader.hpp"
#include "scenes/formats/json_meshes.hpp"
#include "scenes/formats/json_reader.hpp"
#include "scenes/formats/scenes_ahead.hpp"
#include "scenes/instances.hpp"
#include "scenes/whole_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace penumbra::scenes {
namespace {

/// Reads a mesh file as a scene of one object, without light and camera.
Scene read_mesh_file(const std::filesystem::path& file, const ReadOptions& options) {
  LightmapPlaces* const lightmap = options.lightmap;
  mesh::ImportedMesh imported =
      mesh::import_mesh(mesh::open_input(file), {.step = options.step}, {}, lightmap != nullptr);
  Scene scene;
  scene.name = file.filename().string();
  scene.soup = std::move(imported.soup);
  Object object;
  object.name = file.stem().string();
  scene.objects.push_back(std::move(object));
  scene.warnings = std::move(imported.notes);
  scene.sources = std::move(imported.sources);
  const std::size_t all = scene.soup.positions.size();
  const std::vector<std::uint32_t> kept = mesh::drop_unused_vertices(scene.soup);
  if (lightmap != nullptr) lightmap->places = places_of_kept(from_top(std::move(imported.places)), kept);
  if (!kept.empty())
    scene.warnings.push_back(
        fmt::format("left out {} vertices that no triangle uses", all - scene.soup.positions.size()));
  return scene;
}

/// Makes added domes use light samples where exact areas would need copies of many triangles (docs/instances.md), and
/// adds a warning.
void sample_added_domes(Scene& scene, const Instances& instances, StudioWish& studio) {
  const std::uint64_t triangles = triangle_count(scene, instances);
  if (instances.empty() || triangles <= kFewCopies || std::ranges::all_of(studio.lights, has_place)) return;
  studio.sampled_domes = true;
  scene.warnings.push_back(fmt::format(
      "the added dome is `sampled`: methods that support both use light samples, since for exact areas every "
      "instance would be a copy, {} triangles in all (--method edge-scatter:rows=exact computes areas)",
      triangles));
}

Scene read_at_rest(const std::filesystem::path& file, ReadOptions options) {
  options.lightmap = nullptr;
  options.instances = nullptr;
  options.ahead = nullptr;
  options.time.reset();
  return read_gltf(file, options);
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, const ReadOptions& options) {
  // Copies are made in one step, from shared meshes, so that their number is known before memory is touched. With
  // lightmap coordinates, which are read for each copy, the reader makes the copies itself.
  Instances to_copy;
  ReadOptions reading = options;
  if (options.instances == nullptr && options.lightmap == nullptr) reading.instances = &to_copy;
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  Scene scene;
  const bool is_json = extension == ".json";
  if (is_json) {
    scene = read_json(file, reading);
  } else if (extension == ".gltf" || extension == ".glb" || extension == ".fbx" || extension == ".dae") {
    scene = read_gltf(file, reading);
  } else if (extension == ".blend") {
    throw InputError("{}: a file of Blender's own; export it as glTF 2.0 (.glb), or render it by Blender's add-on",
                     file.string());
  } else {
    scene = read_mesh_file(file, options);
  }
  scene = copied(std::move(scene), std::exchange(to_copy, {}), options.bytes_per_copy);
  if (options.rest != nullptr && !scene.origin) {
    const Scene& rest = *options.rest;
    scene.origin = rest.origin ? *rest.origin : bounds_of(rest.soup.positions).middle();
  }
  StudioWish studio = options.studio;
  studio.never |= !options.needs_light;
  const bool wishes = studio.always || !studio.lights.empty() || studio.camera || !studio.fit_camera.empty();
  const bool lacks = !is_json && (scene.cameras.empty() || (scene.lights.empty() && !studio.never));
  const bool gets_floor = studio.floor && !studio.lights.empty() && scene.lights.empty() && !studio.never;
  const bool is_around = lacks || studio.always || gets_floor || std::ranges::any_of(studio.lights, has_place) ||
                         !studio.fit_camera.empty();
  if (is_around && options.instances != nullptr)  // a studio depends on the copies' exact bounds
    scene = copied(std::move(scene), std::exchange(*options.instances, {}), options.bytes_per_copy);
  if (options.instances != nullptr && !studio.lights.empty()) sample_added_domes(scene, *options.instances, studio);
  const bool has_triangles =
      !scene.soup.triangles.empty() || (options.instances != nullptr && !options.instances->empty());
  const bool has_room = std::ranges::all_of(scene.soup.positions, [](const glm::dvec3& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kLargestCoordinate;  // false for NaN
  });
  if ((lacks || wishes) && has_room && has_triangles) {
    std::optional<Scene> rest;
    if (is_around && options.rest == nullptr && options.time && scene.motion) {
      if (options.ahead != nullptr) rest = options.ahead->rest;
      if (!rest) rest = read_at_rest(file, options);
      if (options.ahead != nullptr) options.ahead->rest = rest;
    }
    put_in_studio(scene, options.rest != nullptr ? *options.rest : rest ? *rest : scene, studio);
  }
  if (options.lightmap != nullptr) options.lightmap->places.resize(scene.soup.positions.size(), kNoPlace);
  check_scene(scene, file.string(), options.needs_light,
              options.instances != nullptr ? *options.instances : Instances());
  return scene;
}

}  // namespace penumbra::scenes
