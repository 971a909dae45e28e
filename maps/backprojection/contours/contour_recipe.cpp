// SPDX-License-Identifier: Apache-2.0
// Assembles `contour` and `packet`: shader constants, pyramids and products from the options.

#include "maps/backprojection/contours/contour_recipe.hpp"

#include "maps/backprojection/contours/contour.comp.spv.hpp"
#include "maps/backprojection/contours/contour_sort.comp.spv.hpp"
#include "maps/backprojection/contours/contour.shared.h"
#include "maps/backprojection/contours/contour_products.hpp"
#include "maps/host/error_repairs.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/products/nearest_caster.hpp"
#include "maps/products/work_counts.hpp"

#include <bit>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::maps {
namespace {

/// Indices of cells below a root have 14 bits on the stack of contour.comp.
constexpr std::uint32_t kMostWalkedCells = 1u << 14;

}  // namespace

visibility::MeshVerdict contour_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("closed outlines of the surfaces that the light's centre sees, each treated separately", mesh);
}

visibility::ErrorRepairs contour_repairs(const visibility::MethodDescription& method,
                                         const visibility::MethodOptions& given) {
  return map_repairs(method, given,
                     {.ends_at_points = true,
                      .layers = "outlines come from the nearest surfaces; no form of the method uses more layers",
                      .fusion = "outlines that overlap are added; no form of the method joins them",
                      .gaps = "outlines are closed around connected texels: there are no gaps between them"});
}

MapRecipe contour_recipe(const render::Device& device, visibility::MethodDescription description,
                         const ContourChoices& choices, const visibility::ParsedOptions& options) {
  MapRecipe recipe{.description = std::move(description),
                   .look_up_name = "contour look-up",
                   .look_up = shaders::kContourComp,
                   .sort_out = shaders::kContourSortComp};
  recipe.whole_light = true;
  recipe.group_a_receiver = true;
  recipe.packet_width = choices.packet_width;
  recipe.packet_height = choices.packet_height;
  recipe.sub_lights = choices.sub_lights;

  // Pyramids hold nearest depths, which do not bound a shadow that begins behind a surface other than the nearest.
  const bool pyramids = options[kDepth] == DepthUse::first;
  const Search search = pyramids ? choices.search : Search::none;
  recipe.constants = {device.limits().subgroup_size, choices.levels.levels(), search == Search::none ? 0u : 1u,
                      std::bit_cast<std::uint32_t>(static_cast<float>(choices.edge_cost)),
                      std::bit_cast<std::uint32_t>(static_cast<float>(choices.area_cost))};
  const bool walks = pyramids && options[kMapSize] + 1 < kMostWalkedCells;
  const Traversal traversal = walks ? choices.traversal : Traversal::flat;

  recipe.products.push_back(std::make_unique<NearestCaster>(device));
  recipe.products.push_back(std::make_unique<ContourLightProduct>(device));
  const auto add_pyramid = [&](PyramidKind kind) {
    recipe.products.push_back(std::make_unique<DepthPyramid>(device, kind));
  };
  const auto add_same = [&](std::size_t product) {
    recipe.products.push_back(std::make_unique<SameProduct>(*recipe.products[product]));
  };
  constexpr std::size_t kUnread = 0, kSearched = 2;
  if (search == Search::none) {
    add_same(kUnread);
  } else {
    add_pyramid(pyramid_of(search));
  }
  const Search walked = traversal == Traversal::minmax ? Search::hsm : search == Search::none ? Search::mssm : search;
  if (traversal == Traversal::flat) {
    add_same(kUnread);
  } else if (search == walked) {
    add_same(kSearched);
  } else {
    add_pyramid(pyramid_of(walked));
  }
  // names of gpu::WorkNumbers, in its order
  recipe.products.push_back(std::make_unique<WorkCounts>(
      device, std::vector<std::string>{"nodes", "cells", "edges", "packetsShared", "packetsParted", "packetsDiverged",
                                       "packetsTrivial", "kernelCells"}));
  recipe.products.push_back(make_level_maps(device, choices.levels));

  gpu::ContourPush push{};
  push.packet_width = choices.packet_width;
  push.packet_height = choices.packet_height;
  push.traversal = traversal == Traversal::flat        ? gpu::kFlat
                   : traversal == Traversal::hierarchy ? gpu::kHierarchy
                                                       : gpu::kMinMax;
  push.level = choices.levels.level;
  push.budget = choices.levels.budget;
  push.blend = choices.levels.blend ? 1 : 0;
  push.divergence = static_cast<float>(choices.divergence);
  recipe.push_words = sizeof(push) / sizeof(std::uint32_t);
  recipe.push = [push](const visibility::Light&) { return push_words(push); };
  return recipe;
}

}  // namespace penumbra::maps
