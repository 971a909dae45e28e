// SPDX-License-Identifier: Apache-2.0
// Data for the view-sample shaders: tags of closed parts, marks of dispensable subtrees, and the table of light
// samples.

#include "vsm/uploads.hpp"

#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

namespace penumbra::vsm {

using visibility::TriangleTree;

std::vector<std::uint32_t> part_tags(const ClosedParts& closed) {
  std::vector<std::uint32_t> tags;
  tags.reserve(closed.part.size());
  for (const std::uint32_t part : closed.part) tags.push_back(part << kPartShift);
  return tags;
}

namespace {

/// Returns the part outside of which all triangles below a child are dispensable, or 0; marks the nodes below.
std::uint32_t mark_child(const TriangleTree& tree, const TriangleTree::Child& child,
                         std::span<const std::uint8_t> dispensable, std::span<Texel> nodes) {
  constexpr std::uint32_t kUnseen = 0xffffffffU;
  std::uint32_t common = kUnseen;
  const auto add = [&](std::uint32_t part) { common = common == kUnseen || common == part ? part : 0; };
  if ((child.reference & TriangleTree::kLeafBit) != 0) {
    for (const std::uint32_t triangle : tree.leaves[child.reference & ~TriangleTree::kLeafBit]) {
      if (triangle != TriangleTree::kNoTriangle) add(dispensable[triangle]);
    }
    return common == kUnseen ? 0 : common;
  }
  const TriangleTree::Node& node = tree.nodes[child.reference];
  for (std::size_t i = 0; i < node.size(); ++i) {
    if (node[i].reference == TriangleTree::kNoChild) continue;
    const std::uint32_t part = mark_child(tree, node[i], dispensable, nodes);
    nodes[2 * (std::size_t{child.reference} * TriangleTree::kWidth + i) + 1].number = part;
    add(part);
  }
  return common == kUnseen ? 0 : common;
}

}  // namespace

void mark_dispensable(const TriangleTree& tree, std::span<const std::uint8_t> dispensable, std::span<Texel> nodes) {
  if (!tree.nodes.empty()) mark_child(tree, {.reference = 0}, dispensable, nodes);
}

std::vector<Texel> part_texels(const ClosedParts& closed, float scale) {
  std::vector<Texel> texels;
  const auto add = [&](const visibility::Bounds& box) {
    texels.push_back({box.lower * scale, 0});
    texels.push_back({box.upper * scale, 0});
  };
  for (const ClosedPart& part : closed.parts) {
    add(part.box);
    for (const visibility::Bounds& box : part.touching) add(box);
  }
  if (texels.empty()) texels.emplace_back();  // a buffer must not be empty
  return texels;
}

SampleTable make_sample_table(const visibility::DeviceLight& frame, bool rows) {
  constexpr std::uint32_t kCells = 256;
  std::array<std::uint32_t, kCells + 1> first_point{};
  std::vector<glm::vec2> points(1);
  SampleTable table;
  table.bit_of.resize(frame.coordinates.size());
  std::iota(table.bit_of.begin(), table.bit_of.end(), 0U);
  if (!rows) {
    std::stable_sort(table.bit_of.begin(), table.bit_of.end(),
                     [&](auto a, auto b) { return frame.coordinates[a].y < frame.coordinates[b].y; });
    points.clear();
    for (const std::uint32_t j : table.bit_of) points.push_back(frame.coordinates[j]);
    for (std::uint32_t cell = 0; cell < kCells; ++cell) {
      const float from = -1.0F + 2 * static_cast<float>(cell) / kCells;
      const auto first =
          std::lower_bound(points.begin(), points.end(), from, [](const glm::vec2& at, float t) { return at.y < t; });
      first_point[cell] = static_cast<std::uint32_t>(first - points.begin());
    }
    first_point[kCells] = static_cast<std::uint32_t>(points.size());
  }
  table.bytes.resize(sizeof(first_point) + points.size() * sizeof(glm::vec2));
  std::memcpy(table.bytes.data(), first_point.data(), sizeof(first_point));
  std::memcpy(table.bytes.data() + sizeof(first_point), points.data(), points.size() * sizeof(glm::vec2));
  return table;
}

}  // namespace penumbra::vsm
