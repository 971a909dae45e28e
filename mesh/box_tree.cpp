// SPDX-License-Identifier: Apache-2.0
// Builds a balanced tree of boxes by splitting at medians, in parallel.

#include "mesh/box_tree.hpp"

#include "base/parallel.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <numeric>

namespace penumbra::mesh {
namespace {

constexpr std::size_t kItemsInLeaf = 8;           // at most
constexpr std::size_t kItemsWorthAThread = 4096;  // below that, starting a task costs more than it saves

}  // namespace

struct BoxTree::Builder {
  BoxTree& tree;
  std::span<const Box> boxes;

  void sort_along(int axis, std::size_t begin, std::size_t middle, std::size_t end) {
    const auto at = [&](std::size_t i) { return tree.order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t i, std::uint32_t j) {
      const double p = 0.5 * boxes[i].lower[axis] + 0.5 * boxes[i].upper[axis];
      const double q = 0.5 * boxes[j].lower[axis] + 0.5 * boxes[j].upper[axis];
      return p != q ? p < q : i < j;
    });
  }

  /// Builds node `node`; with j = node − width, its first item is number n j / width.
  void build(std::uint32_t node, std::uint32_t width) {
    const std::size_t count = boxes.size(), j = node - width;
    const std::size_t begin = count * j / width, end = count * (j + 1) / width;
    Box box, centres;
    for (std::size_t i = begin; i < end; ++i) {
      const Box& item = boxes[tree.order_[i]];
      box.include(item);
      centres.include(0.5 * item.lower + 0.5 * item.upper);
    }
    tree.nodes_[node] = box;
    if (width == tree.leaves_) return;
    const glm::dvec3 extent = 0.5 * centres.upper - 0.5 * centres.lower;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    sort_along(axis, begin, count * (2 * j + 1) / (2 * std::size_t{width}), end);
    const auto lower = [&] { build(2 * node, 2 * width); };
    const auto upper = [&] { build(2 * node + 1, 2 * width); };
    if (end - begin > kItemsWorthAThread) {
      tbb::parallel_invoke(lower, upper);
    } else {
      lower(), upper();
    }
  }
};

BoxTree::BoxTree(std::span<const Box> boxes) : order_(boxes.size()), boxes_(boxes.size()) {
  while (leaves_ * kItemsInLeaf < boxes.size()) leaves_ *= 2;
  nodes_.resize(2 * std::size_t{leaves_});
  std::iota(order_.begin(), order_.end(), 0u);
  Builder{*this, boxes}.build(1, 1);
  for_each_index(boxes_.size(), [&](std::size_t i) { boxes_[i] = boxes[order_[i]]; });
}

}  // namespace penumbra::mesh
