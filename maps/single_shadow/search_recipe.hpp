#pragma once

#include "maps/host/map_method.hpp"

#include <glm/vec2.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace penumbra::maps {

/// Offsets of at most `radius` texels, the shortest first; of equally long ones in a fixed order.
std::vector<glm::ivec2> search_offsets(std::uint32_t radius);

/// How one of the methods that search a map is made: description, falloff of its own, and its look-up.
struct SearchMethod {
  visibility::MethodDescription description;
  std::uint32_t falloff;
  std::string look_up_name;
  std::span<const std::uint32_t> look_up;
};
/// `ids`: what is of the receiver's own object shades nothing of it; the recipe's last product are then triangles' ids.
MapRecipe search_recipe(const render::Device& device, SearchMethod method, const visibility::ParsedOptions& parsed,
                        bool ids);

}  // namespace penumbra::maps
