// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

/// Layout of scenes and hierarchies in uniform texel buffers.
namespace penumbra::visibility {

/// One texel of the shaders' buffers: three floats and an integer, read as bits so that nothing is flushed to zero.
struct Texel {
  glm::vec3 value{0};
  std::uint32_t number = 0;
};
static_assert(sizeof(Texel) == 16);

/// Returns the power of two that brings the scene's largest coordinate into [1, 2): exact, and the float range then
/// fits the sixth powers of lengths that shaders multiply.
float device_scale(const SceneFloats& scene);

/// Returns the two texels of a child: (middle, reference), (half extent, 0). Boxes are rounded outward.
std::array<Texel, 2> child_texels(const TriangleTree::Child& child, float scale);
/// Returns the texels of all nodes, eight children each.
std::vector<Texel> node_texels(const TriangleTree& tree, float scale);

/// Returns whether a triangle's normal, computed in double, is accurate to float32. False for a needle whose edges are
/// nearly parallel: each component of the cross product is off by up to 4 · 2⁻⁵³ |e1| |e2| (1-norms). If false, devices
/// get a normal of zero, which leaves every sample of the horizon open.
bool normal_is_known(const std::array<glm::vec3, 3>& corners);

}  // namespace penumbra::visibility
