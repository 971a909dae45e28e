// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"
#include "maps/products/lists/sample_maps.hpp"
#include "render/device.hpp"
#include "selftest/check.hpp"
#include "selftest/small_scenes.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::selftest {

/// Input of products that join the maps of many light samples.
struct ListSource {
  ListSource(const render::Device& device, const Stage& s, std::uint32_t size);
  const Stage& stage;
  maps::LightBasis basis;
  maps::CasterMaps casters;
  maps::FittedViews centre;
  visibility::PassTimes times;
  std::map<std::string, std::uint64_t> counters;
  std::optional<maps::MapSource> source;
};

/// Returns the maps from which lists were made, read back.
std::vector<float> depths_of(const maps::SampleMaps& samples, std::uint32_t size);

/// Returns V of a texel at depth t, from the words of PenumbraEvents.
float stepped(std::span<const std::uint32_t> words, std::size_t texels, std::size_t texel, float t);

/// Compares PenumbraEvents without compression: V at 39 positions along every texel's ray, with each sample's map
/// evaluated there in double. Positions where a map's texel is uncertain (a border, a surface within 10⁻⁴) are skipped.
Check check_penumbra_events(const render::Device& device, const Stage& stage, std::uint32_t size);

}  // namespace penumbra::selftest
