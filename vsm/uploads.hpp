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

/// Writes a number into the second texel of each child of the tree. If all triangles below the child are dispensable,
/// it is the one closed part to which they belong: view samples outside of this part need not test them
/// (find_dispensable). Else it is 0. `dispensable`: the result of find_dispensable. `nodes`: the tree's texels, two for
/// each child.
void mark_dispensable(const visibility::TriangleTree& tree, std::span<const std::uint8_t> dispensable,
                      std::span<Texel> nodes);

/// Returns seven boxes for each part: its own, then for each of its six faces the box of the part's vertices on that
/// face (ClosedPart::touching). A box is two texels, its lower and its upper corner, multiplied by `scale`.
std::vector<Texel> part_texels(const ClosedParts& closed, float scale);

/// The shaders' table of light samples: uint first_point[257], then (s, t) of each light sample, sorted by t, so that a
/// triangle reads one contiguous range. first_point[i] is the first light sample with t of at least −1 + 2 i / 256.
/// Light samples in rows (DeviceLight::rows) need no table, since the shaders compute them: then it holds one point
/// that is not used, and the shaders' indices are those of the light samples.
struct SampleTable {
  std::vector<std::byte> bytes;
  std::vector<std::uint32_t> bit_of;  ///< for each of the shaders' sample indices, the light sample
};
/// `frame`: the light whose samples the table holds; `rows`: whether the shaders compute them as rows.
SampleTable make_sample_table(const visibility::DeviceLight& frame, bool rows);

}  // namespace penumbra::vsm
