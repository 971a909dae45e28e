// SPDX-License-Identifier: Apache-2.0
// Writes a scene as JSON, GLB or OBJ. Features that the format lacks are collected, and refused or reported as
// warnings, before much is written. The scene itself is written last, after the files that it names.

#include "scenes/formats/writer.hpp"

#include "base/error.hpp"
#include "scenes/formats/writers.hpp"
#include "scenes/light_texture.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace penumbra::scenes {

std::filesystem::path texture_file(const std::filesystem::path& file, std::size_t light) {
  return file.parent_path() / fmt::format("{}-light{}.exr", file.stem().string(), light);
}

std::vector<std::filesystem::path> texture_files(const Scene& scene, const std::filesystem::path& file) {
  std::vector<std::filesystem::path> files;
  for (std::size_t i = 0; file.extension() == ".json" && i < scene.lights.size(); ++i) {
    if (scene.lights[i].texture) files.push_back(texture_file(file, i));
  }
  return files;
}

std::vector<ObjectRange> object_ranges(const mesh::TriangleSoup& soup) {
  std::vector<ObjectRange> ranges;
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    if (ranges.empty() || ranges.back().object != soup.object[i]) ranges.push_back({soup.object[i], i, 0});
    ++ranges.back().count;
  }
  return ranges;
}

void append_number(fmt::memory_buffer& text, double value) {
  if (value == 0 && std::signbit(value)) {  // "-0" would be an integer to JSON readers, which have no negative zero
    text.append(std::string_view("-0.0"));
  } else {
    fmt::format_to(std::back_inserter(text), "{}", value);
  }
}

TextStream& TextStream::number(double value) {
  append_number(buffer_, value);
  return *this;
}

TextStream& TextStream::numbers(const glm::dvec3& v, std::string_view separator) {
  number(v.x);
  buffer_.append(separator);
  number(v.y);
  buffer_.append(separator);
  return number(v.z);
}

TextStream& TextStream::array(const glm::dvec3& v) {
  print("[").numbers(v, ", ");
  return print("]");
}

void TextStream::flush() {
  file_.write(std::string_view(buffer_.data(), buffer_.size()));
  buffer_.clear();
}

/// Marks in `with` the objects with a vertex whose value is not `plain`.
template <typename Vector>
void find_objects_with(const mesh::TriangleSoup& soup, std::span<const Vector> looks, const Vector& plain,
                       std::vector<bool>& with) {
  for (std::size_t i = 0; !looks.empty() && i < soup.triangles.size(); ++i) {
    for (const std::uint32_t vertex : soup.triangles[i]) {
      if (looks[vertex] != plain) with[soup.object[i]] = true;
    }
  }
}

/// Objects with colours and with normals of vertices, whether in the soup or as instances.
struct ObjectsWith {
  std::vector<bool> colors, normals;
};
ObjectsWith objects_with(const Scene& scene, const Instances& instances) {
  const std::size_t count = scene.objects.size();
  ObjectsWith with{std::vector<bool>(count), std::vector<bool>(count)};
  find_objects_with<glm::vec4>(scene.soup, scene.looks.colors, glm::vec4(1), with.colors);
  find_objects_with<glm::vec3>(scene.soup, scene.looks.normals, glm::vec3(0), with.normals);
  std::vector<ObjectsWith> of_meshes;  // each has one object
  for (const auto& mesh : instances.meshes) {
    ObjectsWith& own = of_meshes.emplace_back(ObjectsWith{std::vector<bool>(1), std::vector<bool>(1)});
    find_objects_with<glm::vec4>(mesh->soup, mesh->colors, glm::vec4(1), own.colors);
    find_objects_with<glm::dvec3>(mesh->soup, mesh->normals, glm::dvec3(0), own.normals);
  }
  for (const Instance& instance : instances.all) {
    if (of_meshes[instance.mesh].colors[0]) with.colors[instance.object] = true;
    if (of_meshes[instance.mesh].normals[0]) with.normals[instance.object] = true;
  }
  return with;
}

/// Reports appearances that a format without surfaces cannot store.
void lose_looks(const Scene& scene, const Instances& instances, const std::string& extension, Losses& losses) {
  const ObjectsWith with = objects_with(scene, instances);
  const std::string solid =
      fmt::format("lets light through, which {} cannot store (.glb can): it would be solid", extension);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.alpha.mode != Alpha::Mode::opaque) losses.refuse(solid, object.name);
    if (object.picture) losses.mention("has a picture, which is left out", object.name);
    if (with.colors[i]) losses.mention("has colours of vertices, which are left out", object.name);
    if (with.normals[i])
      losses.mention("has normals of vertices, which are left out: it will be shaded by facets", object.name);
  }
}

std::uint64_t writer_bytes_per_triangle(const std::filesystem::path& file) {
  constexpr std::uint64_t kGlbOfTriangle = 100;  // measured on a sphere of a million triangles, and rounded down
  return file.extension() == ".glb" ? kGlbOfTriangle : 0;
}

namespace {

/// Returns whether the file will have each mesh once, and not a copy for each instance.
bool is_shared(const Scene& scene, const Instances& instances, const std::string& extension, WriteInstances use) {
  if (extension == ".obj" || use == WriteInstances::copies) return false;
  if (extension == ".glb" || use == WriteInstances::shared) return true;
  // JSON adds the offset last, as its readers do; other sums may differ in the last bit.
  return std::ranges::all_of(instances.all, [](const Instance& one) { return one.placement.offset_last; }) ||
         triangle_count(scene, instances) > kFewCopies;
}

}  // namespace

std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& file, const WriteOptions& options,
                                     const Instances& instances) {
  const std::string extension = file.extension().string();
  if (extension != ".json" && extension != ".glb" && extension != ".obj")
    throw UsageError("{}: a scene is written as .json, .glb or .obj", file.string());
  if (!instances.empty() && !is_shared(scene, instances, extension, options.instances))
    return write_scene(copied(scene, instances, writer_bytes_per_triangle(file)), file, options);
  AtomicFile output(file);
  Losses losses;
  Notes notes;
  if (extension != ".glb") lose_looks(scene, instances, extension, losses);
  if (!options.lenient) losses.throw_refused("writes");  // checked before much is written
  if (extension == ".json")
    write_json(scene, instances, output, losses, notes);
  else if (extension == ".glb")
    write_glb(scene, instances, output, losses, notes);
  else
    write_obj(scene, output, losses, notes);
  if (!options.lenient) losses.throw_refused("writes");
  // The scene is written last: once it exists, the files that it refers to exist.
  for (std::size_t i = 0; extension == ".json" && i < scene.lights.size(); ++i) {
    if (scene.lights[i].texture) write_texture(*scene.lights[i].texture, texture_file(file, i));
  }
  if (scene.motion)
    notes.push_back(fmt::format("its animation from {} s to {} s is left out; it is written at rest",
                                scene.motion->first, scene.motion->last));
  output.commit();
  losses.warn(notes);
  return notes;
}

}  // namespace penumbra::scenes
