// SPDX-License-Identifier: Apache-2.0
// Merges equal positions by hashing, and groups the sides of triangles by edge: a counting sort by the lower vertex,
// then a sort of each group, in parallel. Not from a paper.
#include "mesh/sorted_sides.hpp"

#include "base/assert.hpp"
#include "base/buckets.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <bit>

namespace penumbra::mesh {
namespace {

constexpr std::uint32_t kMostTriangles = 0xffffffffU / 3;  // a side's number is 32 bits

/// Returns a hash that is equal for equal points. (Multiplying and folding as in splitmix64.)
template <typename Point>
std::uint64_t hash_of(const Point& point) {
  std::uint64_t hash = 0x9e3779b97f4a7c15u;
  for (int axis = 0; axis < 3; ++axis) {
    const double place = static_cast<double>(point[axis]) + 0.0;  // + 0 turns −0 into +0
    hash = (hash ^ std::bit_cast<std::uint64_t>(place)) * 0xbf58476d1ce4e5b9u;
    hash ^= hash >> 31U;
  }
  return hash;
}

template <typename Point>
std::vector<std::uint32_t> first_at_place(std::span<const Point> positions) {
  return first_of_same(
      positions.size(), [&](std::size_t i) { return hash_of(positions[i]); },
      [&](std::size_t i, std::size_t j) { return positions[i] == positions[j]; });
}

}  // namespace

std::vector<std::uint32_t> merge_equal(std::span<const glm::dvec3> positions) {
  return first_at_place(positions);
}

std::vector<std::uint32_t> merge_equal(std::span<const glm::vec3> positions) {
  return first_at_place(positions);
}

SortedSides sort_sides(std::span<const std::uint32_t> vertex, std::span<const Triangle> triangles) {
  PENUMBRA_ASSERT(triangles.size() <= kMostTriangles, "{} triangles", triangles.size());
  SortedSides sorted;
  sorted.first.assign(vertex.size() + 1, 0);
  const auto counter = [&](std::size_t of) { return std::atomic_ref(sorted.first[of]); };
  const auto for_each_side = [&](const auto& visit) {
    for_each_index(triangles.size(), [&](std::size_t t) {
      const auto [a, b, c] = Triangle{vertex[triangles[t][0]], vertex[triangles[t][1]], vertex[triangles[t][2]]};
      if (a == b || b == c || c == a) return;
      const auto number = static_cast<std::uint32_t>(3 * t);
      visit(std::min(a, b), SortedSide{std::max(a, b), number});
      visit(std::min(b, c), SortedSide{std::max(b, c), number + 1});
      visit(std::min(c, a), SortedSide{std::max(c, a), number + 2});
    });
  };
  for_each_side([&](std::uint32_t from, const SortedSide&) { counter(from).fetch_add(1, std::memory_order_relaxed); });
  std::uint32_t sum = 0;
  for (std::uint32_t& first : sorted.first) first = sum += first;  // now the end of each vertex's sides
  sorted.sides.resize(sum);
  for_each_side([&](std::uint32_t from, const SortedSide& side) {
    sorted.sides[counter(from).fetch_sub(1, std::memory_order_relaxed) - 1] = side;
  });
  // Sorted, so that the order does not depend on the number of threads.
  for_each_index(vertex.size(), [&](std::size_t from) {
    std::ranges::sort(std::span(sorted.sides).subspan(sorted.first[from], sorted.first[from + 1] - sorted.first[from]));
  });
  return sorted;
}

}  // namespace penumbra::mesh
