// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/pairs/light_box.hpp"
#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace penumbra::vsm {

/// A binary hierarchy over light samples; nodes hold whole words of masks. Nodes are stored in pre-order.
struct LightTree {
  struct Node {
    std::array<glm::dvec3, 4> corners{};  ///< corners of a box around its light samples: points; for a sun, directions
    glm::dvec2 lower{0}, upper{0};        ///< bounds in the light's axes
    glm::dvec3 middle{0};
    double radius = 0;                  ///< half of the box's diagonal
    std::uint32_t word = 0, words = 0;  ///< its words in masks
    std::uint32_t right = 0;            ///< its right child; 0: none
    [[nodiscard]] bool is_leaf() const { return right == 0; }
  };
  pairs::LightBox box;
  std::vector<Node> nodes;
};

/// Returns an order of light samples in which 32 consecutive ones are close together: `order[i]` is the index of the
/// i-th sample.
std::vector<std::uint32_t> compact_order(const visibility::Light& light);
/// Makes the tree of a light whose samples are in compact_order.
LightTree make_light_tree(const visibility::Light& light);

}  // namespace penumbra::vsm
