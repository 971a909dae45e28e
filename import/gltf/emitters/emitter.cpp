// SPDX-License-Identifier: Apache-2.0
// Recognises emissive meshes as area lights: flat convex outlines, spheres, or several convex parts.

#include "import/gltf/emitters/emitter.hpp"

#include "import/gltf/emitters/convex_parts.hpp"
#include "import/gltf/emitters/flat_light.hpp"
#include "import/gltf/emitters/sphere_light.hpp"
#include "import/gltf/emitters/welded.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace penumbra::import {
namespace {

using Piece = scenes::Pieces::Piece;

/// A connected mesh.
struct Component {
  Welded mesh;
  bool closed = false;   ///< every edge has two triangles, which are consistently wound
  bool outward = false;  ///< the fronts of the triangles are outside
};

/// Winds all triangles consistently; returns nullopt unless each edge has two triangles and such a winding exists, that
/// is, unless the mesh is closed.
std::optional<Welded> wound_alike(const Welded& mesh) {
  using Side = std::pair<std::uint32_t, std::uint32_t>;
  std::map<Side, std::vector<std::size_t>> triangles_of;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
      triangles_of[std::minmax(a, b)].push_back(i);
    }
  }
  if (std::ranges::any_of(triangles_of, [](const auto& edge) { return edge.second.size() != 2; })) return std::nullopt;
  Welded wound = mesh;
  const auto runs = [&](std::size_t triangle, const Side& edge) {  // returns whether the triangle traverses the edge
                                                                   // from first to second
    const mesh::Triangle& t = wound.triangles[triangle];
    for (std::size_t k = 0; k < 3; ++k) {
      if (t[k] == edge.first && t[(k + 1) % 3] == edge.second) return true;
    }
    return false;
  };
  std::vector<bool> seen(mesh.triangles.size(), false);
  for (std::size_t start = 0; start < seen.size(); ++start) {  // parts that only touch in a point are wound separately
    if (seen[start]) continue;
    std::vector<std::size_t> open{start};
    seen[start] = true;
    while (!open.empty()) {
      const std::size_t triangle = open.back();
      open.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = wound.triangles[triangle][k], b = wound.triangles[triangle][(k + 1) % 3];
        const auto& both = triangles_of.at(std::minmax(a, b));
        const std::size_t other = both[0] == triangle ? both[1] : both[0];
        if (!seen[other]) {
          if (runs(other, {a, b})) std::swap(wound.triangles[other][1], wound.triangles[other][2]);
          seen[other] = true;
          open.push_back(other);
        } else if (runs(other, {a, b})) {
          return std::nullopt;  // a Klein bottle, or an edge that occurs twice
        }
      }
    }
  }
  return wound;
}

/// Returns the winding number of the mesh around x (van Oosterom and Strackee 1983): for a closed mesh 1 inside, 0
/// outside.
double winding_number(const Welded& mesh, const glm::dvec3& x) {
  double sum = 0;
  for (const mesh::Triangle& t : mesh.triangles) {
    const glm::dvec3 a = mesh.points[t[0]] - x, b = mesh.points[t[1]] - x, c = mesh.points[t[2]] - x;
    const double p = glm::length(a), q = glm::length(b), r = glm::length(c);
    sum += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                          p * q * r + glm::dot(a, b) * r + glm::dot(b, c) * p + glm::dot(c, a) * q);
  }
  return sum / (4 * std::numbers::pi);
}

double volume_of(const Welded& mesh) {
  double sum = 0;
  for (const mesh::Triangle& t : mesh.triangles) {
    const glm::dvec3 o = mesh.points[0];
    sum += glm::dot(mesh.points[t[0]] - o, glm::cross(mesh.points[t[1]] - o, mesh.points[t[2]] - o));
  }
  return sum / 6;
}

void turn(Welded& mesh) {
  for (mesh::Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

std::vector<Component> outward_components(const Welded& mesh, bool two_sided) {
  std::vector<Component> components;
  for (Welded& part : components_of(mesh)) {
    Component one{std::move(part)};
    if (auto wound = wound_alike(one.mesh)) {
      const bool as_it_was = wound->triangles == one.mesh.triangles;
      one.closed = two_sided || as_it_was;
      if (two_sided) {
        one.mesh = *std::move(wound);
        if (volume_of(one.mesh) < 0) turn(one.mesh);
      }
      one.outward = one.closed && volume_of(one.mesh) > 0;
    }
    components.push_back(std::move(one));
  }
  std::vector<bool> enclosed(components.size(), false);
  for (std::size_t i = 0; i < components.size(); ++i) {
    for (std::size_t k = 0; k < components.size() && !enclosed[i]; ++k) {
      if (k == i || !components[k].outward) continue;
      const auto inside = [&](const glm::dvec3& x) { return winding_number(components[k].mesh, x) > 0.5; };
      enclosed[i] = std::ranges::all_of(components[i].mesh.points, inside);
    }
  }
  std::vector<Component> seen;
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (!enclosed[i]) seen.push_back(std::move(components[i]));
  }
  return seen;
}

/// Removes one of two triangles that are equal except for their winding: if both emit to both sides, one is enough.
Welded without_backs(const Welded& mesh) {
  std::map<std::array<std::uint32_t, 3>, std::size_t> known;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<std::uint32_t, 3> corners = mesh.triangles[i];
    std::ranges::sort(corners);
    if (known.try_emplace(corners, i).second) kept.push_back(i);
  }
  return kept.size() == mesh.triangles.size() ? mesh : part_of(mesh, kept);
}

