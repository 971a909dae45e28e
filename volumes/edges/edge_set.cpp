// SPDX-License-Identifier: Apache-2.0
// Records of signed edges: an edge with the planes of two of its triangles, computed on demand from positions and
// casters.

#include "volumes/edges/edge_set.hpp"

#include "base/pages.hpp"
#include "base/parallel.hpp"
#include "mesh/predicates.hpp"
#include "mesh/sorted_sides.hpp"
#include "volumes/edges/plane_normal.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace penumbra::volumes {
namespace {

using visibility::SceneFloats;

/// Returns the scene triangle's normal in double, from its sorted corners.
glm::dvec3 normal_of(const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 a(corners[0]);
  return glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
}

/// Returns for each plane the largest of its exactly coplanar triangles. `triangles` are in ascending order.
std::vector<std::uint32_t> largest_in_planes(const SceneFloats& scene, std::span<const std::uint32_t> triangles) {
  const auto size_of = [&](std::uint32_t triangle) {
    const glm::dvec3 n = normal_of(scene.corners(triangle));
    return glm::dot(n, n);
  };
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> largest;
  resize_on_all_cores(largest, scene.triangles.size());
  for_each_index(largest.size(), [&](std::size_t plane) { largest[plane] = kNone; });
  // A plane has the index of a triangle in it: usually its only triangle, else its first.
  for_each_index(triangles.size(), [&](std::size_t i) {
    if (scene.plane[triangles[i]] == triangles[i]) largest[triangles[i]] = triangles[i];
  });
  std::vector<std::uint32_t> others;
  std::ranges::copy_if(triangles, std::back_inserter(others),
                       [&](std::uint32_t triangle) { return scene.plane[triangle] != triangle; });
  std::vector<double> sizes(others.size());
  for_each_index(others.size(), [&](std::size_t i) { sizes[i] = size_of(others[i]); });
  std::uint32_t known = kNone;  // plane that `size` belongs to: the size of its largest triangle so far
  double size = 0;
  for (std::size_t i = 0; i < others.size(); ++i) {
    const std::uint32_t plane = scene.plane[others[i]];
    if (plane != std::exchange(known, plane)) size = largest[plane] == kNone ? -1.0 : size_of(largest[plane]);
    if (!(sizes[i] > size)) continue;
    largest[plane] = others[i];
    size = sizes[i];
  }
  for_each_index(largest.size(), [&](std::size_t plane) {
    if (largest[plane] == kNone) largest[plane] = 0;
  });
  return largest;
}

/// Returns whether two coplanar triangles have the same orientation, tested at points off their plane.
bool turned_alike(const SceneFloats& scene, std::uint32_t x, std::uint32_t y) {
  if (x == y) return true;
  const std::array<glm::vec3, 3> a = scene.corners(x), b = scene.corners(y);
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 q = a[0];
    q[axis] += 1 + std::abs(q[axis]);
    const mesh::Side side = mesh::side_of_plane(a[0], a[1], a[2], q);
    if (side != mesh::Side::on) return side == mesh::side_of_plane(b[0], b[1], b[2], q);
  }
  return true;
}

}  // namespace

EdgeCasters edge_casters(const SceneFloats& scene, std::int32_t light_index) {
  EdgeCasters casters;
  casters.triangle.reserve(scene.triangles.size());
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.casts_shadow[i] == 0 || (light_index >= 0 && scene.emits[i] == light_index)) continue;
    casters.triangle.push_back(i);
  }
  casters.largest_in_plane = largest_in_planes(scene, casters.triangle);
  return casters;
}

EdgeSide plane_of(const SceneFloats& scene, const EdgeCasters& casters, std::uint32_t triangle) {
  const std::uint32_t plane = scene.plane[triangle], chosen = casters.largest_in_plane[plane];
  const std::array<glm::vec3, 3> corners = scene.corners(chosen);
  const glm::vec3 n = rounded_normal(corners);
  return {turned_alike(scene, triangle, chosen) ? n : -n, corners[0], plane};
}

EdgeRecords::EdgeRecords(const SceneFloats& scene, const EdgeCasters& casters, Flat flat)
    : scene_(&scene), casters_(&casters) {
  const std::size_t count = casters.triangle.size();
  planes_.resize(count);
  find_planes();
  std::vector<mesh::Triangle> chosen;
  if (count < scene.triangles.size()) {
    chosen.resize(count);
    for_each_index(count, [&](std::size_t i) { chosen[i] = scene.triangles[casters.triangle[i]]; });
  }
  find_pairs(count < scene.triangles.size() ? chosen : scene.triangles, flat);
  if (flat == Flat::kept) keep_places();
}

