// SPDX-License-Identifier: Apache-2.0
#include "import/gltf/gltf_import.hpp"

#include "base/error.hpp"
#include "import/gltf/gltf_animation.hpp"
#include "import/gltf/gltf_clips.hpp"
#include "import/gltf/gltf_hidden.hpp"
#include "import/gltf/gltf_load.hpp"
#include "import/gltf/gltf_scene.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::import {
namespace {

/// Returns whether anything but nodes moves vertices.
bool bends(const tinygltf::Model& model) {
  const auto morphs = [](const tinygltf::Mesh& mesh) {
    return std::ranges::any_of(mesh.primitives, [](const auto& primitive) { return !primitive.targets.empty(); });
  };
  return !model.skins.empty() || std::ranges::any_of(model.meshes, morphs);
}

/// Returns the time span of the played animations. A scene at rest does not show them, so that their faults are only
/// warned of.
std::optional<scenes::Motion> motion_for(const tinygltf::Model& model, const ClipChoice& clips,
                                         const scenes::ReadOptions& options, std::vector<std::string>& warnings) {
  if (options.time && !clips.others.empty()) {
    warnings.push_back(fmt::format("the clips {} move what {} moves, too, and are not played (--clip chooses)",
                                   names_of_clips(model, clips.others), names_of_clips(model, clips.played)));
  }
  try {
    return motion_of(model, clips.played);
  } catch (const InputError& error) {
    if (options.time) throw;
    warnings.push_back(fmt::format("the animation is damaged and ignored: {}", error.what()));
    return std::nullopt;
  }
}

scenes::Scene import_for(Purpose purpose, const mesh::InputFile& input, const scenes::ReadOptions& options) {
  tinygltf::Model model;
  const TakenOut taken_out = load_gltf_model(input, options, model);
  const std::string name = input.name.filename().string();
  try {
    std::vector<std::string> warnings;
    const ClipChoice clips = choose_clips(model, options.clips);
    const std::optional<scenes::Motion> motion = motion_for(model, clips, options, warnings);
    std::optional<glm::dvec3> origin;
    if (bends(model) || (motion && options.time)) origin = middle_at_rest(model, {name, options});
    const auto scales = rest_scales(model);
    if (options.time) pose_model(model, *options.time, clips.played);
    const std::vector<std::size_t> played = options.time ? clips.played : std::vector<std::size_t>();
    std::vector<std::optional<glm::dmat4>> unhidden;
    if (motion) unhidden = unhidden_places(model, scales);
    if (!model.animations.empty() && (purpose == Purpose::any_scene || purpose == Purpose::mesh))
      warnings.push_back("the file is read at rest; its animation clips are " +
                         names_of_clips(model, all_clips(model)));
    auto [scene, left_vertices_out] = build_scene(model, {name, options, unhidden, played}, purpose, taken_out);
    if (!origin && left_vertices_out && purpose != Purpose::mesh) origin = middle_at_rest(model, {name, options});
    scene.origin = origin;
    scene.motion = motion;
    scene.warnings.insert(scene.warnings.begin(), warnings.begin(), warnings.end());
    return std::move(scene);
  } catch (const InputError& error) {
    throw InputError("{}: {}", input.name.string(), error.what());  // places alone do not identify the file
  }
}

}  // namespace

scenes::Scene import_gltf(const mesh::InputFile& input, const scenes::ReadOptions& options) {
  return import_for(options.needs_light ? Purpose::lit_scene : Purpose::any_scene, input, options);
}

mesh::ImportedMesh import_gltf_mesh(const mesh::InputFile& input, const scenes::ReadOptions& options) {
  scenes::Scene scene = import_for(Purpose::mesh, input, options);
  mesh::ImportedMesh mesh{std::move(scene.soup), std::move(scene.warnings), {}};
  // Makes one object, whose faces are numbered consecutively.
  std::uint32_t number = 0;
  for (std::uint32_t& face : mesh.soup.source_face) face = number++;
  std::ranges::fill(mesh.soup.object, 0u);
  return mesh;
}

bool is_gltf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension == ".gltf" || extension == ".glb";
}

}  // namespace penumbra::import
