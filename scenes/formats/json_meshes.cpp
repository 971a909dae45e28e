// SPDX-License-Identifier: Apache-2.0
// Meshes of a JSON scene: from files, triangles, quads and shapes, under transforms and instances. Memory for all
// copies is required before the first is made.

#include "scenes/formats/json_meshes.hpp"

#include "base/file_error.hpp"
#include "base/memory.hpp"
#include "mesh/import.hpp"
#include "mesh/shapes/shapes.hpp"
#include "mesh/soup_memory.hpp"
#include "mesh/unused_vertices.hpp"
#include "scenes/formats/package_files.hpp"
#include "scenes/instances.hpp"
#include "scenes/light_texture.hpp"

#include <fcntl.h>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <system_error>
#include <utility>

namespace penumbra::scenes {
namespace {

using nlohmann::json;

/// A mesh with the lightmap coordinates of its positions; `places` is empty if they were not requested or do not exist.
struct SourceMesh {
  mesh::TriangleSoup soup;
  std::vector<glm::dvec2> places = {};
};

SourceMesh import_file(const SceneFile& file, const std::string& shown, const Place& place, const ReadOptions& options,
                       Scene& scene) {
  return at_place(place, [&] {
    mesh::ImportedMesh imported =
        mesh::import_mesh(file.input, {.step = options.step},
                          {.allow_outside = options.allow_outside, .lenient = options.lenient || !options.needs_light},
                          options.lightmap != nullptr);
    scene.sources.push_back(file.path);
    std::ranges::copy_if(imported.sources, std::back_inserter(scene.sources),
                         [&](const std::filesystem::path& source) { return source != file.path; });
    for (const std::string& note : imported.notes) scene.warnings.push_back(fmt::format("{}: {}", shown, note));
    return SourceMesh{std::move(imported.soup), from_top(std::move(imported.places))};
  });
}

mesh::TriangleSoup read_triangles(const json& triangles) {
  mesh::TriangleSoup soup;
  for (const json& corners : triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (std::size_t i = 0; i < 9; i += 3) {
      soup.positions.emplace_back(corners[i].get<double>(), corners[i + 1].get<double>(), corners[i + 2].get<double>());
    }
    soup.source_face.push_back(static_cast<std::uint32_t>(soup.triangles.size()));
    soup.triangles.push_back({first, first + 1, first + 2});
    soup.object.push_back(0);
  }
  return soup;
}

SourceMesh read_source(const json& mesh, const Place& place, const ReadOptions& options, Scene& scene) {
  if (options.given != nullptr) {
    const auto given = options.given->find(scene.objects.size() - 1);
    if (given != options.given->end()) return {given->second};
  }
  if (mesh.contains("triangles")) return {read_triangles(mesh["triangles"])};
  if (mesh.contains("shape")) return {at_place(place / "shape", [&] { return read_shape(mesh["shape"]); })};
  if (mesh.contains("quad")) {
    const json& quad = mesh["quad"];
    // The picture's lower left lies at the quad's first corner, halfU points right and halfV up.
    return {mesh::make_quad(read_vector(quad["center"]), read_vector(quad["halfU"]), read_vector(quad["halfV"])),
            {{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
  }
  if (mesh.contains("package")) {
    const std::string package = mesh["package"]["name"].get<std::string>();
    const std::string name = mesh["package"]["file"].get<std::string>();
    const SceneFile file = at_place(place / "package", [&] {
      mesh::InputFile opened = open_package_file(package, name);
      std::filesystem::path path = opened.name;
      return SceneFile{std::move(opened), std::move(path)};
    });
    return import_file(file, file.path.string(), place / "package", options, scene);
  }
  const std::string name = mesh["file"].get<std::string>();
  return import_file(open_scene_file(name, place / "file", options), name, place / "file", options, scene);
}

/// Returns sine and cosine of an angle in degrees; exact for multiples of 90, so that a quarter turn keeps round
/// numbers round.
std::pair<double, double> sine_cosine(double degrees) {
  const double turn = std::remainder(degrees, 360.0);
  if (turn == 0) return {0, 1};
  if (turn == 90) return {1, 0};
  if (turn == -90) return {-1, 0};
  if (std::abs(turn) == 180) return {0, -1};
  const double radians = turn * std::numbers::pi / 180;
  return {std::sin(radians), std::cos(radians)};
}

/// x' = linear · x + offset.
struct Affine {
  glm::dmat3 linear{1};
  glm::dvec3 offset{0};
};

Affine read_matrix(const json& numbers, const Place& place) {
  const auto at = [&](std::size_t row, std::size_t column) { return numbers[4 * row + column].get<double>(); };
  if (at(3, 0) != 0 || at(3, 1) != 0 || at(3, 2) != 0 || at(3, 3) != 1) {
    throw InputError("{}: the last row is {} {} {} {}; expected 0 0 0 1 (row-major, column vectors)", place.str(),
                     at(3, 0), at(3, 1), at(3, 2), at(3, 3));
  }
  Affine affine;
  for (int row = 0; row < 3; ++row) {
    const auto r = static_cast<std::size_t>(row);
    for (int column = 0; column < 3; ++column) affine.linear[column][row] = at(r, static_cast<std::size_t>(column));
    affine.offset[row] = at(r, 3);
  }
  return affine;
}

Affine read_affine(const json& transform, const Place& place) {
  if (transform.is_array()) return read_matrix(transform, place);
  Affine affine;
  if (transform.contains("scale")) {
    const json& value = transform["scale"];
    const glm::dvec3 scale = value.is_array() ? read_vector(value) : glm::dvec3(value.get<double>());
    for (int axis = 0; axis < 3; ++axis) {
      if (scale[axis] == 0) throw InputError("{}: a scale of 0 would flatten the mesh", (place / "scale").str());
      affine.linear[axis][axis] = scale[axis];
    }
  }
  if (transform.contains("rotate")) {
    const glm::dvec3 degrees = read_vector(transform["rotate"]);
    for (int axis = 0; axis < 3; ++axis) {
      const auto [sine, cosine] = sine_cosine(degrees[axis]);
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;  // rotates `next` toward `last`
      glm::dmat3 rotation(1);
      rotation[next][next] = rotation[last][last] = cosine;
      rotation[next][last] = sine;
      rotation[last][next] = -sine;
      affine.linear = rotation * affine.linear;
    }
  }
  if (transform.contains("translate")) affine.offset = read_vector(transform["translate"]);
  return affine;
}

Affine read_invertible(const json& transform, const Place& place) {
  const Affine affine = read_affine(transform, place);
  const double determinant = glm::determinant(affine.linear);
  if (determinant == 0 || !std::isfinite(determinant)) {
    throw InputError("{}: the transform's determinant is {}; it would flatten the mesh or send it to infinity",
                     place.str(), determinant);
  }
  return affine;
}

std::uint64_t instances_of(const json& mesh) {
  return mesh.contains("instances") ? mesh["instances"].size() : 1;
}

mesh::ShapeSize size_of_source(const json& mesh, const Place& place) {
  if (mesh.contains("triangles")) return {mesh["triangles"].size(), 3 * mesh["triangles"].size()};
  if (mesh.contains("shape")) return at_place(place / "shape", [&] { return size_of_shape(mesh["shape"]); });
  if (mesh.contains("quad")) return {2, 4};
  return {};
}

mesh::ShapeSize size_of_mesh(const json& mesh, const Place& place, bool shared) {
  mesh::ShapeSize size = size_of_source(mesh, place);
  if (shared) return size;
  size.triangles *= instances_of(mesh);
  size.vertices *= instances_of(mesh);
  return size;
}

/// Returns the transform of an instance: under its key, or the instance itself, which may be 16 numbers.
const json& transform_of(const json& instance, const Place& place) {
  if (!instance.is_object() || !instance.contains("transform")) return instance;
  if (instance.size() > 1)
    throw InputError("{}: expected only the key \"transform\"; found {} keys", place.str(), instance.size());
  return instance["transform"];
}

/// Replaces the mesh by a copy for each instance, one after the other. `times`: how many times the scene's reader has
/// the copies in memory; `more_bytes`: ReadOptions::bytes_per_copy.
void apply_instances(const json& instances, const Place& place, std::uint64_t times, std::uint64_t more_bytes,
                     SourceMesh& mesh) {
  const std::size_t count = instances.size(), positions = mesh.soup.positions.size(),
                    triangles = mesh.soup.triangles.size();
  if (positions * count > std::numeric_limits<std::uint32_t>::max())
    throw InputError("{}: {} instances of {} vertices are more than 2^32", place.str(), count, positions);
  at_place(place, [&] {
    require_memory(times * mesh::soup_bytes(triangles * count, positions * count) + triangles * count * more_bytes,
                   fmt::format("{} instances of {} triangles, each as a copy", count, triangles),
                   "make them fewer or smaller");
  });
  mesh::TriangleSoup all;
  all.positions.reserve(positions * count);
  all.triangles.reserve(triangles * count);
  all.object.reserve(triangles * count);
  all.source_face.reserve(triangles * count);
  for (std::size_t i = 0; i < count; ++i) {
    mesh::TriangleSoup one = mesh.soup;
    apply_transform(transform_of(instances[i], place / i), place / i, one);
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), one.positions.begin(), one.positions.end());
    for (const mesh::Triangle& t : one.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    all.object.insert(all.object.end(), one.object.begin(), one.object.end());
    all.source_face.insert(all.source_face.end(), one.source_face.begin(), one.source_face.end());
  }
  mesh.soup = std::move(all);
  const std::vector<glm::dvec2> places = mesh.places;
  for (std::size_t i = 1; i < count; ++i) mesh.places.insert(mesh.places.end(), places.begin(), places.end());
}

}  // namespace

std::vector<glm::dvec2> from_top(std::vector<glm::dvec2> places) {
  for (glm::dvec2& place : places) {
    if (place != kNoPlace) place.y = 1 - place.y;
  }
  return places;
}

std::vector<glm::dvec2> places_of_kept(std::vector<glm::dvec2> places, const std::vector<std::uint32_t>& kept) {
  if (kept.empty() || places.empty()) return places;
  std::vector<glm::dvec2> result;
  for (const std::uint32_t vertex : kept) result.push_back(places[vertex]);
  return result;
}

void require_room_for_meshes(const json& meshes, const Place& place, bool shared, std::uint64_t bytes_per_copy) {
  mesh::ShapeSize all, largest;
  std::uint64_t copies = 0;  // triangles
  std::size_t number_of_largest = 0;
  std::uint64_t most = 0;  // bytes at the moment of highest memory use
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const mesh::ShapeSize size = size_of_mesh(meshes[i], place / i, shared);
    all.triangles += size.triangles;
    all.vertices += size.vertices;
    if (!shared && meshes[i].contains("instances")) copies += size.triangles;
    // The first mesh becomes the scene's; of each other one, two copies exist until it has been appended.
    const std::uint64_t twice = i == 0 ? 0 : mesh::soup_bytes(size.triangles, size.vertices);
    most = std::max(most, mesh::soup_bytes(all.triangles, all.vertices) + twice);
    if (size.triangles <= largest.triangles) continue;
    largest = size;
    number_of_largest = i;
  }
  at_place(place, [&] {
    require_memory(
        most + copies * bytes_per_copy,
        fmt::format("a scene of {} triangles ({} of them in /meshes/{}, the largest of {}{})", all.triangles,
                    largest.triangles, number_of_largest, meshes.size(), copies > 0 ? "; each instance is a copy" : ""),
        copies > 0 ? "make its meshes smaller or its instances fewer" : "make its meshes smaller");
  });
}

SceneFile open_scene_file(const std::string& name, const Place& place, const ReadOptions& options) {
  const std::filesystem::path folder = std::filesystem::path(place.file).parent_path();
  const std::filesystem::path path = folder / name;  // an absolute name replaces the folder
  const auto missing = [&] {
    return InputError("{}: no such file \"{}\" (paths are relative to the scene file)", place.str(), name);
  };
  if (options.allow_outside) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) throw missing();
    return at_place(place, [&] { return SceneFile{mesh::open_input(path), path}; });
  }
  const std::filesystem::path home = folder.empty() ? "." : folder;
  const Descriptor opened(::open(home.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!opened.is_open()) throw_file_error(errno, place.str() + ": the scene's folder cannot be opened");
  mesh::InputBeneath file = at_place(place, [&] { return mesh::open_input_beneath(opened.get(), name, path); });
  if (file.error == EXDEV) {
    throw InputError("{}: \"{}\" leads outside the scene's folder; move it there or pass --allow-outside", place.str(),
                     name);
  }
  if (file.error == ENOENT) throw missing();
  if (file.error != 0) throw_file_error(file.error, fmt::format("{}: \"{}\"", place.str(), name));
  return {std::move(file.input), home / file.path};
}

Texture read_sky(const std::string& name, const Place& place, const ReadOptions& options, Scene& scene) {
  const SceneFile file = open_scene_file(name, place, options);
  Texture picture = at_place(place, [&] { return read_sky_picture(file.input, name, scene.warnings); });
  scene.sources.push_back(file.path);
  return picture;
}

void add_instances(const json& instances, const Place& place, mesh::TriangleSoup mesh, std::uint32_t object,
                   const Scene& scene, Instances& to) {
  const auto number = static_cast<std::uint32_t>(to.meshes.size());
  to.meshes.push_back(std::make_shared<const SharedMesh>(SharedMesh{std::move(mesh)}));
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const Affine affine = read_invertible(transform_of(instances[i], place / i), place / i);
    Instance instance{.mesh = number, .object = object, .soup_before = scene.soup.triangles.size()};
    instance.placement = {glm::dmat4(affine.linear), true};
    instance.placement.to_world[3] = glm::dvec4(affine.offset, 1);
    to.all.push_back(instance);
  }
}

