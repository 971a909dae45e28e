// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/backprojection/level_options.hpp"
#include "maps/host/map_method.hpp"
#include "maps/products/depth_pyramid.hpp"
#include "visibility/method.hpp"

#include <cstdint>

namespace penumbra::maps {

/// Search for contours among the texels of a kernel; the contours found are the same.
enum class Traversal : std::uint8_t {
  flat,       ///< cell by cell
  hierarchy,  ///< below the smallest node of a multi-scale pyramid that contains the kernel (Yang et al. 2009)
  minmax,     ///< below the root of a min-max pyramid, skipping only nodes that shade nothing (Dmitriev, Uralsky 2007)
};

struct ContourChoices {
  Search search = Search::none;
  Traversal traversal = Traversal::flat;
  std::uint32_t packet_width = 1, packet_height = 1;
  double divergence = 1;
  double edge_cost = 1, area_cost = 1;  ///< cost of an edge and of its area, relative to a node (Yang et al. 2009,
                                        ///< equation 6)
  std::uint32_t sub_lights = 1;         ///< number along each of the light's axes
  LevelChoice levels{};
};

visibility::MeshVerdict contour_verdict(const mesh::Diagnosis& mesh);

/// Returns the repair of each cause of error: MethodDescription::repairs.
visibility::ErrorRepairs contour_repairs(const visibility::MethodDescription& method,
                                         const visibility::MethodOptions& given);

/// Returns the recipe of `contour` and `packet`: contour.comp and its products.
MapRecipe contour_recipe(const render::Device& device, visibility::MethodDescription description,
                         const ContourChoices& choices, const visibility::ParsedOptions& options);

}  // namespace penumbra::maps
