// SPDX-License-Identifier: Apache-2.0
// Hierarchies as texels for shaders, with boxes rounded outward.

#include "visibility/tree/tree_texels.hpp"

#include "base/parallel.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace penumbra::visibility {

float device_scale(const SceneFloats& scene) {
  float largest = 0;
  for (int axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::abs(scene.lower[axis]), std::abs(scene.upper[axis])});
  // Subnormal floats have no finite inverse: they are scaled as far as floats allow.
  return largest > 0 ? std::ldexp(1.0F, std::min(-std::ilogb(largest), 127)) : 1.0F;
}

bool normal_is_known(const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 a(corners[0]), e1 = glm::dvec3(corners[1]) - a, e2 = glm::dvec3(corners[2]) - a;
  const glm::dvec3 cross = glm::abs(glm::cross(e1, e2)), size1 = glm::abs(e1), size2 = glm::abs(e2);
  return cross.x + cross.y + cross.z > 0x1p-25 * (size1.x + size1.y + size1.z) * (size2.x + size2.y + size2.z);
}

namespace {

/// Half extent of a flat box: too small to change any coordinate, but far from subnormal numbers, each product with
/// which costs a processor more than a hundred cycles.
constexpr float kThinnest = 0x1p-40F;

/// Returns the next larger float of a positive one, like std::nextafter but without a function call.
float next_above(float x) {
  constexpr float kMost = std::numeric_limits<float>::max();
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(std::min(x, kMost)) + 1);
}

}  // namespace

std::array<Texel, 2> child_texels(const TriangleTree::Child& child, float scale) {
  const glm::vec3 lower = child.lower * scale, upper = child.upper * scale;
  const glm::vec3 middle = 0.5F * lower + 0.5F * upper;
  glm::vec3 half = glm::max(upper - middle, middle - lower);
  for (int axis = 0; axis < 3; ++axis) half[axis] = half[axis] >= kThinnest ? next_above(half[axis]) : kThinnest;
  return {Texel{middle, child.reference}, Texel{half, 0}};
}

std::vector<Texel> node_texels(const TriangleTree& tree, float scale) {
  std::vector<Texel> texels(tree.nodes.size() * 2 * TriangleTree::kWidth);
  for_each_index(tree.nodes.size() * TriangleTree::kWidth, [&](std::size_t i) {
    const auto two = child_texels(tree.nodes[i / TriangleTree::kWidth][i % TriangleTree::kWidth], scale);
    std::ranges::copy(two, texels.begin() + static_cast<std::ptrdiff_t>(2 * i));
  });
  return texels;
}

}  // namespace penumbra::visibility