void EdgeRecords::keep_places() {
  kept_.places = scene_->positions;
  kept_.casters = casters_->triangle;
  kept_.largest.resize(planes_.size());
  kept_.corners.resize(planes_.size());
  kept_.moved.assign(planes_.size(), 1);
  for_each_index(planes_.size(), [&](std::size_t i) {
    kept_.largest[i] = casters_->largest_in_plane[planes_[i].plane];
    kept_.corners[i] = scene_->triangles[casters_->triangle[i]];
  });
}

/// Marks the casters of which a corner has moved since the last frame, or a corner of the triangle that they take their
/// plane from. Returns false if vertices were merged or separated.
bool EdgeRecords::find_moved() {
  const SceneFloats& scene = *scene_;
  std::vector<std::uint8_t> other(scene.positions.size());
  for_each_index(other.size(), [&](std::size_t i) {
    other[i] = kept_.places[i] != scene.positions[i] ? 1 : 0;
    kept_.places[i] = scene.positions[i];
  });
  std::vector<std::uint8_t> itself(scene.triangles.size());
  for_each_index(planes_.size(), [&](std::size_t i) {
    const auto& corners = scene.triangles[casters_->triangle[i]];
    const bool same = kept_.corners[i] == corners && (other[corners[0]] | other[corners[1]] | other[corners[2]]) == 0;
    itself[casters_->triangle[i]] = same ? 0 : 1;
    kept_.corners[i] = corners;
  });
  for_each_index(planes_.size(), [&](std::size_t i) {
    const std::uint32_t triangle = casters_->triangle[i], plane = scene.plane[triangle];
    const std::uint32_t largest = casters_->largest_in_plane[plane];
    const bool same =
        itself[triangle] == 0 && itself[largest] == 0 && kept_.largest[i] == largest && planes_[i].plane == plane;
    kept_.moved[i] = same ? 0 : 1;
    kept_.largest[i] = largest;
  });
  std::vector<std::uint32_t> vertex = mesh::merge_equal(std::span(scene.positions));
  std::swap(kept_.vertex, vertex);
  return vertex == kept_.vertex;
}

void EdgeRecords::find_planes() {
  for_each_index(planes_.size(), [&](std::size_t i) {
    if (kept_.moved.empty() || kept_.moved[i] != 0) planes_[i] = plane_of(*scene_, *casters_, casters_->triangle[i]);
  });
}

/// Returns a side of an edge a→b: in front where (a, b, apex) runs counter-clockwise.
EdgeSide EdgeRecords::side(std::uint32_t of) const {
  if (of == kNoSide) return {};
  EdgeSide side = planes_[of & ~kReversed];
  if ((of & kReversed) != 0) side.n = -side.n;  // n refers to the sorted corners of a triangle
  return side;
}

/// Returns whether k_e is 0 for every p: whether the two triangles are in one plane, on either side of the edge.
bool EdgeRecords::is_flat(const Pair& pair) const {
  if (pair.sides[1] == kNoSide) return false;
  const std::uint32_t plane = scene_->plane[triangle_of(pair.sides[0])];
  if (plane == SceneFloats::kNoPlane || plane != scene_->plane[triangle_of(pair.sides[1])]) return false;
  return glm::dot(side(pair.sides[0]).n, side(pair.sides[1]).n) < 0;
}

void EdgeRecords::find_pairs(std::span<const mesh::Triangle> triangles, Flat flat) {
  std::vector<std::uint32_t> vertex = mesh::merge_equal(std::span(scene_->positions));
  const mesh::SortedSides sorted = mesh::sort_sides(vertex, triangles);
  const auto for_each_pair = [&](std::size_t from, bool wanted_flat, const auto& visit) {
    const std::span<const mesh::SortedSide> here = sorted.from(from);
    const auto coded = [&](const mesh::SortedSide& side) {
      const std::uint32_t triangle = side.number / 3;
      const bool reversed = vertex[triangles[triangle][side.number % 3]] != from;
      return triangle | (reversed ? kReversed : 0U);
    };
    for (std::size_t i = 0; i < here.size(); ++i) {
      Pair pair{static_cast<std::uint32_t>(from), here[i].other, {coded(here[i]), kNoSide}};
      if (i + 1 < here.size() && here[i + 1].other == pair.b) pair.sides[1] = coded(here[++i]);
      if (is_flat(pair) == wanted_flat) visit(pair);
    }
  };
  std::vector<std::uint32_t> first(vertex.size() + 1, 0);
  const auto append = [&](bool wanted_flat) {
    std::ranges::fill(first, 0U);
    for_each_index(vertex.size(),
                   [&](std::size_t from) { for_each_pair(from, wanted_flat, [&](const Pair&) { ++first[from]; }); });
    auto pairs = static_cast<std::uint32_t>(pairs_.size());
    for (std::uint32_t& number : first) pairs += std::exchange(number, pairs);
    pairs_.resize(pairs);
    for_each_index(vertex.size(), [&](std::size_t from) {
      std::uint32_t next = first[from];
      for_each_pair(from, wanted_flat, [&](const Pair& pair) { pairs_[next++] = pair; });
    });
  };
  append(false);
  size_ = pairs_.size();
  if (flat == Flat::dropped) return;
  append(true);
  kept_.vertex = std::move(vertex);
}

