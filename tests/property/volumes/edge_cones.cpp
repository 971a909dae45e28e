// SPDX-License-Identifier: Apache-2.0
// Tests cones of normals in a hierarchy of edges: each holds the normals of every edge below it, up to sign. If normals
// lie in a plane, angles add up, and a cone joined from others must not be narrower than their sum.

#include "volumes/edges/edge_tree.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace penumbra::volumes {
namespace {

using visibility::TriangleTree;

/// Returns edges in a row, whose normals turn from one edge to the next by `whole` in total; the two normals of an edge
/// differ by `own`. Normals are off the plane of the turn by up to `beside`. Lengths and signs of normals must not
/// matter.
std::vector<EdgeRecord> turning(int count, double whole, double own, double beside) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> real(-1, 1);
  std::vector<EdgeRecord> records;
  for (int i = 0; i < count; ++i) {
    const auto normal = [&](double angle) {
      const double length = std::exp(real(random));
      return glm::vec3(length * glm::dvec3(std::cos(angle), std::sin(angle), beside * real(random)));
    };
    const double angle = whole * i / count;
    const float sign = random() % 2 == 0 ? 1.0F : -1.0F, x = static_cast<float>(i) / static_cast<float>(count);
    EdgeRecord& record = records.emplace_back();
    record.a = {x, 0, 0};
    record.b = {x, 1, 0};
    record.sides[0].n = sign * normal(angle);
    record.sides[1].n = -sign * normal(angle + own);
  }
  return records;
}

/// A hierarchy, with the texels of its nodes, which hold the cones.
struct EdgeTree {
  explicit EdgeTree(const std::vector<EdgeRecord>& records)
      : tree(edge_tree(records)), nodes(edge_texels(records, 1).nodes) {}
  TriangleTree tree;
  std::vector<visibility::Texel> nodes;
};

struct Found {
  std::size_t of_leaves = 0, joined = 0, all = 0;
  double loosest_leaf = 0;
};

/// Returns the records below a node.
std::vector<std::uint32_t> look_below(const EdgeTree& edges, const std::vector<EdgeRecord>& records, std::uint32_t node,
                                      Found& found) {
  std::vector<std::uint32_t> below_all;
  for (std::uint32_t i = 0; i < TriangleTree::kWidth; ++i) {
    const std::uint32_t reference = edges.tree.nodes[node][i].reference;
    if (reference == TriangleTree::kNoChild) continue;
    const bool is_leaf = (reference & TriangleTree::kLeafBit) != 0;
    std::vector<std::uint32_t> below;
    if (is_leaf) {
      for (const std::uint32_t record : edges.tree.leaves[reference & ~TriangleTree::kLeafBit])
        if (record != TriangleTree::kNoTriangle) below.push_back(record);
    } else {
      below = look_below(edges, records, reference, found);
    }
    below_all.insert(below_all.end(), below.begin(), below.end());
    const visibility::Texel& cone = edges.nodes[3 * (std::size_t{node} * TriangleTree::kWidth + i) + 2];
    const glm::dvec3 axis(cone.value);
    const double cosine = std::bit_cast<float>(cone.number);
    if (cosine <= 0) {
      ++found.all;
      continue;
    }
    ++(is_leaf ? found.of_leaves : found.joined);
    double least = 1;
    for (const std::uint32_t record : below) {
      const glm::dvec3 x = glm::normalize(glm::dvec3(records[record].sides[0].n)),
                       y = -glm::normalize(glm::dvec3(records[record].sides[1].n));
      const double sign = glm::dot(axis, x + y) < 0 ? -1 : 1;
      least = std::min({least, sign * glm::dot(axis, x), sign * glm::dot(axis, y)});
    }
    EXPECT_GE(least, cosine) << (is_leaf ? "a leaf" : "a node") << " of " << below.size();
    if (is_leaf) found.loosest_leaf = std::max(found.loosest_leaf, least - cosine);
  }
  return below_all;
}

TEST(EdgeCones, HoldTheNormalsOfAllEdgesBelow) {
  for (const double beside : {0.0, 0.3}) {
    for (const double whole : {0.01, 0.3, 1.2, 2.8}) {
      const std::vector<EdgeRecord> records = turning(3000, whole, 0.05, beside);
      const EdgeTree edges(records);
      Found found;
      EXPECT_EQ(look_below(edges, records, 0, found).size(), records.size());
      EXPECT_GT(found.of_leaves, records.size() / 16);
      EXPECT_GT(found.joined, records.size() / 128);
      // 2^-18 is subtracted, and axis and cosine are rounded to float32.
      EXPECT_LT(found.loosest_leaf, 0x1p-18 + 0x1p-22) << whole << ", " << beside;
    }
  }
}

TEST(EdgeCones, OfNormalsAllOverAreNone) {
  const EdgeTree edges(turning(3000, 60, 0.05, 0));
  const auto is_all = [&](std::uint32_t child) { return std::bit_cast<float>(edges.nodes[3 * child + 2].number) <= 0; };
  EXPECT_TRUE(is_all(0));  // at the root, where the normals of each child cover more than one turn
  std::vector<EdgeRecord> open = turning(3000, 0.3, 0.05, 0);
  open[1700].sides[1].n = glm::vec3(0);  // an edge with only one triangle
  Found found;
  look_below(EdgeTree(open), open, 0, found);
  EXPECT_GE(found.all, 2U);  // the edge's leaf, and each node above it
}

}  // namespace
}  // namespace penumbra::volumes
