// SPDX-License-Identifier: Apache-2.0
// Assembles `brabec-seidel` and `parker`: offsets of the search and products.

#include "maps/single_shadow/search_recipe.hpp"

#include "maps/products/depth_pyramid.hpp"
#include "maps/products/light_shape.hpp"
#include "maps/products/nearest_caster.hpp"
#include "maps/products/work_counts.hpp"
#include "maps/single_shadow/options.hpp"
#include "maps/single_shadow/search.shared.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

namespace penumbra::maps {
namespace {

/// Buffer of search_offsets on the device.
class SearchOffsets final : public MapProduct {
 public:
  SearchOffsets(const render::Device& device, std::span<const glm::ivec2> offsets)
      : offsets_(render::make_buffer<glm::ivec2>(device, "search offsets", offsets)) {}
  void record(render::Commands& /*commands*/, const MapSet& /*maps*/) override {}
  [[nodiscard]] const render::Buffer& buffer() const override { return offsets_; }

 private:
  render::Buffer offsets_;
};

}  // namespace

std::vector<glm::ivec2> search_offsets(std::uint32_t radius) {
  const int most = static_cast<int>(radius);
  std::vector<glm::ivec2> offsets;
  const auto squared = [](const glm::ivec2& at) { return at.x * at.x + at.y * at.y; };
  for (int y = -most; y <= most; ++y) {
    for (int x = -most; x <= most; ++x) {
      if (squared({x, y}) <= most * most) offsets.emplace_back(x, y);
    }
  }
  std::ranges::sort(offsets, {}, [&](const glm::ivec2& at) { return std::tuple(squared(at), at.y, at.x); });
  return offsets;
}

MapRecipe search_recipe(const render::Device& device, SearchMethod method, const visibility::ParsedOptions& parsed,
                        bool ids) {
  MapRecipe recipe{.description = std::move(method.description),
                   .look_up_name = std::move(method.look_up_name),
                   .look_up = method.look_up};
  const std::vector<glm::ivec2> offsets = search_offsets(parsed[kSearchRadius]);
  recipe.products.push_back(std::make_unique<NearestCaster>(device));
  recipe.products.push_back(std::make_unique<SearchOffsets>(device, offsets));
  recipe.products.push_back(std::make_unique<DepthPyramid>(device, PyramidKind::ysm));
  recipe.products.push_back(std::make_unique<WorkCounts>(device, std::vector<std::string>{"cutSearches"}));
  // Casters that receive nothing are searched, too, up to the distance from a receiver at which a penumbra can begin.
  recipe.beside = [](const visibility::Light& light, const LightBasis& basis) {
    return half_extent(light, basis) / half_width(light);
  };
  gpu::SearchPush push{parsed[falloff_option(method.falloff)], static_cast<std::uint32_t>(offsets.size()),
                       parsed[kSearchRadius], 0, ids ? 1U : 0U};
  recipe.push_words = sizeof(push) / sizeof(std::uint32_t);
  recipe.push = [push](const visibility::Light& light) {
    gpu::SearchPush own = push;
    own.light = static_cast<float>(half_width(light));
    return push_words(own);
  };
  return recipe;
}

}  // namespace penumbra::maps