/// Returns whether both ends are still corners of both triangles. Updates the triangles' orientations, which depend on
/// sorted positions.
bool EdgeRecords::follow(Pair& pair, std::span<const std::uint32_t> vertex) const {
  for (std::uint32_t& side : pair.sides) {
    if (side == kNoSide) continue;
    const mesh::Triangle& corners = scene_->triangles[triangle_of(side)];
    const std::array<std::uint32_t, 3> at{vertex[corners[0]], vertex[corners[1]], vertex[corners[2]]};
    const auto runs = [&](std::uint32_t from, std::uint32_t to) {
      return (at[0] == from && at[1] == to) || (at[1] == from && at[2] == to) || (at[2] == from && at[0] == to);
    };
    side &= ~kReversed;
    if (runs(pair.b, pair.a))
      side |= kReversed;
    else if (!runs(pair.a, pair.b))
      return false;
  }
  return true;
}

/// Returns Followed::nothing unless the casters are the same, and each side of each caster is still at the same edge.
/// Then no edge is new, and edges have the same sides in the same order, by triangle index.
EdgeRecords::Followed EdgeRecords::follow(const SceneFloats& scene, const EdgeCasters& casters) {
  if (casters.triangle != kept_.casters || scene.positions.size() != kept_.places.size()) return Followed::nothing;
  scene_ = &scene;
  casters_ = &casters;
  const bool same_vertices = find_moved();
  std::atomic<bool> same = true;
  for_each_index(pairs_.size(), [&](std::size_t i) {
    if (same_vertices && !has_moved(i)) return;
    if (!follow(pairs_[i], kept_.vertex)) same.store(false, std::memory_order_relaxed);
  });
  if (!same) return Followed::nothing;
  find_planes();
  const auto before = size_;
  const auto flat = pairs_.begin() + static_cast<std::ptrdiff_t>(size_);
  const auto bends = [&](const Pair& pair) { return !is_flat(pair); };
  const auto moves = [&](const Pair& pair) { return has_moved(pair); };
  auto bent = std::partition(flat, pairs_.end(), bends);
  // If much of the moving surface bends, the rest of it is flat by chance, and some of it would bend in each of the
  // next frames: then all of it becomes records. Otherwise few records are added, and the hierarchy hardly grows and
  // need not be rebuilt.
  constexpr std::ptrdiff_t kMuch = 8;
  const std::ptrdiff_t moved = std::count_if(flat, pairs_.end(), moves);
  if (bent > flat && (kMuch * (bent - flat) > moved || kMuch * moved < flat - pairs_.begin()))
    bent = std::partition(bent, pairs_.end(), moves);
  size_ = static_cast<std::size_t>(bent - pairs_.begin());
  return size_ > before ? Followed::more : Followed::all;
}

EdgeRecord EdgeRecords::operator[](std::size_t record) const {
  const Pair& pair = pairs_[record];
  return {scene_->positions[pair.a], scene_->positions[pair.b], {side(pair.sides[0]), side(pair.sides[1])}};
}

std::array<glm::vec3, 2> EdgeRecords::normals(std::size_t record) const {
  const Pair& pair = pairs_[record];
  return {side(pair.sides[0]).n, side(pair.sides[1]).n};
}

visibility::Bounds EdgeRecords::box(std::size_t record) const {
  const Pair& pair = pairs_[record];
  const glm::vec3 &from = scene_->positions[pair.a], &to = scene_->positions[pair.b];
  return {glm::min(from, to), glm::max(from, to)};
}

std::vector<EdgeRecord> edge_records(const SceneFloats& scene, const EdgeCasters& casters) {
  const EdgeRecords records(scene, casters);
  std::vector<EdgeRecord> all(records.size());
  for_each_index(all.size(), [&](std::size_t i) { all[i] = records[i]; });
  return all;
}

}  // namespace penumbra::volumes
