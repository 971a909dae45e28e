// SPDX-License-Identifier: Apache-2.0
// Splits cells of a light whose corners' maps differ, and weights the points (Schwärzler, sections 3.3.1, 3.3.4 and
// 3.3.5).

#include "maps/sampling/light_tree.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <cmath>

namespace penumbra::maps {
namespace {

std::uint64_t key(const glm::uvec2& point) {
  return std::uint64_t{point.y} << 32 | point.x;
}

}  // namespace

LightTree::LightTree(Shape shape, std::uint32_t levels) : shape_(shape), levels_(levels), level_{Cell{}} {
  PENUMBRA_ASSERT(levels <= 12, "{} levels of cells", levels);
  for (const glm::uvec2& corner : corners(level_.front())) add(corner);
  find_pairs();
}

glm::dvec2 LightTree::unit(const glm::uvec2& point) const {
  const double side = std::ldexp(1.0, static_cast<int>(levels_));
  return {point.x / side, shape_ == Shape::line ? 0.5 : point.y / side};
}

std::vector<glm::uvec2> LightTree::corners(const Cell& cell) const {
  const std::uint32_t side = 1u << (levels_ - cell.depth);
  const glm::uvec2 a = cell.at;
  if (shape_ == Shape::line) return {a, {a.x + side, a.y}};
  return {a, {a.x + side, a.y}, {a.x, a.y + side}, {a.x + side, a.y + side}};
}

std::vector<LightTree::Cell> LightTree::children(const Cell& cell) const {
  std::vector<Cell> halves;
  for (const glm::uvec2& corner : corners({cell.at, cell.depth + 1})) halves.push_back({corner, cell.depth + 1});
  return halves;
}

std::size_t LightTree::new_points(const Cell& cell) const {
  std::vector<std::uint64_t> needed;
  for (const Cell& child : children(cell)) {
    for (const glm::uvec2& corner : corners(child)) {
      if (!index_.contains(key(corner))) needed.push_back(key(corner));
    }
  }
  std::ranges::sort(needed);
  return static_cast<std::size_t>(std::unique(needed.begin(), needed.end()) - needed.begin());
}

std::uint32_t LightTree::add(const glm::uvec2& point) {
  const auto [place, is_new] = index_.emplace(key(point), static_cast<std::uint32_t>(points_.size()));
  if (is_new) points_.push_back(point);
  return place->second;
}

void LightTree::find_pairs() {
  pairs_.clear();
  if (!level_.empty() && level_.front().depth == levels_) {
    leaves_.insert(leaves_.end(), level_.begin(), level_.end());
    level_.clear();
  }
  for (const Cell& cell : level_) {
    const std::vector<glm::uvec2> at = corners(cell);
    const auto pair = [&](std::size_t a, std::size_t b) {
      pairs_.push_back({index_.at(key(at[a])), index_.at(key(at[b]))});
    };
    if (shape_ == Shape::line) {
      pair(0, 1);
    } else {
      pair(0, 3);
      pair(1, 2);
    }
  }
}

void LightTree::split(std::span<const std::uint8_t> differs, std::size_t most) {
  PENUMBRA_ASSERT(differs.size() == pairs_.size(), "{} answers for {} pairs", differs.size(), pairs_.size());
  const std::size_t pairs_per_cell = shape_ == Shape::line ? 1 : 2;
  std::vector<Cell> next;
  for (std::size_t i = 0; i < level_.size(); ++i) {
    const auto answers = differs.subspan(i * pairs_per_cell, pairs_per_cell);
    const bool wanted = std::ranges::any_of(answers, [](std::uint8_t answer) { return answer != 0; });
    if (!wanted || points_.size() + new_points(level_[i]) > most) {
      leaves_.push_back(level_[i]);
      continue;
    }
    for (const Cell& child : children(level_[i])) {
      for (const glm::uvec2& corner : corners(child)) add(corner);
      next.push_back(child);
    }
  }
  level_ = std::move(next);
  find_pairs();
}

std::vector<double> LightTree::weights(PointWeights kind, const Light& light) const {
  PENUMBRA_ASSERT(level_.empty(), "weights of a tree with {} open cells", level_.size());
  struct Around {
    std::uint32_t depth = 0;  ///< depth of the deepest cell
    double area = 0, light = 0;
  };
  std::vector<Around> around(points_.size());
  for (const Cell& leaf : leaves_) {
    const double side = std::ldexp(1.0, -static_cast<int>(leaf.depth));
    glm::dvec2 lower = unit(leaf.at), upper = lower + side;
    if (shape_ == Shape::line) {
      lower.y = 0;
      upper.y = 1;
    }
    const double area = (upper.x - lower.x) * (upper.y - lower.y), given = light(lower, upper);
    for (const glm::uvec2& corner : corners(leaf)) {
      Around& point = around[index_.at(key(corner))];
      point.depth = leaf.depth;  // leaves are in the order of depth: no earlier one is deeper
      point.area += area;
      point.light += given;
    }
  }
  std::vector<double> weights(points_.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double mean = around[i].light / around[i].area;
    const double points_across = std::ldexp(1.0, static_cast<int>(around[i].depth)) + 1;
    switch (kind) {
      case PointWeights::paper:
        weights[i] = mean / (shape_ == Shape::line ? points_across : points_across * points_across);
        break;
      case PointWeights::equal:
        weights[i] = mean;
        break;
      case PointWeights::area:
        weights[i] = around[i].light / (shape_ == Shape::line ? 2 : 4);
        break;
    }
  }
  return weights;
}

}  // namespace penumbra::maps
