// SPDX-License-Identifier: Apache-2.0
// Merges equal positions of a mesh and divides it into connected parts.

#include "import/gltf/emitters/welded.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace penumbra::import {
namespace {

/// Returns the triangle with the same winding, beginning at its lowest corner.
mesh::Triangle from_least(const mesh::Triangle& t) {
  const auto least = static_cast<std::size_t>(std::ranges::min_element(t) - t.begin());
  return {t[least], t[(least + 1) % 3], t[(least + 2) % 3]};
}

}  // namespace

Welded weld(std::span<const glm::dvec3> positions, std::span<const mesh::Triangle> triangles) {
  Welded welded;
  std::map<std::tuple<double, double, double>, std::uint32_t> numbers;
  const auto number_of = [&](std::uint32_t index) {
    const glm::dvec3& p = positions[index];
    const auto next = static_cast<std::uint32_t>(welded.points.size());
    const auto [entry, is_new] = numbers.try_emplace({p.x, p.y, p.z}, next);
    if (is_new) welded.points.push_back(p);
    return entry->second;
  };
  std::set<mesh::Triangle> known;
  for (const mesh::Triangle& t : triangles) {
    const mesh::Triangle w{number_of(t[0]), number_of(t[1]), number_of(t[2])};
    if (w[0] == w[1] || w[1] == w[2] || w[2] == w[0]) continue;
    if (known.insert(from_least(w)).second) welded.triangles.push_back(w);
  }
  return welded;
}

Welded part_of(const Welded& mesh, std::span<const std::size_t> triangles) {
  Welded part;
  std::map<std::uint32_t, std::uint32_t> numbers;
  for (const std::size_t triangle : triangles) {
    mesh::Triangle& own = part.triangles.emplace_back(mesh.triangles[triangle]);
    for (std::uint32_t& point : own) {
      const auto [entry, is_new] = numbers.try_emplace(point, static_cast<std::uint32_t>(part.points.size()));
      if (is_new) part.points.push_back(mesh.points[point]);
      point = entry->second;
    }
  }
  return part;
}

std::vector<Welded> components_of(const Welded& mesh) {
  std::vector<std::uint32_t> parent(mesh.points.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root_of = [&](std::uint32_t point) {
    while (parent[point] != point) point = parent[point] = parent[parent[point]];
    return point;
  };
  for (const mesh::Triangle& t : mesh.triangles) {
    parent[root_of(t[1])] = root_of(t[0]);
    parent[root_of(t[2])] = root_of(t[0]);
  }
  std::vector<std::vector<std::size_t>> lists;
  std::map<std::uint32_t, std::size_t> list_of;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [entry, is_new] = list_of.try_emplace(root_of(mesh.triangles[i][0]), lists.size());
    if (is_new) lists.emplace_back();
    lists[entry->second].push_back(i);
  }
  std::vector<Welded> components;
  for (const std::vector<std::size_t>& list : lists) components.push_back(part_of(mesh, list));
  return components;
}

}  // namespace penumbra::import
