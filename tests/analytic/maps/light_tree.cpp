// SPDX-License-Identifier: Apache-2.0
// Tests the cells of adaptive-light, without a device: which points they share, how a bound on points acts, and the
// weights.

#include "maps/sampling/light_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <utility>

namespace penumbra::tests {
namespace {

using maps::LightTree;
using maps::PointWeights;

double even(const glm::dvec2& lower, const glm::dvec2& upper) {
  return (upper.x - lower.x) * (upper.y - lower.y);
}

double sum(const std::vector<double>& weights) {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

LightTree whole(LightTree::Shape shape, std::uint32_t levels) {
  LightTree tree(shape, levels);
  while (!tree.pairs().empty()) tree.split(std::vector<std::uint8_t>(tree.pairs().size(), 1), 1u << 20);
  return tree;
}

TEST(LightTree, AllCellsSplitGiveEveryPointOnceWithThePapersWeights) {
  for (std::uint32_t levels = 0; levels <= 5; ++levels) {
    const std::size_t across = (std::size_t{1} << levels) + 1;
    const LightTree area = whole(LightTree::Shape::area, levels), line = whole(LightTree::Shape::line, levels);
    EXPECT_EQ(area.points().size(), across * across);
    EXPECT_EQ(line.points().size(), across);
    // Equations 5 and 6: all weights are equal, and their sum is 1.
    for (const auto& [tree, weight] : {std::pair(&area, 1.0 / static_cast<double>(across * across)),
                                       std::pair(&line, 1.0 / static_cast<double>(across))}) {
      const std::vector<double> weights = tree->weights(PointWeights::paper, even);
      for (const double w : weights) EXPECT_DOUBLE_EQ(w, weight);
      EXPECT_NEAR(sum(weights), 1, 1e-12);
      EXPECT_NEAR(sum(tree->weights(PointWeights::area, even)), 1, 1e-12);
    }
  }
}

TEST(LightTree, WithoutASplitThereAreTheCornersAlone) {
  LightTree area(LightTree::Shape::area, 3), line(LightTree::Shape::line, 3);
  ASSERT_EQ(area.pairs().size(), 2U);
  ASSERT_EQ(line.pairs().size(), 1U);
  // Pairs are opposite corners: each pair lies on a diagonal.
  for (const LightTree::Pair& pair : area.pairs()) {
    const glm::uvec2 a = area.points()[pair.a], b = area.points()[pair.b];
    EXPECT_NE(a.x, b.x);
    EXPECT_NE(a.y, b.y);
  }
  area.split(std::vector<std::uint8_t>{0, 0}, 100);
  line.split(std::vector<std::uint8_t>{0}, 100);
  EXPECT_TRUE(area.pairs().empty());
  EXPECT_EQ(area.points().size(), 4U);
  EXPECT_EQ(line.points().size(), 2U);
}

// A cell adds 5 new points if no neighbour is split, down to 1 between four split cells, and never more than 5.
TEST(LightTree, ACellAddsOneToFivePointsAndNeighboursShareThem) {
  std::mt19937 random(7);
  std::set<std::size_t> seen;
  for (int trial = 0; trial < 200; ++trial) {
    LightTree tree(LightTree::Shape::area, 4);
    while (!tree.pairs().empty()) {
      // Splitting single cells would give another order; so only passes that split one cell show what it adds.
      const std::size_t before = tree.points().size(), cells = tree.pairs().size() / 2;
      std::vector<std::uint8_t> differs(2 * cells, 0);
      for (std::uint8_t& answer : differs) answer = random() % 3 == 0 ? 1 : 0;
      std::size_t split = 0;
      for (std::size_t i = 0; i < cells; ++i) split += differs[2 * i] != 0 || differs[2 * i + 1] != 0 ? 1 : 0;
      tree.split(differs, 1u << 20);
      const std::size_t added = tree.points().size() - before;
      EXPECT_LE(added, 5 * split);
      EXPECT_GE(added, split);
      if (split == 1) seen.insert(added);
      std::set<std::pair<unsigned, unsigned>> points;
      for (const glm::uvec2& point : tree.points()) points.insert({point.x, point.y});
      EXPECT_EQ(points.size(), tree.points().size()) << "a point twice";
    }
    EXPECT_LE(tree.points().size(), 17U * 17U);
    double area = 0;
    for (const LightTree::Cell& leaf : tree.leaves()) area += std::ldexp(1.0, -2 * static_cast<int>(leaf.depth));
    EXPECT_DOUBLE_EQ(area, 1);
    EXPECT_TRUE(std::ranges::is_sorted(tree.leaves(), {}, &LightTree::Cell::depth));
    EXPECT_NEAR(sum(tree.weights(PointWeights::area, even)), 1, 1e-12);
  }
  EXPECT_TRUE(seen.contains(5));
  for (const std::size_t added : seen) EXPECT_LE(added, 5U);
}

TEST(LightTree, ABoundOnPointsIsKeptAndStopsTheLaterCellsOfALevel) {
  for (std::size_t most = 4; most < 90; ++most) {
    LightTree tree(LightTree::Shape::area, 3);
    while (!tree.pairs().empty()) tree.split(std::vector<std::uint8_t>(tree.pairs().size(), 1), most);
    EXPECT_LE(tree.points().size(), most);
    EXPECT_GE(tree.points().size() + 5, std::min<std::size_t>(most + 1, 81)) << "a cell more would have fitted";
    std::uint32_t least = 3, deepest = 0;
    for (const LightTree::Cell& leaf : tree.leaves()) {
      least = std::min(least, leaf.depth);
      deepest = std::max(deepest, leaf.depth);
    }
    EXPECT_LE(deepest - least, 2U) << "breadth first";
  }
}

// One corner is refined twice. A point's depth is that of the deepest cell that touches it, even if it is a corner of a
// cell that is not split.
TEST(LightTree, WeightsOfUnevenCells) {
  LightTree tree(LightTree::Shape::area, 2);
  tree.split(std::vector<std::uint8_t>{1, 0}, 100);
  ASSERT_EQ(tree.points().size(), 9U);
  std::vector<std::uint8_t> first_cell(8, 0);
  first_cell[0] = 1;
  tree.split(first_cell, 100);
  ASSERT_EQ(tree.points().size(), 14U) << "4 + 5 + 5, as many as in the paper's figure 1";
  const std::vector<double> paper = tree.weights(PointWeights::paper, even),
                            area = tree.weights(PointWeights::area, even);
  for (std::size_t i = 0; i < tree.points().size(); ++i) {
    const glm::uvec2 at = tree.points()[i];  // in units of a quarter
    const bool fine = at.x <= 2 && at.y <= 2;
    EXPECT_DOUBLE_EQ(paper[i], fine ? 1.0 / 25 : 1.0 / 9) << at.x << ", " << at.y;
  }
  const auto weight = [&](glm::uvec2 at) {
    return area[static_cast<std::size_t>(std::ranges::find(tree.points(), at) - tree.points().begin())];
  };
  // A point weighs a quarter of the area of each cell that it is a corner of: quarters of 1/16 and of 1/4.
  EXPECT_DOUBLE_EQ(weight({0, 0}), 1.0 / 64);
  EXPECT_DOUBLE_EQ(weight({1, 1}), 4.0 / 64);
  EXPECT_DOUBLE_EQ(weight({2, 2}), 1.0 / 64 + 3.0 / 16);
  EXPECT_DOUBLE_EQ(weight({2, 1}), 2.0 / 64) << "in the middle of a whole cell's side, which it is no corner of";
  EXPECT_DOUBLE_EQ(weight({4, 4}), 1.0 / 16);
}

TEST(LightTree, UnevenLightWeighsPointsByTheLightOfTheirCells) {
  const LightTree tree = whole(LightTree::Shape::area, 2);
  // All light comes from the half x > 1/2.
  const auto right = [](const glm::dvec2& lower, const glm::dvec2& upper) {
    return std::max(0.0, upper.x - std::max(lower.x, 0.5)) * (upper.y - lower.y);
  };
  for (const PointWeights kind : {PointWeights::paper, PointWeights::equal, PointWeights::area}) {
    const std::vector<double> weights = tree.weights(kind, right), whole_light = tree.weights(kind, even);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double share = tree.points()[i].x < 2 ? 0 : tree.points()[i].x == 2 ? 0.5 : 1;
      EXPECT_DOUBLE_EQ(weights[i], share * whole_light[i]);
    }
  }
  EXPECT_NEAR(sum(tree.weights(PointWeights::area, right)), 0.5, 1e-12);
}

}  // namespace
}  // namespace penumbra::tests
