// SPDX-License-Identifier: Apache-2.0
// Judges the extensions that a file uses: understood, without effect on diffuse surfaces and lights, or a loss. An
// unknown extension that the file requires is refused, unless losses are allowed (--lenient).

#include "import/gltf/gltf_extensions.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace penumbra::import {
namespace {

constexpr std::array<std::string_view, 12> kUnderstood{
    "EXT_mesh_gpu_instancing",
    "KHR_animation_pointer",  // targets that are not supported are reported individually
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_transmission",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
    "KHR_texture_basisu",  // pictures that cannot be read are reported with their objects
};

/// Extensions that change no diffuse surface and no light. Without KHR_materials_variants the file's default materials
/// remain, and without MSFT_lod the mesh of the finest level.
constexpr std::array<std::string_view, 36> kWithoutEffect{
    "AGI_articulations",
    "AGI_stk_metadata",
    "CESIUM_primitive_outline",
    "EXT_instance_features",
    "EXT_mesh_features",
    "EXT_structural_metadata",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "FB_ngon_encoding",
    "KHR_accessor_float64",
    "KHR_audio",
    "KHR_audio_emitter",
    "KHR_implicit_shapes",
    "KHR_interactivity",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics_rigid_bodies",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_lod",
    "MSFT_packing_normalRoughnessMetallic",
    "MSFT_packing_occlusionRoughnessMetallic",
    "MSFT_texture_dds",
    "VRM",
    "VRMC_materials_mtoon",
    "VRMC_vrm",
};

/// Extensions that change the lighting and are not supported, with their effects.
constexpr std::array<std::pair<std::string_view, const char*>, 3> kLight{{
    {"EXT_lights_ies", "shapes the light of lamps, which is not supported"},
    {"EXT_lights_image_based", "lights the scene from all around, which is not supported"},
    {"KHR_environment_map", "lights the scene from all around, which is not supported"},
}};

/// Returns the unsupported effect on the lighting; null for an extension without one.
const char* light_of(const std::string& extension) {
  const auto found = std::ranges::find(kLight, extension, &std::pair<std::string_view, const char*>::first);
  return found == kLight.end() ? nullptr : found->second;
}

bool is_known(const std::string& extension) {
  const auto is_in = [&](const auto& list) { return std::ranges::find(list, extension) != list.end(); };
  return is_in(kUnderstood) || is_in(kWithoutEffect) || light_of(extension) != nullptr;
}

}  // namespace

void judge_extensions(const tinygltf::Model& model, bool as_mesh, scenes::Losses& losses,
                      std::vector<std::string>& warnings) {
  for (const std::string& extension : model.extensionsRequired) {
    if (!is_known(extension))
      losses.refuse("is an extension that the file requires (extensionsRequired) and that is not supported", extension);
  }
  std::string ignored;
  for (const std::string& extension : model.extensionsUsed) {
    const bool required = std::ranges::find(model.extensionsRequired, extension) != model.extensionsRequired.end();
    if (const char* const light = light_of(extension); light != nullptr && !as_mesh)
      losses.refuse(fmt::format("is an extension that {}", light), extension);
    else if (!is_known(extension) && (!required || as_mesh))
      ignored += (ignored.empty() ? "" : ", ") + extension;
  }
  if (!ignored.empty()) warnings.push_back("extensions ignored: " + ignored);
}

}  // namespace penumbra::import
