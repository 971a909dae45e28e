// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"

#include <glm/vec2.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace penumbra::maps {

/// Returns the offsets of at most `radius` texels, the shortest first; equally long ones in a fixed order.
std::vector<glm::ivec2> search_offsets(std::uint32_t radius);

/// Method that searches a map: description, default falloff, and its look-up.
struct SearchMethod {
  visibility::MethodDescription description;
  std::uint32_t falloff;
  std::string look_up_name;
  std::span<const std::uint32_t> look_up;
};
/// Returns the recipe. `ids`: surfaces of the receiver's own object do not shade the receiver; the recipe's last
/// product then holds the ids of triangles.
MapRecipe search_recipe(const render::Device& device, SearchMethod method, const visibility::ParsedOptions& parsed,
                        bool ids);

}  // namespace penumbra::maps
