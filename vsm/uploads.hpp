// SPDX-License-Identifier: Apache-2.0
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

/// Bit at which the number of a closed part begins in a word that also holds a plane's index.
inline constexpr std::uint32_t kPartShift = 27;

/// Returns for each triangle the closed part that it belongs to, in a form that is OR-ed to the index of its plane;
/// empty if there are no parts.
std::vector<std::uint32_t> part_tags(const ClosedParts& closed);

/// Writes into each child's second texel the closed part outside of which all triangles below are dispensable, or 0.
void mark_dispensable(const visibility::TriangleTree& tree, std::span<const std::uint8_t> dispensable,
                      std::span<Texel> nodes);

/// Returns seven boxes of two texels for each part: that of the part, and those of its vertices on each face.
std::vector<Texel> part_texels(const ClosedParts& closed, float scale);

/// The shaders' table of light samples: uint first_point[257], then (s, t) of each, sorted by t, so that a triangle
/// reads one contiguous range. Rows are computed, not read: their table is empty, and in the order of the light
/// samples.
struct SampleTable {
  std::vector<std::byte> bytes;
  std::vector<std::uint32_t> bit_of;  ///< for each of the shaders' sample indices, the light sample
};
SampleTable make_sample_table(const visibility::DeviceLight& frame, bool rows);

}  // namespace penumbra::vsm
