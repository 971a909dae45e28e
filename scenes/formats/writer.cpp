#include "scenes/formats/writer.hpp"

#include "base/error.hpp"
#include "scenes/light_texture.hpp"
#include "scenes/formats/writers.hpp"

#include <fmt/ranges.h>

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
  if (value == 0 && std::signbit(value)) {  // "-0" is an integer to JSON readers, which have no negative zero
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

/// What no format that is written here has a place for.
void note_looks(const Scene& scene, Notes& notes) {
  std::vector<std::string> filled, pictured;
  for (const Object& object : scene.objects) {
    if (object.alpha.mode != Alpha::Mode::opaque) filled.push_back(fmt::format("\"{}\"", object.name));
    if (object.picture) pictured.push_back(fmt::format("\"{}\"", object.name));
  }
  if (!filled.empty())
    notes.push_back(
        fmt::format("alpha is left out: {} will be solid, and cast whole shadows", fmt::join(filled, ", ")));
  if (!pictured.empty()) notes.push_back(fmt::format("pictures are left out: {}", fmt::join(pictured, ", ")));
  if (!scene.looks.colors.empty()) notes.emplace_back("colours of vertices are left out");
}

std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  void (*write)(const Scene&, AtomicFile&, Notes&) = extension == ".json"  ? write_json
                                                     : extension == ".glb" ? write_glb
                                                     : extension == ".obj" ? write_obj
                                                                           : nullptr;
  if (write == nullptr) throw UsageError("{}: a scene is written as .json, .glb or .obj", file.string());
  AtomicFile output(file);
  Notes notes;
  write(scene, output, notes);
  note_looks(scene, notes);
  // The scene comes last: where it is, what it names is.
  for (std::size_t i = 0; extension == ".json" && i < scene.lights.size(); ++i) {
    if (scene.lights[i].texture) write_texture(*scene.lights[i].texture, texture_file(file, i));
  }
  if (scene.motion)
    notes.push_back(fmt::format("its animation from {} s to {} s is left out; it is written as it rests",
                                scene.motion->first, scene.motion->last));
  if (!scene.looks.normals.empty()) notes.emplace_back("normals of vertices are left out: shading will be by facets");
  output.commit();
  return notes;
}

}  // namespace penumbra::scenes