glm::dvec3 read_vector(const json& value) {
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

void apply_transform(const json& transform, const Place& place, mesh::TriangleSoup& soup) {
  const Affine affine = read_invertible(transform, place);
  for (glm::dvec3& position : soup.positions) position = affine.linear * position + affine.offset;
  // A mirroring transform turns meshes inside out; as in glTF, windings are reversed to compensate.
  if (glm::determinant(affine.linear) < 0) {
    for (mesh::Triangle& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
  }
}

void apply_fit(const json& fit, const Place& place, mesh::TriangleSoup& soup) {
  glm::dvec3 low = soup.positions.front(), high = low;
  for (const glm::dvec3& position : soup.positions) {
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  if (!(high.y > low.y)) {
    throw InputError("{}: the mesh is flat along Y and cannot be made {} tall; use \"transform\"", place.str(),
                     fit["height"].dump());
  }
  const double scale = fit["height"].get<double>() / (high.y - low.y);
  const glm::dvec3 bottom((low.x + high.x) / 2, low.y, (low.z + high.z) / 2);
  const glm::dvec3 base = fit.contains("base") ? read_vector(fit["base"]) : glm::dvec3(0);
  for (glm::dvec3& position : soup.positions) position = (position - bottom) * scale + base;
}

mesh::TriangleSoup read_mesh(const json& mesh, const Place& place, const ReadOptions& options, Scene& scene) {
  if (mesh.contains("transform") && mesh.contains("instances"))
    throw InputError("{}: the keys \"transform\" and \"instances\" exclude one another; remove one", place.str());
  SourceMesh source = read_source(mesh, place, options, scene);
  mesh::TriangleSoup& soup = source.soup;
  const std::size_t all = soup.positions.size();
  const std::vector<std::uint32_t> kept = mesh::drop_unused_vertices(soup);
  source.places = places_of_kept(std::move(source.places), kept);
  if (!kept.empty())
    scene.warnings.push_back(
        fmt::format("{}: left out {} vertices that no triangle uses", place.str(), all - soup.positions.size()));
  if (mesh.contains("transform")) apply_transform(mesh["transform"], place / "transform", soup);
  if (mesh.contains("fit")) apply_fit(mesh["fit"], place / "fit", soup);
  if (mesh.contains("instances") && options.instances == nullptr)
    apply_instances(mesh["instances"], place / "instances", scene.soup.triangles.empty() ? 1 : 2,
                    options.bytes_per_copy, source);
  if (options.lightmap != nullptr) {
    source.places.resize(soup.positions.size(), kNoPlace);
    std::ranges::copy(source.places, std::back_inserter(options.lightmap->places));
  }
  const auto finite = [](const glm::dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  if (std::ranges::all_of(soup.positions, finite)) return std::move(soup);
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    for (const std::uint32_t vertex : soup.triangles[i]) {
      const glm::dvec3& p = soup.positions[vertex];
      if (finite(p)) continue;
      throw InputError("{}: a vertex of face {} is ({}, {}, {}) in world space; expected finite numbers", place.str(),
                       soup.source_face[i], p.x, p.y, p.z);
    }
  }
  return std::move(soup);
}

}  // namespace penumbra::scenes
