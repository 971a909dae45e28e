// SPDX-License-Identifier: Apache-2.0
// Divides an emitting mesh into flat convex parts (Hertel and Mehlhorn 1983; convex_parts.hpp describes the
// differences).

#include "import/gltf/emitters/convex_parts.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>

namespace penumbra::import {
namespace {

using Loop = std::vector<std::uint32_t>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Returns the area vector times two, computed relative to the loop's first point, so that nothing cancels far from the
/// origin.
glm::dvec3 vector_area(const Welded& mesh, const Loop& loop) {
  const glm::dvec3 first = mesh.points[loop[0]];
  glm::dvec3 sum(0);
  for (std::size_t i = 1; i + 1 < loop.size(); ++i)
    sum += glm::cross(mesh.points[loop[i]] - first, mesh.points[loop[i + 1]] - first);
  return sum;
}

class Parts {
 public:
  Parts(const Welded& mesh, double rounding) : mesh_(mesh), rounding_(rounding) {
    for (const mesh::Triangle& t : mesh.triangles) {
      const Loop loop(t.begin(), t.end());
      const glm::dvec3 area = vector_area(mesh, loop);
      double longest = 0;
      for (std::size_t i = 0; i < 3; ++i)
        longest = std::max(longest, glm::distance(mesh.points[t[i]], mesh.points[t[(i + 1) % 3]]));
      if (!(glm::length(area) > 4 * rounding * longest)) continue;  // its height is within the rounding
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [entry, is_new] = owner_.try_emplace({t[i], t[(i + 1) % 3]}, loops_.size());
        if (!is_new) entry->second = kNone;  // two triangles on one side of an edge: such an edge joins nothing
      }
      loops_.push_back(loop);
      normals_.push_back(glm::normalize(area));
    }
    parent_.resize(loops_.size());
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  void join() {
    struct Candidate {
      double length;
      Edge edge;
    };
    std::vector<Candidate> candidates;
    for (const auto& [edge, owner] : owner_) {
      if (edge.first > edge.second || owner == kNone) continue;
      const auto other = owner_.find({edge.second, edge.first});
      if (other == owner_.end() || other->second == kNone) continue;
      candidates.push_back({glm::distance(mesh_.points[edge.first], mesh_.points[edge.second]), edge});
    }
    std::ranges::sort(candidates, [](const Candidate& a, const Candidate& b) {
      return a.length != b.length ? a.length > b.length : a.edge < b.edge;
    });
    // A join that is not convex now may become convex once its neighbours are joined.
    for (std::size_t before = 0; before != candidates.size();) {
      before = candidates.size();
      std::erase_if(candidates, [&](const Candidate& candidate) { return join_at(candidate.edge) != Joined::later; });
    }
  }

  [[nodiscard]] std::vector<ConvexPart> parts() const {
    std::vector<ConvexPart> parts;
    for (std::size_t i = 0; i < loops_.size(); ++i) {
      if (parent_[i] == i) parts.push_back({loops_[i], normals_[i]});
    }
    return parts;
  }

 private:
  static constexpr auto kNone = static_cast<std::size_t>(-1);
  enum class Joined { now, never, later };

  std::size_t root_of(std::size_t part) {
    while (parent_[part] != part) part = parent_[part] = parent_[parent_[part]];
    return part;
  }

  Joined join_at(const Edge& edge) {
    const std::size_t a = root_of(owner_.at(edge)), b = root_of(owner_.at({edge.second, edge.first}));
    if (a == b || glm::dot(normals_[a], normals_[b]) <= 0) return Joined::never;
    std::optional<Loop> loop = union_of(loops_[a], loops_[b], edge);
    if (!loop) return Joined::later;
    const glm::dvec3 area = vector_area(mesh_, *loop);
    if (!(glm::length(area) > 0)) return Joined::later;
    const glm::dvec3 normal = glm::normalize(area);
    if (!is_flat(*loop, normal)) return Joined::never;
    if (!is_convex(*loop, normal)) return Joined::later;
    parent_[b] = a;
    loops_[a] = *std::move(loop);
    normals_[a] = normal;
    loops_[b].clear();
    return Joined::now;
  }

