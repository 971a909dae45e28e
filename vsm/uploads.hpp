#pragma once

#include "visibility/tree/tree_texels.hpp"
#include "visibility/lights/device_light.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "visibility/view_samples.hpp"
#include "vsm/closed_parts.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::vsm {

using visibility::Texel;

/// A plane's number shares its word with a closed part's.
inline constexpr std::uint32_t kPartShift = 27;

/// For each triangle the closed part that it is of, to be OR-ed to the number of its plane; empty: there is no part.
std::vector<std::uint32_t> part_tags(const ClosedParts& closed);

/// Writes into each child's second texel the closed part to whose outside all triangles below are dispensable, or 0.
void mark_dispensable(const visibility::TriangleTree& tree, std::span<const std::uint8_t> dispensable,
                      std::span<Texel> nodes);

/// Seven boxes of two texels a part: itself, and what touches each face.
std::vector<Texel> part_texels(const ClosedParts& closed, float scale);

/// The shaders' table of light samples: uint first_point[257], then (s, t) of each, sorted by t, so that a triangle
/// looks at one stretch of them. Rows are computed, not read: their table is empty and their order the light samples'.
struct SampleTable {
  std::vector<std::byte> bytes;
  std::vector<std::uint32_t> bit_of;  ///< for each of the shaders' sample numbers, the light sample
};
SampleTable make_sample_table(const visibility::DeviceLight& frame, bool rows);

}  // namespace penumbra::vsm
