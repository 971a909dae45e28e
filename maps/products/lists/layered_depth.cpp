// SPDX-License-Identifier: Apache-2.0
// Builds layered depth images: warps the maps of light samples to the light's centre and merges them (Agrawala et al.
// 2000).

#include "maps/products/lists/layered_depth.hpp"

#include "base/error.hpp"
#include "maps/products/lists/layered_depth.shared.h"
#include "maps/products/lists/layered_merge.comp.spv.hpp"
#include "maps/products/lists/layered_warp.comp.spv.hpp"
#include "visibility/receivers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::maps {
namespace {

std::uint64_t groups_of(std::uint64_t texels) {
  return (texels + gpu::kLookupGroup - 1) / gpu::kLookupGroup;
}

}  // namespace

LayeredDepth::LayeredDepth(const render::Device& device, double epsilon, Rasteriser rasteriser)
    : device_(&device),
      epsilon_(epsilon),
      rasteriser_(rasteriser),
      samples_(device),
      warp_(device, {.name = "warp maps",
                     .spirv = shaders::kLayeredWarpComp,
                     .push_bytes = sizeof(gpu::WarpPush),
                     .constants = {}}),
      merge_(device, {.name = "merge layers",
                      .spirv = shaders::kLayeredMergeComp,
                      .push_bytes = sizeof(gpu::MergePush),
                      .constants = {}}) {}

void LayeredDepth::make(const MapSource& source) {
  samples_.make(source);
  make_others(source);
  render::grow(*device_, centre_, "centre's view", sizeof(gpu::LightView));
  centre_->write<gpu::LightView>(std::span(&source.centre, 1));
  for (auto* word : {&node_count_, &most_}) render::grow(*device_, *word, "layer counter", sizeof(std::uint32_t));
  const std::uint64_t texels = std::max<std::uint64_t>(std::uint64_t{source.faces} * source.size * source.size, 1);
  render::grow(*device_, heads_, "layer lists", texels * sizeof(std::uint32_t));
  render::grow(*device_, counts_, "layer counts", texels * sizeof(std::uint32_t));
  layers_ = 4;
  node_capacity_ = 2 * texels;
  for (;;) {
    const std::uint64_t bytes = texels * layers_ * sizeof(gpu::LayerEntry);
    if (bytes > device_->limits().max_storage_buffer_range) {
      const double fits =
          std::sqrt(static_cast<double>(device_->limits().max_storage_buffer_range) /
                    static_cast<double>(std::uint64_t{source.faces} * layers_ * sizeof(gpu::LayerEntry)));
      throw ResourceError(
          "layered-attenuation: {} layers a texel do not fit into one buffer of {}; take size={} or less, or a larger "
          "epsilon",
          layers_, device_->info().name, std::max(8u, static_cast<std::uint32_t>(fits)));
    }
    render::grow(*device_, entries_, "layers", bytes);
    render::grow(*device_, nodes_, "layer nodes", node_capacity_ * sizeof(gpu::LayerNode));
    if (merge_all(source)) break;
  }
  source.counters["layers"] = layers_;
}

void LayeredDepth::make_others(const MapSource& source) {
  std::vector<std::uint8_t> drawn_alone(source.scene.casts_shadow.size());
  for (std::uint32_t i = 0; i < drawn_alone.size(); ++i) {
    const bool has_area = source.scene.plane[i] != visibility::SceneFloats::kNoPlane;
    const bool receives = has_area && visibility::is_receiver(source.scene, source.light, i);
    drawn_alone[i] = receives && source.scene.casts_shadow[i] == 0 ? 1 : 0;
  }
  others_.reset();
  if (std::ranges::count(drawn_alone, 1) == 0) return;
  visibility::SceneFloats others = source.scene;
  others.casts_shadow = std::move(drawn_alone);
  CasterMaps drawn(*device_, source.size, rasteriser_);
  drawn.upload(others);
  std::map<std::string, std::uint64_t> counted;  // counters of the casters' maps
  others_.emplace(*device_).make({source.scene, source.light, source.basis, drawn, source.centre, source.faces,
                                  source.size, source.bias, source.times, counted});
}

bool LayeredDepth::merge_all(const MapSource& source) {
  if (source.faces == 0) return true;
  const std::uint32_t texels = source.faces * source.size * source.size;
  const std::uint64_t sample_texels = std::uint64_t{samples_.faces()} * source.size * source.size;
  render::Commands commands(*device_);
  commands.fill(*counts_, 0);
  commands.fill(*most_, 0);
  commands.fill(*entries_, 0);
  const std::vector<SampleMaps::Part> parts = samples_.parts(), of_others = others_ ? others_->parts() : parts;
  for (std::size_t number = 0; number < parts.size(); ++number) {
    const SampleMaps::Part& part = parts[number];
    for (std::uint32_t k = 0; k < part.count; ++k) {
      commands.fill(*heads_, 0);
      commands.fill(*node_count_, 0);
      const gpu::WarpPush warp{.basis = source.basis.rounded(),
                               .size = source.size,
                               .point = part.first + k,
                               .first_map = k * samples_.faces(),
                               .faces = source.faces,
                               .sample_faces = samples_.faces(),
                               .node_capacity = static_cast<std::uint32_t>(node_capacity_),
                               .epsilon = static_cast<float>(epsilon_)};
      const auto record_warp = [&](const render::Buffer& maps) {
        warp_.record(commands, warp, {*centre_, samples_.views(), maps, *heads_, *nodes_, *node_count_, *part.maps},
                     groups_of(sample_texels));
      };
      record_warp(*part.maps);
      if (others_) record_warp(*of_others[number].maps);
      const gpu::MergePush merge{texels, layers_, part.first + k, static_cast<float>(epsilon_)};
      merge_.record(commands, merge, {*heads_, *nodes_, samples_.weights(), *counts_, *entries_, *most_},
                    groups_of(texels));
      source.times.add(commands.submit());
      std::uint32_t nodes = 0;
      node_count_->read<std::uint32_t>(std::span(&nodes, 1));
      if (nodes > node_capacity_) {
        node_capacity_ = std::uint64_t{nodes} + nodes / 2;
        return false;
      }
    }
  }
  std::uint32_t most = 0;
  most_->read<std::uint32_t>(std::span(&most, 1));
  if (most <= layers_) return true;
  layers_ *= 2;
  return false;
}

std::uint64_t LayeredDepth::memory_bytes() const {
  std::uint64_t bytes = samples_.memory_bytes() + (others_ ? others_->memory_bytes() : 0);
  for (const auto* buffer : {&centre_, &heads_, &nodes_, &node_count_, &counts_, &entries_, &most_})
    bytes += *buffer ? (*buffer)->bytes() : 0;
  return bytes;
}

}  // namespace penumbra::maps
