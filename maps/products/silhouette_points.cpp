// SPDX-License-Identifier: Apache-2.0
// Computes silhouette points in cells of a map: P. Sen, M. Cammarano, P. Hanrahan, Shadow silhouette maps, SIGGRAPH
// 2003, section 4.1. Departures: edges are traversed on the host, not drawn as quads; of several edges in a cell the
// nearest counts (the paper keeps the last that is not hidden), so that the result does not depend on the order of
// triangles; points are floats, not bytes.

#include "maps/products/silhouette_points.hpp"

#include "maps/host/map_fit.hpp"
#include "mesh/edge_graph.hpp"
#include "mesh/silhouettes.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace penumbra::maps {
namespace {

/// Part [from, to] of the segment from a to b in a cell; kept() returns the fraction, from a to b, of the point that it
/// keeps.
struct Passage {
  glm::dvec2 a, b;  ///< the edge's ends, relative to the cell's lower corner
  double from, to;

  [[nodiscard]] glm::dvec2 at(double share) const { return glm::mix(a, b, share); }
};

std::optional<double> kept(const Passage& passage) {
  if (passage.from <= 0) return 0;
  if (passage.to >= 1) return 1;
  double sum = 0;
  int count = 0;
  for (const double sign : {1.0, -1.0}) {
    const auto off = [&](const glm::dvec2& p) { return sign > 0 ? p.y - p.x : p.x + p.y - 1; };
    const double here = off(passage.at(passage.from)), there = off(passage.at(passage.to));
    if ((here > 0) == (there > 0)) continue;
    sum += passage.from + (passage.to - passage.from) * here / (here - there);
    ++count;
  }
  return count == 0 ? std::nullopt : std::optional(sum / count);
}

/// Returns the part of the segment from a to b in [0, count]²; nullopt if it is empty.
std::optional<std::pair<double, double>> clipped(const glm::dvec2& a, const glm::dvec2& b, double count) {
  double from = 0, to = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double direction = b[axis] - a[axis];
    if (direction == 0) {
      if (a[axis] < 0 || a[axis] > count) return std::nullopt;
      continue;
    }
    const double first = -a[axis] / direction, last = (count - a[axis]) / direction;
    from = std::max(from, std::min(first, last));
    to = std::min(to, std::max(first, last));
  }
  return from < to ? std::optional(std::pair(from, to)) : std::nullopt;
}

/// Returns the part of an edge in front of `near`, in the face's coordinates.
std::optional<std::pair<glm::dvec3, glm::dvec3>> in_front(glm::dvec3 a, glm::dvec3 b, double near) {
  if (a.z < near && b.z < near) return std::nullopt;
  const glm::dvec3 cut = a + (b - a) * ((near - a.z) / (b.z - a.z));
  if (a.z < near) a = cut;
  if (b.z < near) b = cut;
  return std::pair(a, b);
}

}  // namespace

