#include "scenes/formats/reader.hpp"

#include "base/error.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/formats/gltf_reader.hpp"
#include "scenes/formats/json_reader.hpp"

#include <algorithm>
#include <string>

namespace penumbra::scenes {

Scene read_scene(const std::filesystem::path& file, const ReadOptions& options) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  Scene scene;
  if (extension == ".json") {
    scene = read_json(file, options);
  } else if (extension == ".gltf" || extension == ".glb") {
    scene = read_gltf(file, options);
  } else {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) throw InputError("{}: no such file", file.string());
    if (extension == ".blend")
      throw InputError("{}: a file of Blender's own; export it as glTF 2.0 (.glb), or render it by Blender's add-on",
                       file.string());
    throw InputError(
        "{}: a scene is a .json (penumbra-scene/1), .gltf or .glb file; a mesh becomes a scene when a "
        ".json names it as \"file\"",
        file.string());
  }
  check_scene(scene, file.string(), options.needs_light);
  return scene;
}

}  // namespace penumbra::scenes
