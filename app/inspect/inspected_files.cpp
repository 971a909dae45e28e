// SPDX-License-Identifier: Apache-2.0
// Turns the arguments of `inspect` into a list of files: walks folders without following links, and looks into each
// .json for the format of scenes, since other programs use the ending as well.

#include "app/inspect/inspected_files.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

namespace penumbra::app {
namespace {

namespace fs = std::filesystem;

/// Endings of a folder's files that count as meshes. Any other file readable by the importer can be named explicitly.
constexpr std::array<std::string_view, 23> kMeshEndings = {
    ".3ds", ".3mf", ".ac",  ".amf",  ".ase", ".b3d", ".dae", ".dxf", ".fbx", ".glb", ".gltf", ".lwo",
    ".md2", ".md3", ".nff", ".ms3d", ".obj", ".off", ".ply", ".smd", ".stl", ".x",   ".x3d"};

std::string lower_ending(const fs::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return ending;
}

/// Returns whether a JSON file is a scene: its first 4 KiB name the format.
bool names_scene_format(const fs::path& file) {
  std::string start(4096, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(stream.gcount()));
  return start.find("penumbra-scene/") != std::string::npos;
}

bool is_mesh_or_scene(const fs::path& file) {
  const std::string ending = lower_ending(file);
  if (ending == ".json") return names_scene_format(file);
  return std::ranges::find(kMeshEndings, ending) != kMeshEndings.end();
}

bool is_hidden(const fs::path& file) {
  return file.filename().string().starts_with('.');
}

std::vector<fs::path> meshes_below(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  auto entry = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (is_hidden(entry->path())) {
      entry.disable_recursion_pending();
    } else if (entry->is_regular_file(ignored) && is_mesh_or_scene(entry->path())) {
      files.push_back(entry->path());
    }
  }
  if (error) throw InputError("{}: cannot be read as a folder: {}", folder.string(), error.message());
  if (files.empty())
    throw InputError(
        "{}: no mesh file is in this folder or below it (.obj, .ply, .off, .stl, .glb and others by their "
        "endings); other files can be named one by one",
        folder.string());
  std::ranges::sort(files);
  return files;
}

}  // namespace

InspectedFiles inspected_files(std::span<const fs::path> named) {
  InspectedFiles all;
  for (const fs::path& path : named) {
    std::error_code error;
    if (fs::is_directory(path, error)) {
      const std::vector<fs::path> files = meshes_below(path);
      all.files.insert(all.files.end(), files.begin(), files.end());
      all.several = true;
    } else {
      all.files.push_back(path);
    }
  }
  all.several = all.several || all.files.size() > 1;
  return all;
}

}  // namespace penumbra::app