  /// Returns the union of both outlines without their common edges around `edge`; nullopt if they have other edges in
  /// common.
  static std::optional<Loop> union_of(const Loop& a, const Loop& b, const Edge& edge) {
    const auto at = [](const Loop& loop, std::size_t i) { return loop[i % loop.size()]; };
    const std::size_t n = a.size(), m = b.size();
    std::size_t i = 0, j = 0;  // edge is a[i] → a[i + 1], and reversed b[j] → b[j + 1]
    while (i < n && !(a[i] == edge.first && at(a, i + 1) == edge.second)) ++i;
    while (j < m && !(b[j] == edge.second && at(b, j + 1) == edge.first)) ++j;
    if (i == n || j == m) return std::nullopt;
    std::size_t more = 0, less = 0;  // common edges after and before `edge`, in a's direction
    while (more + 2 < std::min(n, m) && at(a, i + 2 + more) == at(b, j + m - 1 - more)) ++more;
    while (more + less + 2 < std::min(n, m) && at(a, i + n - 1 - less) == at(b, j + 2 + less)) ++less;
    Loop loop;
    const std::size_t common = more + less + 1;
    for (std::size_t k = 0; k < n - common; ++k) loop.push_back(at(a, i + 1 + more + k));
    for (std::size_t k = 0; k < m - common; ++k) loop.push_back(at(b, j + 1 + less + k));
    if (loop.size() < 3 || std::set<std::uint32_t>(loop.begin(), loop.end()).size() != loop.size()) return std::nullopt;
    return loop;
  }

  [[nodiscard]] bool is_flat(const Loop& loop, const glm::dvec3& normal) const {
    glm::dvec3 center(0);
    for (const std::uint32_t point : loop) center += mesh_.points[point] / static_cast<double>(loop.size());
    return std::ranges::all_of(loop, [&](std::uint32_t point) {
      return std::abs(glm::dot(normal, mesh_.points[point] - center)) <= 4 * rounding_;  // as in flat_light.cpp
    });
  }

  /// Checks that no point lies outside any edge: checking turns alone would accept a star that winds around twice.
  [[nodiscard]] bool is_convex(const Loop& loop, const glm::dvec3& normal) const {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const glm::dvec3 from = mesh_.points[loop[i]], along = mesh_.points[loop[(i + 1) % loop.size()]] - from;
      const glm::dvec3 inward = glm::normalize(glm::cross(normal, along));
      for (const std::uint32_t point : loop) {
        if (glm::dot(inward, mesh_.points[point] - from) < -4 * rounding_) return false;
      }
    }
    return true;
  }

  const Welded& mesh_;
  double rounding_;
  std::map<Edge, std::size_t> owner_;  // for each directed edge, the triangle to its left
  std::vector<Loop> loops_;
  std::vector<glm::dvec3> normals_;
  std::vector<std::size_t> parent_;  // for each triangle, the part that it was joined to
};

}  // namespace

std::vector<ConvexPart> convex_parts(const Welded& mesh, double rounding) {
  Parts parts(mesh, rounding);
  parts.join();
  return parts.parts();
}

std::vector<std::vector<std::size_t>> flat_regions(const Welded& mesh, double rounding) {
  const std::size_t count = mesh.triangles.size();
  std::vector<glm::dvec3> normals;
  std::vector<double> sizes;  // twice the areas
  std::map<Edge, std::vector<std::size_t>> owners;
  for (std::size_t i = 0; i < count; ++i) {
    const mesh::Triangle& t = mesh.triangles[i];
    const glm::dvec3 area = vector_area(mesh, Loop(t.begin(), t.end()));
    sizes.push_back(glm::length(area));
    normals.push_back(sizes.back() > 0 ? area / sizes.back() : glm::dvec3(0));
    for (std::size_t k = 0; k < 3; ++k) owners[{t[k], t[(k + 1) % 3]}].push_back(i);
  }
  const auto flat_together = [&](std::size_t a, std::size_t b) {
    if (glm::dot(normals[a], normals[b]) <= 0) return false;
    const glm::dvec3 from = mesh.points[mesh.triangles[a][0]];
    double reach = 0;
    for (const std::uint32_t point : mesh.triangles[a])
      reach = std::max(reach, glm::distance(mesh.points[point], from));
    return std::ranges::all_of(mesh.triangles[b], [&](std::uint32_t point) {
      const glm::dvec3 direction = mesh.points[point] - from;
      // The plane through three rounded points is off by the rounding at these points. Farther away, its error grows in
      // inverse proportion to the triangle's height, which is twice its area divided by its reach.
      return std::abs(glm::dot(normals[a], direction)) <=
             4 * rounding * (1 + glm::length(direction) * reach / sizes[a]);
    });
  };
  std::vector<std::vector<std::size_t>> regions;
  std::vector<std::uint8_t> taken(count, 0);
  for (std::size_t start = 0; start < count; ++start) {
    if (taken[start] != 0) continue;
    std::vector<std::size_t>& region = regions.emplace_back();
    taken[start] = 1;
    region.push_back(start);
    for (std::size_t next = 0; next < region.size(); ++next) {
      const std::size_t here = region[next];
      const mesh::Triangle& t = mesh.triangles[here];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto across = owners.find({t[(k + 1) % 3], t[k]});
        if (across == owners.end()) continue;
        for (const std::size_t other : across->second) {
          if (taken[other] != 0 || !flat_together(here, other)) continue;
          taken[other] = 1;
          region.push_back(other);
        }
      }
    }
  }
  return regions;
}

}  // namespace penumbra::import
