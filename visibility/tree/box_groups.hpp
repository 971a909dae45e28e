// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

/// Groups of neighbouring boxes: a tree is built over them instead of single boxes, since there are only a tenth as
/// many. Inside visibility/tree/ only.
namespace penumbra::visibility {

/// Uninitialised: lists of these are filled on all cores.
struct NumberedBox {
  glm::vec3 lower;
  std::uint32_t number;
  glm::vec3 upper;
  std::uint32_t unused;

  [[nodiscard]] glm::vec3 middle() const { return 0.5F * lower + 0.5F * upper; }
};

/// Consecutive boxes of a list, and their bounds.
struct BoxGroup {
  glm::vec3 lower{0};
  std::uint32_t first = 0;
  glm::vec3 upper{0};
  std::uint32_t count = 0;

  [[nodiscard]] glm::vec3 middle() const { return 0.5F * lower + 0.5F * upper; }
};

/// Most boxes in a group, unless their middles are so close together that they must be grouped again.
constexpr std::uint32_t kGroup = 16;

struct GroupedBoxes {
  std::unique_ptr<NumberedBox[]> boxes;
  std::vector<BoxGroup> groups;
};

/// Sorts boxes by the cell of a fine grid that contains their middle, along a curve that leaves no cell of a coarser
/// grid before it has visited all of it (Morton's), and cuts the curve at cells of coarser grids, as coarse as groups
/// allow. A box so large that it alone makes its group large becomes its own group. `box(i)` is called on all cores.
/// Linear time; the result does not depend on the number of threads.
GroupedBoxes group_boxes(std::size_t count, const std::function<NumberedBox(std::size_t)>& box);

/// Groups boxes of a list by their own grid, and reorders them by groups; gives more than one group if there are more
/// than kGroup boxes. `BoxGroup::first` counts from the list's beginning.
std::vector<BoxGroup> group_again(std::span<NumberedBox> boxes);

}  // namespace penumbra::visibility
