// SPDX-License-Identifier: Apache-2.0
// The hierarchy that view-sample mapping searches: it holds every triangle that casts shadow exactly once, and no box
// is smaller than what is below it.

#include "tests/agreement/lattice.hpp"
#include "visibility/tree/tree_along.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <tbb/global_control.h>

#include <cmath>

namespace penumbra::visibility {
namespace {

/// Walks through a whole tree and counts triangles; every node and leaf must be reached once.
struct Walk {
  const SceneFloats& floats;
  const TriangleTree& tree;
  std::vector<int> triangle_seen, node_seen, leaf_seen;
  std::uint32_t deepest = 0;

  explicit Walk(const SceneFloats& scene, const TriangleTree& over)
      : floats(scene),
        tree(over),
        triangle_seen(scene.triangles.size()),
        node_seen(over.nodes.size()),
        leaf_seen(over.leaves.size()) {
    if (!tree.nodes.empty()) node(0, 1, {});
  }

  /// `around`: all boxes from the root to this node.
  void node(std::uint32_t index, std::uint32_t depth, const std::vector<TriangleTree::Child>& around) {
    ASSERT_LT(index, tree.nodes.size());
    ++node_seen[index];
    deepest = std::max(deepest, depth);
    for (const TriangleTree::Child& child : tree.nodes[index]) {
      if (child.reference == TriangleTree::kNoChild) continue;
      std::vector<TriangleTree::Child> boxes = around;
      boxes.push_back(child);
      if ((child.reference & TriangleTree::kLeafBit) == 0) {
        node(child.reference, depth + 1, boxes);
      } else {
        leaf(child.reference & ~TriangleTree::kLeafBit, boxes);
      }
    }
  }

