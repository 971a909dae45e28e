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

/// What products that join the maps of many light samples are made from.
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

/// The maps that they were made of, read back.
std::vector<float> depths_of(const maps::SampleMaps& samples, std::uint32_t size);

/// V of a texel at depth t, from the words of PenumbraEvents.
float stepped(std::span<const std::uint32_t> words, std::size_t texels, std::size_t texel, float t);

/// PenumbraEvents without compression: V at 39 places along every texel's ray, against each sample's map asked there in
/// double. Where a map's texel is not certain (a border, a surface within 10⁻⁴) nothing is compared.
Check check_penumbra_events(const render::Device& device, const Stage& stage, std::uint32_t size);

}  // namespace penumbra::selftest