Piece piece_of(FlatLight&& shape) {
  if (auto* rectangle = std::get_if<scenes::Rectangle>(&shape)) return *rectangle;
  return std::get<scenes::Polygon>(std::move(shape));
}

void add_flat_pieces(const Welded& mesh, double rounding, std::vector<Piece>& pieces) {
  for (const std::vector<std::size_t>& triangles : flat_regions(mesh, rounding)) {
    if (pieces.size() > kMostPieces) return;  // more pieces are not needed: the mesh is refused
    const Welded region = part_of(mesh, triangles);
    FlatLight whole = recognise_flat_light(region, rounding);
    if (!std::holds_alternative<std::string>(whole)) {
      pieces.push_back(piece_of(std::move(whole)));
      continue;
    }
    for (const ConvexPart& part : convex_parts(region, rounding)) {
      std::vector<glm::dvec3> corners;
      for (const std::uint32_t point : part.outline) corners.push_back(region.points[point]);
      FlatLight shape = light_of_outline(corners, part.normal, rounding);
      // Convex only within the rounding: the polygon is kept unchanged.
      pieces.push_back(std::holds_alternative<std::string>(shape) ? Piece(scenes::Polygon{std::move(corners)})
                                                                  : piece_of(std::move(shape)));
    }
  }
}

std::vector<glm::dvec3> corners_of(const Piece& piece) {
  if (const auto* r = std::get_if<scenes::Rectangle>(&piece)) {
    return {r->center - r->half_u - r->half_v, r->center + r->half_u - r->half_v, r->center + r->half_u + r->half_v,
            r->center - r->half_u + r->half_v};
  }
  if (const auto* polygon = std::get_if<scenes::Polygon>(&piece)) return polygon->vertices;
  return {};
}

Piece back_of(const Piece& piece) {
  if (const auto* r = std::get_if<scenes::Rectangle>(&piece)) return scenes::Rectangle{r->center, r->half_v, r->half_u};
  if (const auto* polygon = std::get_if<scenes::Polygon>(&piece))
    return scenes::Polygon{{polygon->vertices.rbegin(), polygon->vertices.rend()}};
  return piece;
}

/// Returns whether some piece lies on a side to which another one emits.
bool hides_itself(const std::vector<Piece>& pieces, bool two_sided, double rounding) {
  if (pieces.size() < 2) return false;
  std::vector<std::vector<glm::dvec3>> corners;
  for (const Piece& piece : pieces) corners.push_back(corners_of(piece));
  const bool ball = std::ranges::any_of(corners, [](const auto& own) { return own.empty(); });
  if (ball) return true;  // another piece exists, and a sphere emits everywhere
  for (const std::vector<glm::dvec3>& own : corners) {
    glm::dvec3 normal(0);
    double reach = 0;
    for (std::size_t i = 1; i + 1 < own.size(); ++i) {
      normal += glm::cross(own[i] - own[0], own[i + 1] - own[0]);
      reach = std::max(reach, glm::distance(own[i + 1], own[0]));
    }
    const double size = glm::length(normal);
    if (!(size > 0)) continue;
    for (const std::vector<glm::dvec3>& other : corners) {
      for (const glm::dvec3& corner : other) {
        const double height = glm::dot(normal / size, corner - own[0]);
        // The plane is known to within the rounding at the piece itself; its error grows with distance × reach / area.
        const double allowed = 8 * rounding * (1 + glm::distance(corner, own[0]) * reach / size);
        if (height > allowed || (two_sided && height < -allowed)) return true;
      }
    }
  }
  return false;
}

}  // namespace

std::variant<Emitter, std::string> recognise_emitter(std::span<const glm::dvec3> positions,
                                                     std::span<const mesh::Triangle> triangles, bool two_sided,
                                                     double rounding) {
  Welded mesh = weld(positions, triangles);
  if (two_sided) mesh = without_backs(mesh);
  std::vector<std::pair<Piece, bool>> found;  // pieces, each with whether it emits to both sides
  for (const Component& component : outward_components(mesh, two_sided)) {
    if (const auto sphere = recognise_sphere(component.mesh, rounding)) {
      found.emplace_back(*sphere, false);
      continue;
    }
    std::vector<Piece> pieces;
    add_flat_pieces(component.mesh, rounding, pieces);
    for (Piece& piece : pieces) found.emplace_back(std::move(piece), two_sided && !component.closed);
  }
  const auto emits_to_both = [](const auto& piece) { return piece.second; };
  Emitter emitter;
  emitter.two_sided = !found.empty() && std::ranges::all_of(found, emits_to_both);
  std::vector<Piece> pieces;
  for (const auto& [piece, both] : found) {
    pieces.push_back(piece);
    if (both && !emitter.two_sided) pieces.push_back(back_of(piece));  // closed meshes emit only outward
  }
  if (pieces.empty()) return "it has no area";
  if (pieces.size() > kMostPieces) {
    return fmt::format("it would be cut into more than {} flat pieces (Blender: Decimate, or separate it)",
                       kMostPieces);
  }
  emitter.hides_itself = hides_itself(pieces, emitter.two_sided, rounding);
  if (pieces.size() == 1) {
    emitter.shape = std::visit([](const auto& one) { return scenes::LightShape(one); }, pieces.front());
  } else {
    emitter.shape = scenes::Pieces{std::move(pieces)};
  }
  return emitter;
}

}  // namespace penumbra::import
