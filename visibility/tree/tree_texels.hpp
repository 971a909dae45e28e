#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

/// How scenes and hierarchies lie in uniform texel buffers.
namespace penumbra::visibility {

/// One texel of the shaders' buffers: three floats and a number, read as bits so that nothing is flushed to zero.
struct Texel {
  glm::vec3 value{0};
  std::uint32_t number = 0;
};
static_assert(sizeof(Texel) == 16);

/// The power of two that brings the scene's largest coordinate into [1, 2): exact, and the float range then fits the
/// sixth powers of lengths that shaders multiply.
float device_scale(const SceneFloats& scene);

/// Two texels of a child: (middle, reference), (half extent, 0). Boxes are rounded outward.
std::array<Texel, 2> child_texels(const TriangleTree::Child& child, float scale);
/// Those of all nodes, eight children each.
std::vector<Texel> node_texels(const TriangleTree& tree, float scale);

/// Is a triangle's normal, as computed in double, right to float32? Not that of a needle whose edges are parallel but
/// for their last digits: each component of the cross product is off by up to 4 · 2⁻⁵³ |e1| |e2| (1-norms). Where it is
/// not, devices get a normal of zero, which leaves every sample of the horizon open.
bool normal_is_known(const std::array<glm::vec3, 3>& corners);

}  // namespace penumbra::visibility