void add_silhouette(const SilhouetteEnd& one, const SilhouetteEnd& other, std::uint32_t count,
                    std::vector<SilhouettePoint>& cells) {
  // Rounding depends on the order of the ends: a fixed order makes the result independent of the caller's.
  const auto place = [](const SilhouetteEnd& end) { return std::tuple(end.at.x, end.at.y, end.depth); };
  const bool turned = place(other) < place(one);
  const SilhouetteEnd &a = turned ? other : one, &b = turned ? one : other;
  const auto part = clipped(a.at, b.at, count);
  if (!part) return;
  // All fractions of the segment at which it passes from a cell to the next.
  std::vector<double> borders{part->first, part->second};
  for (int axis = 0; axis < 2; ++axis) {
    const double direction = b.at[axis] - a.at[axis];
    if (direction == 0) continue;
    const double first = a.at[axis] + part->first * direction, last = a.at[axis] + part->second * direction;
    for (double line = std::ceil(std::min(first, last)); line <= std::max(first, last); ++line)
      borders.push_back(std::clamp((line - a.at[axis]) / direction, part->first, part->second));
  }
  std::ranges::sort(borders);
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    if (!(borders[i] < borders[i + 1])) continue;
    const glm::dvec2 middle = glm::mix(a.at, b.at, 0.5 * (borders[i] + borders[i + 1]));
    const glm::dvec2 cell = glm::clamp(glm::floor(middle), 0.0, count - 1.0);
    const Passage passage{a.at - cell, b.at - cell, borders[i], borders[i + 1]};
    const auto share = kept(passage);
    if (!share) continue;
    // 1/depth is linear across the face.
    const double depth = 1 / glm::mix(1 / a.depth, 1 / b.depth, *share);
    const glm::dvec2 at = glm::clamp(passage.at(*share), 0.0, 1.0);
    SilhouettePoint& known = cells[static_cast<std::size_t>(cell.y) * count + static_cast<std::size_t>(cell.x)];
    const auto order = [](const SilhouettePoint& point) { return std::tuple(point.depth, point.at.x, point.at.y); };
    const SilhouettePoint found{at, depth};
    if (known.depth == 0 || order(found) < order(known)) known = found;
  }
}

void SilhouettePoints::record(render::Commands& /*commands*/, const MapSet& maps) {
  gpu::LightView view{};
  maps.views.read<gpu::LightView>(std::span(&view, 1));
  std::vector<visibility::Triangle> casters;
  for (std::uint32_t i = 0; i < maps.scene.triangles.size(); ++i) {
    if (maps.scene.casts_shadow[i] != 0 && maps.scene.emits[i] != maps.light.index)
      casters.push_back(maps.scene.triangles[i]);
  }
  const std::vector<glm::dvec3> positions = mesh::widened(maps.scene.positions);
  const mesh::MeshView mesh{positions, casters};
  const mesh::EdgeGraph graph = mesh::build_edge_graph(mesh);
  const glm::dvec3 centre(view.point);
  const std::vector<mesh::SilhouetteEdge> silhouettes = mesh::silhouette_edges(mesh, graph, centre);
  edges_ = silhouettes.size();
  cells_ = 0;
  const std::uint32_t count = maps.size + 1;
  std::vector<glm::vec2> points;
  for (std::uint32_t number = 0; number < std::max(maps.faces, 1U); ++number) {
    std::vector<SilhouettePoint> cells(std::size_t{count} * count);
    if (number < maps.faces) {
      const Face face = face_of(view, maps.basis, number);
      const glm::dvec2 texel = (face.upper - face.lower) / static_cast<double>(maps.size);
      const double near = static_cast<double>(view.far) * static_cast<double>(kNearOfFar);
      const auto turned = [&](std::uint32_t vertex) {
        const glm::dvec3 d = positions[vertex] - centre;
        return glm::dvec3(glm::dot(face.a, d), glm::dot(face.b, d), glm::dot(face.w, d));
      };
      // A cell's corners are texels' centres, and the first cell begins before the first of them.
      const auto end_of = [&](const glm::dvec3& at) {
        return SilhouetteEnd{(glm::dvec2(at) / at.z - face.lower) / texel + 0.5, at.z};
      };
      for (const mesh::SilhouetteEdge& silhouette : silhouettes) {
        const mesh::Edge& edge = graph.edges[silhouette.edge];
        if (const auto part = in_front(turned(edge.a), turned(edge.b), near))
          add_silhouette(end_of(part->first), end_of(part->second), count, cells);
      }
    }
    for (const SilhouettePoint& cell : cells) {
      points.emplace_back(cell.at);
      if (cell.depth != 0) ++cells_;
    }
  }
  render::grow(*device_, points_, "silhouette points", points.size() * sizeof(glm::vec2));
  points_->write<glm::vec2>(points);
}

void SilhouettePoints::add_counters(std::map<std::string, std::uint64_t>& counters) const {
  counters["silhouetteEdges"] = edges_;
  counters["silhouetteCells"] = cells_;
}

}  // namespace penumbra::maps
