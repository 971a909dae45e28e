#pragma once

#include "maps/backprojection/level_options.hpp"
#include "maps/host/map_method.hpp"
#include "maps/products/depth_pyramid.hpp"
#include "visibility/method.hpp"

#include <cstdint>

namespace penumbra::maps {

/// How the texels of a kernel are looked through for contours; the contours are the same.
enum class Traversal : std::uint8_t {
  flat,       ///< cell by cell
  hierarchy,  ///< below the smallest node of a multi-scale pyramid over the kernel (Yang et al. 2009)
  minmax,     ///< below the root of a min-max pyramid, leaving out only what shades nothing (Dmitriev, Uralsky 2007)
};

struct ContourChoices {
  Search search = Search::none;
  Traversal traversal = Traversal::flat;
  std::uint32_t packet_width = 1, packet_height = 1;
  double divergence = 1;
  double edge_cost = 1, area_cost = 1;  ///< of an edge and of its area, beside a node (Yang et al. 2009, equation 6)
  std::uint32_t sub_lights = 1;         ///< along each of the light's axes
  LevelChoice levels{};
};

visibility::MeshVerdict contour_verdict(const mesh::Diagnosis& mesh);

/// What repairs each cause of error: MethodDescription::repairs.
visibility::ErrorRepairs contour_repairs(const visibility::MethodDescription& method,
                                         const visibility::MethodOptions& given);

/// What `contour` and `packet` are made of: contour.comp and its products.
MapRecipe contour_recipe(const render::Device& device, visibility::MethodDescription description,
                         const ContourChoices& choices, const visibility::ParsedOptions& options);

}  // namespace penumbra::maps
