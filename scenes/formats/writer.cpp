#include "scenes/formats/writer.hpp"

#include "base/error.hpp"
#include "scenes/light_texture.hpp"
#include "scenes/formats/writers.hpp"

#include <cmath>

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

/// Returns for each object whether one of its vertices has a value other than `plain` in `looks`.
template <typename Vector>
std::vector<bool> objects_with(const Scene& scene, const std::vector<Vector>& looks, const Vector& plain) {
  std::vector<bool> with(scene.objects.size());
  for (std::size_t i = 0; !looks.empty() && i < scene.soup.triangles.size(); ++i) {
    for (const std::uint32_t vertex : scene.soup.triangles[i]) {
      if (looks[vertex] != plain) with[scene.soup.object[i]] = true;
    }
  }
  return with;
}

/// Reports appearances that a format without surfaces cannot store.
void lose_looks(const Scene& scene, const std::string& extension, Losses& losses) {
  const std::vector<bool> colored = objects_with(scene, scene.looks.colors, glm::vec4(1));
  const std::vector<bool> smooth = objects_with(scene, scene.looks.normals, glm::vec3(0));
  const std::string solid =
      fmt::format("lets light through, for which {} has no place (.glb has): it would be solid", extension);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.alpha.mode != Alpha::Mode::opaque) losses.refuse(solid, object.name);
    if (object.picture) losses.mention("has a picture, which is left out", object.name);
    if (colored[i]) losses.mention("has colours of vertices, which are left out", object.name);
    if (smooth[i])
      losses.mention("has normals of vertices, which are left out: its shading will be by facets", object.name);
  }
}

std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& file,
                                     const WriteOptions& options) {
  const std::string extension = file.extension().string();
  void (*write)(const Scene&, AtomicFile&, Losses&, Notes&) = extension == ".json"  ? write_json
                                                              : extension == ".glb" ? write_glb
                                                              : extension == ".obj" ? write_obj
                                                                                    : nullptr;
  if (write == nullptr) throw UsageError("{}: a scene is written as .json, .glb or .obj", file.string());
  AtomicFile output(file);
  Losses losses;
  Notes notes;
  if (extension != ".glb") lose_looks(scene, extension, losses);
  if (!options.lenient) losses.throw_refused("writes");  // checked before much is written
  write(scene, output, losses, notes);
  if (!options.lenient) losses.throw_refused("writes");
  // The scene is written last: once it exists, the files that it refers to exist.
  for (std::size_t i = 0; extension == ".json" && i < scene.lights.size(); ++i) {
    if (scene.lights[i].texture) write_texture(*scene.lights[i].texture, texture_file(file, i));
  }
  if (scene.motion)
    notes.push_back(fmt::format("its animation from {} s to {} s is left out; it is written as it rests",
                                scene.motion->first, scene.motion->last));
  output.commit();
  losses.warn(notes);
  return notes;
}

}  // namespace penumbra::scenes