  void leaf(std::uint32_t index, const std::vector<TriangleTree::Child>& boxes) {
    ASSERT_LT(index, tree.leaves.size());
    ++leaf_seen[index];
    bool ended = false;
    for (const std::uint32_t triangle : tree.leaves[index]) {
      ended = ended || triangle == TriangleTree::kNoTriangle;
      if (ended) {
        EXPECT_EQ(triangle, TriangleTree::kNoTriangle) << "unused slots come last";
        continue;
      }
      ASSERT_LT(triangle, floats.triangles.size());
      ++triangle_seen[triangle];
      for (const glm::vec3& corner : floats.corners(triangle)) {
        for (const TriangleTree::Child& box : boxes) {
          EXPECT_TRUE(corner == glm::clamp(corner, box.lower, box.upper)) << "triangle " << triangle;
        }
      }
    }
  }
};

void check(const SceneFloats& floats) {
  const TriangleTree tree = make_triangle_tree(floats);
  const Walk walk(floats, tree);
  for (std::size_t i = 0; i < floats.triangles.size(); ++i) {
    EXPECT_EQ(walk.triangle_seen[i], floats.casts_shadow[i] != 0 ? 1 : 0) << "triangle " << i;
  }
  for (const int seen : walk.node_seen) EXPECT_EQ(seen, 1);
  for (const int seen : walk.leaf_seen) EXPECT_EQ(seen, 1);
  EXPECT_EQ(walk.deepest, tree.depth) << "the shaders' stack is as deep as this number";
}

scenes::Scene with(const std::vector<tests::Corners>& triangles) {
  scenes::Scene scene;
  tests::add_object(scene, "anchor", {{glm::dvec3(-9), glm::dvec3(9, -9, 9), glm::dvec3(9)}}).casts_shadow = false;
  tests::add_object(scene, "soup", triangles);
  return scene;
}

TEST(TriangleTree, HoldsEveryCastingTriangleOnceInBoxesAroundIt) {
  for (const std::uint32_t count : {0U, 1U, 2U, 7U, 8U, 9U, 64U, 65U, 1000U, 20000U}) {
    SCOPED_TRACE(count);
    tests::LatticeSoup soup(count, count < 100 ? 3 : 100);
    check(visibility::make_scene_floats(with(soup.triangles(count))));
  }
}

TEST(TriangleTree, HoldsDoublesAsOftenAsTheyAre) {
  for (const std::size_t count : {8U, 9U, 100U, 5000U}) {
    SCOPED_TRACE(count);
    check(visibility::make_scene_floats(
        with(std::vector<tests::Corners>(count, {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}))));
  }
}

/// Adds small triangles around a place.
void add_heap(std::vector<tests::Corners>& triangles, std::uint32_t seed, std::uint32_t count, const glm::dvec3& at,
              double size) {
  tests::LatticeSoup soup(seed, 100);
  for (const tests::Corners& corners : soup.triangles(count)) {
    tests::Corners placed = corners;
    for (glm::dvec3& corner : placed) corner = at + size * corner;
    triangles.push_back(placed);
  }
}

TEST(TriangleTree, HoldsHeapsThatAreSpecksBesideTheWhole) {
  std::vector<tests::Corners> triangles{{glm::dvec3(-8), glm::dvec3(8, -8, 8), glm::dvec3(8)}};
  double size = 0.01;
  for (std::uint32_t i = 0; i < 12;
       ++i, size *= 0.25)  // each heap fits in the grid cell that contains the heap before it
    add_heap(triangles, i, 500, glm::dvec3(size), 0.001 * size);
  const SceneFloats floats = make_scene_floats(with(triangles));
  check(floats);
  EXPECT_LE(make_triangle_tree(floats).depth, 16U) << "6,001 triangles, an eighth of them below each child: 5";
}

TEST(TriangleTree, IsTheSameForAnyNumberOfThreads) {
  std::vector<tests::Corners> triangles;
  add_heap(triangles, 1, 30000, glm::dvec3(0), 0.05);
  add_heap(triangles, 2, 9000, glm::dvec3(1), 1e-6);
  const SceneFloats floats = make_scene_floats(with(triangles));
  const TriangleTree many = make_triangle_tree(floats);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const TriangleTree one = make_triangle_tree(floats);
  EXPECT_EQ(one.leaves, many.leaves);
  ASSERT_EQ(one.nodes.size(), many.nodes.size());
  for (std::size_t i = 0; i < one.nodes.size(); ++i) {
    for (std::size_t child = 0; child < TriangleTree::kWidth; ++child) {
      const TriangleTree::Child &a = one.nodes[i][child], &b = many.nodes[i][child];
      EXPECT_TRUE(a.reference == b.reference && a.lower == b.lower && a.upper == b.upper) << i;
    }
  }
}

/// Returns half of the surface of all children's boxes over that of the whole: how many nodes and leaves a random ray
/// touches.
double touched(const TriangleTree& tree) {
  double sum = 0;
  Bounds all{glm::vec3(1e30F), glm::vec3(-1e30F)};
  const auto area = [](const Bounds& box) {
    const glm::dvec3 size = glm::dvec3(box.upper) - glm::dvec3(box.lower);
    return size.x * size.y + size.y * size.z + size.z * size.x;
  };
  for (const TriangleTree::Node& node : tree.nodes) {
    for (const TriangleTree::Child& child : node) {
      if (child.reference == TriangleTree::kNoChild) continue;
      sum += area({child.lower, child.upper});
      all = {glm::min(all.lower, child.lower), glm::max(all.upper, child.upper)};
    }
  }
  return sum / area(all);
}

TEST(TriangleTree, DividesWhereRaysPassBetween) {
  std::vector<tests::Corners> triangles;  // heaps of different sizes along a spiral
  for (std::uint32_t i = 0; i < 300; ++i) {
    const double turned = 2.4 * i;
    const glm::dvec3 at(std::cos(turned), std::sin(turned), 0.01 * i);
    add_heap(triangles, i, 20 + i % 7 * 10, (1 + 0.02 * i) * at, 0.0002);
  }
  // The value is 2.2; with the worst division everywhere in place of the best it is 15.
  EXPECT_LT(touched(make_triangle_tree(make_scene_floats(with(triangles)))), 4);
}

TEST(TriangleTree, AlongAnotherHoldsEveryBoxOnce) {
  for (const std::uint32_t count : {1U, 8U, 9U, 64U, 65U, 1000U, 30000U}) {
    tests::LatticeSoup soup(count, count < 100 ? 3 : 100);
    const SceneFloats floats = make_scene_floats(with(soup.triangles(count)));
    std::vector<std::uint32_t> casters;
    std::vector<Bounds> boxes;
    SceneFloats only = floats;  // its triangles have the boxes' numbers
    only.triangles.clear();
    for (std::uint32_t i = 0; i < floats.triangles.size(); ++i) {
      if (floats.casts_shadow[i] == 0) continue;
      const auto [a, b, c] = floats.corners(i);
      casters.push_back(i);
      boxes.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
      only.triangles.push_back(floats.triangles[i]);
    }
    // Each box is near its own triangle, or many boxes are near one.
    for (const std::size_t homes : {casters.size(), std::size_t{3}}) {
      SCOPED_TRACE(fmt::format("{} triangles, near {}", count, homes));
      std::vector<std::uint32_t> near;
      for (std::size_t i = 0; i < boxes.size(); ++i) near.push_back(casters[i % std::min(homes, casters.size())]);
      const TriangleTree tree =
          make_tree_along(make_triangle_tree(floats), {.count = boxes.size(),
                                                       .box = [&](std::size_t i) { return boxes[i]; },
                                                       .triangle = [&](std::size_t i) { return near[i]; }});
      const Walk walk(only, tree);
      for (const int seen : walk.triangle_seen) EXPECT_EQ(seen, 1);
      for (const int seen : walk.node_seen) EXPECT_EQ(seen, 1);
      for (const int seen : walk.leaf_seen) EXPECT_EQ(seen, 1);
      EXPECT_EQ(walk.deepest, tree.depth);
    }
  }
}

TEST(TriangleTree, FindsEveryTriangleWhoseBoxIsTouched) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    tests::LatticeSoup soup(seed, 6);
    const SceneFloats floats = make_scene_floats(with(soup.triangles(300)));
    const TriangleTree tree = make_triangle_tree(floats);
    for (int i = 0; i < 20; ++i) {
      const glm::vec3 p(soup.point()), q(soup.point()), lower = glm::min(p, q), upper = glm::max(p, q);
      std::vector<int> found(floats.triangles.size());
      tree.for_each_near(lower, upper, [&](std::uint32_t triangle) { ++found[triangle]; });
      for (std::uint32_t t = 0; t < floats.triangles.size(); ++t) {
        const auto [a, b, c] = floats.corners(t);
        const glm::vec3 from = glm::min(a, glm::min(b, c)), to = glm::max(a, glm::max(b, c));
        const bool touched =
            glm::max(from, lower) == glm::clamp(glm::max(from, lower), glm::vec3(-1e30F), glm::min(to, upper));
        if (touched && floats.casts_shadow[t] != 0) {
          EXPECT_EQ(found[t], 1) << "seed " << seed << " triangle " << t;
        }
        EXPECT_LE(found[t], floats.casts_shadow[t] != 0 ? 1 : 0);
      }
    }
  }
}

}  // namespace
}  // namespace penumbra::visibility
