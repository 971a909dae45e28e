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
  // The scene comes last: where it is, what it names is.
  for (std::size_t i = 0; extension == ".json" && i < scene.lights.size(); ++i) {
    if (scene.lights[i].texture) write_texture(*scene.lights[i].texture, texture_file(file, i));
  }
  output.commit();
  return notes;
}

}  // namespace penumbra::scenes
