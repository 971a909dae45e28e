#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

/// Boxes that lie together, in groups: what a tree is made of instead of single boxes, a tenth as many. Inside
/// visibility/tree/ only.
namespace penumbra::visibility {

/// Not initialised: lists of them are filled on all cores.
struct NumberedBox {
  glm::vec3 lower;
  std::uint32_t number;
  glm::vec3 upper;
  std::uint32_t unused;

  [[nodiscard]] glm::vec3 middle() const { return 0.5F * lower + 0.5F * upper; }
};

/// Boxes that follow one another in a list, and a box around them.
struct BoxGroup {
  glm::vec3 lower{0};
  std::uint32_t first = 0;
  glm::vec3 upper{0};
  std::uint32_t count = 0;

  [[nodiscard]] glm::vec3 middle() const { return 0.5F * lower + 0.5F * upper; }
};

/// Groups of at most so many, unless their middles lie so close to one another that they must be grouped again.
constexpr std::uint32_t kGroup = 16;

struct GroupedBoxes {
  std::unique_ptr<NumberedBox[]> boxes;
  std::vector<BoxGroup> groups;
};

/// Sorts boxes by the cell of a fine grid that their middle is in, along a curve that leaves no cell of a coarser grid
/// before it has seen all of it (Morton's), and cuts that where coarser grids do, as coarse as groups allow. A box so
/// large that it alone makes its group large is a group of its own. `box(i)` is called on all cores. Linear; the same
/// whatever the number of threads.
GroupedBoxes group_boxes(std::size_t count, const std::function<NumberedBox(std::size_t)>& box);

/// The same of boxes in a list, where they are put in the order of groups, and of their own grid; more than one group
/// if there are more than kGroup of them. `BoxGroup::first` counts from the list's beginning.
std::vector<BoxGroup> group_again(std::span<NumberedBox> boxes);

}  // namespace penumbra::visibility
