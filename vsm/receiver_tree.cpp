// SPDX-License-Identifier: Apache-2.0
// Builds a binary hierarchy of boxes over view samples.

#include "vsm/receiver_tree.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace penumbra::vsm {
namespace {

struct TreeBuilder {
  const visibility::SceneFloats& scene;
  const visibility::ViewSamples& samples;
  ReceiverTree& tree;

  /// Divides at the median along the box's longest side. Ties are broken by pixel, so that the tree is unique.
  void build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t own = tree.nodes.size();
    tree.nodes.emplace_back();
    glm::vec3 lower(samples.p[tree.pixels[begin]]), upper(lower);
    std::uint64_t planes = 0;
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint32_t pixel = tree.pixels[i];
      lower = glm::min(lower, samples.p[pixel]);
      upper = glm::max(upper, samples.p[pixel]);
      planes |= std::uint64_t{1} << scene.plane[static_cast<std::size_t>(samples.triangle[pixel])] % 64;
    }
    std::uint32_t right = 0;
    if (end - begin > ReceiverTree::kLeaf) {
      const glm::vec3 size = upper - lower;
      const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
      const std::uint32_t middle = begin + (end - begin) / 2;
      const auto at = [&](std::uint32_t i) { return tree.pixels.begin() + static_cast<std::ptrdiff_t>(i); };
      std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
        const float x = samples.p[a][axis], y = samples.p[b][axis];
        return x < y || (x == y && a < b);
      });
      build(begin, middle);
      right = static_cast<std::uint32_t>(tree.nodes.size());
      build(middle, end);
    }
    ReceiverTree::Node& node = tree.nodes[own];
    node.middle = 0.5 * glm::dvec3(lower) + 0.5 * glm::dvec3(upper);
    node.half = (0.5 * glm::dvec3(upper) - 0.5 * glm::dvec3(lower)) * (1 + 0x1p-50) +
                0x1p-50 * (glm::abs(glm::dvec3(lower)) + glm::abs(glm::dvec3(upper)));
    node.radius = glm::length(node.half);
    node.begin = begin;
    node.end = end;
    node.right = right;
    node.end_node = static_cast<std::uint32_t>(tree.nodes.size());
    node.planes = planes;
  }
};

}  // namespace

ReceiverTree make_receiver_tree(const visibility::SceneFloats& scene, const visibility::ViewSamples& samples,
                                std::span<const std::uint32_t> pixels) {
  ReceiverTree tree{{}, {pixels.begin(), pixels.end()}};
  tree.nodes.reserve(4 * pixels.size() / ReceiverTree::kLeaf + 1);
  if (!pixels.empty()) TreeBuilder{scene, samples, tree}.build(0, static_cast<std::uint32_t>(pixels.size()));
  return tree;
}

}  // namespace penumbra::vsm
