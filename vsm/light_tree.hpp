#pragma once

#include "engines/pairs/light_box.hpp"
#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace penumbra::vsm {

/// A binary hierarchy over light samples, whole words of masks each. Nodes lie in pre-order.
struct LightTree {
  struct Node {
    std::array<glm::dvec3, 4> corners{};  ///< around its light samples: points, of a sun directions
    glm::dvec2 lower{0}, upper{0};        ///< the same in the light's axes
    glm::dvec3 middle{0};
    double radius = 0;                  ///< half of the box's diagonal
    std::uint32_t word = 0, words = 0;  ///< its light samples in masks
    std::uint32_t right = 0;            ///< its right child; 0: none
    [[nodiscard]] bool is_leaf() const { return right == 0; }
  };
  pairs::LightBox box;
  std::vector<Node> nodes;
};

/// An order of light samples in which 32 that follow one another lie together: `order[i]` is the i-th's number.
std::vector<std::uint32_t> compact_order(const visibility::Light& light);
/// Of a light whose samples are in such an order.
LightTree make_light_tree(const visibility::Light& light);

}  // namespace penumbra::vsm
