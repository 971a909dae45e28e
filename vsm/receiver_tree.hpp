// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::vsm {

/// A binary hierarchy of boxes over view samples. Nodes are stored in pre-order: a node's left child follows it.
struct ReceiverTree {
  static constexpr std::uint32_t kLeaf = 8;  ///< most view samples in a leaf

  struct Node {
    glm::dvec3 middle{0}, half{0};          ///< its box, rounded outward
    double radius = 0;                      ///< half the box's diagonal
    std::uint32_t begin = 0, end = 0;       ///< its view samples in `pixels`
    std::uint32_t right = 0, end_node = 0;  ///< its right child, 0 for a leaf; the end of its subtree
    std::uint64_t planes = 0;               ///< bit (plane mod 64) of each of its carriers' planes
    [[nodiscard]] bool is_leaf() const { return right == 0; }
    [[nodiscard]] std::uint32_t count() const { return end - begin; }
  };
  std::vector<Node> nodes;            ///< the root first; empty without view samples
  std::vector<std::uint32_t> pixels;  ///< view samples of a node are contiguous
};

ReceiverTree make_receiver_tree(const visibility::SceneFloats& scene, const visibility::ViewSamples& samples,
                                std::span<const std::uint32_t> pixels);

}  // namespace penumbra::vsm
