// SPDX-License-Identifier: Apache-2.0
// Meshes and their defects as messages of the 3D view.

#include "app/view/space_meshes.hpp"

#include "app/inspect/export.hpp"
#include "app/view/space_message.hpp"
#include "mesh/diagnosis/diagnosis.hpp"
#include "session/inspect/examine.hpp"

#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

namespace penumbra::app {
namespace {

using nlohmann::ordered_json;

/// Returns for each position the first one in its cell of a grid of `cells` along the longest side.
std::vector<std::uint32_t> firsts_of_cells(std::span<const glm::vec3> positions, double cells) {
  glm::dvec3 lower(positions.front()), upper(lower);
  for (const glm::vec3& p : positions) {
    lower = glm::min(lower, glm::dvec3(p));
    upper = glm::max(upper, glm::dvec3(p));
  }
  const glm::dvec3 extent = upper - lower;
  const double scale = cells / std::max({extent.x, extent.y, extent.z, 1e-300});
  std::unordered_map<std::uint64_t, std::uint32_t> first;
  std::vector<std::uint32_t> firsts;
  firsts.reserve(positions.size());
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    const glm::dvec3 cell = scale * (glm::dvec3(positions[i]) - lower);
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) key = (key << 21U) | static_cast<std::uint64_t>(cell[k]);
    firsts.push_back(first.try_emplace(key, i).first->second);
  }
  return firsts;
}

void append(std::vector<float>& numbers, const glm::dvec3& point) {
  for (int k = 0; k < 3; ++k) numbers.push_back(static_cast<float>(point[k]));
}

std::uint32_t packed_color(const mesh::Color& color) {
  return std::uint32_t{color[0]} << 16U | std::uint32_t{color[1]} << 8U | color[2];
}

/// Places of defects, as sent.
struct ShownDefects {
  std::vector<float> lines, points, triangles;
  std::vector<std::uint32_t> line_colors, point_colors, triangle_colors;

  void add(const MarkedMesh& marked, const glm::dvec3& origin) {
    const std::vector<glm::dvec3>& at = marked.ply.positions;
    for (const mesh::PlyEdge& edge : marked.ply.edges) {
      append(lines, at[edge.a] - origin);
      append(lines, at[edge.b] - origin);
      line_colors.push_back(packed_color(edge.color));
    }
    for (const MarkedMesh::Point& point : marked.points) {
      append(points, point.position - origin);
      point_colors.push_back(packed_color(point.color));
    }
    for (std::size_t i = 0; i < marked.ply.triangles.size(); ++i) {
      if (marked.ply.triangle_colors[i] == kSoundColor) continue;
      for (const std::uint32_t corner : marked.ply.triangles[i]) append(triangles, at[corner] - origin);
      triangle_colors.push_back(packed_color(marked.ply.triangle_colors[i]));
    }
  }
};

}  // namespace

ShownTriangles shown_triangles(std::span<const glm::vec3> positions, std::span<const mesh::Triangle> triangles,
                               std::span<const std::uint32_t> objects, std::size_t most) {
  ShownTriangles shown;
  shown.positions.assign(positions.begin(), positions.end());
  shown.triangles.assign(triangles.begin(), triangles.end());
  shown.objects.assign(objects.begin(), objects.end());
  for (double cells = 1024; shown.triangles.size() > most && cells >= 1; cells /= 2) {
    const std::vector<std::uint32_t> firsts = firsts_of_cells(positions, cells);
    shown.triangles.clear();
    shown.objects.clear();
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const auto& [a, b, c] = triangles[i];
      const mesh::Triangle merged = {firsts[a], firsts[b], firsts[c]};
      if (merged[0] == merged[1] || merged[1] == merged[2] || merged[2] == merged[0]) continue;
      shown.triangles.push_back(merged);
      shown.objects.push_back(objects[i]);
    }
  }
  if (shown.triangles.size() == triangles.size()) return shown;
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> new_index(positions.size(), kUnused);
  shown.positions.clear();
  for (mesh::Triangle& triangle : shown.triangles) {
    for (std::uint32_t& corner : triangle) {
      std::uint32_t& index = new_index[corner];
      if (index == kUnused) {
        index = static_cast<std::uint32_t>(shown.positions.size());
        shown.positions.push_back(positions[corner]);
      }
      corner = index;
    }
  }
  return shown;
}

std::string meshes_message(const scenes::Scene& scene, const visibility::SceneFloats& floats) {
  // The soup's own corners, in their order: a triangle's winding determines its front side.
  const ShownTriangles shown =
      shown_triangles(floats.positions, scene.soup.triangles, scene.soup.object, kMostShownTriangles);
  auto objects = ordered_json::array();
  for (const scenes::Object& object : scene.objects) {
    objects.push_back({{"name", object.name},
                       {"color", {object.color.x, object.color.y, object.color.z}},
                       {"castsShadow", object.casts_shadow},
                       {"emits", object.emits.has_value()}});
  }
  SpaceMessage message;
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float) && sizeof(mesh::Triangle) == 3 * sizeof(std::uint32_t));
  message.add("positions", {&shown.positions.data()->x, 3 * shown.positions.size()});
  message.add("triangles", {shown.triangles.data()->data(), 3 * shown.triangles.size()});
  message.add("objects", shown.objects);
  const auto listed = [](const glm::dvec3& p) { return ordered_json{p.x, p.y, p.z}; };
  return message.finish({{"origin", listed(floats.origin)},
                         {"lower", listed(floats.origin + glm::dvec3(floats.lower))},
                         {"upper", listed(floats.origin + glm::dvec3(floats.upper))},
                         {"triangles", scene.soup.triangles.size()},
                         {"shown", shown.triangles.size()},
                         {"objects", std::move(objects)}});
}

std::string defects_message(const scenes::Scene& scene, const glm::dvec3& origin) {
  ShownDefects shown;
  std::map<std::string_view, DefectKind> kinds;
  session::ObjectParts parts(scene.soup, scene.objects.size());
  for (std::size_t object = 0; object < scene.objects.size(); ++object) {
    const mesh::TriangleSoup part = parts.soup_of(object);
    if (part.triangles.empty()) continue;
    session::ObjectReport report;
    report.diagnosis = mesh::diagnose({part.positions, part.triangles},
                                      {.search_intersections = false, .list_limit = kMostShownDefects});
    shown.add(mark_defects(part, report), origin);
    for (const DefectKind& kind : kinds_of_defects(report.diagnosis)) {
      const auto [found, is_new] = kinds.try_emplace(kind.what, kind);
      if (!is_new) found->second.count += kind.count;
    }
  }
  auto listed = ordered_json::array();
  for (const auto& [what, kind] : kinds) {
    if (kind.count != 0) listed.push_back({{"what", what}, {"color", packed_color(kind.color)}, {"count", kind.count}});
  }
  SpaceMessage message;
  message.add("lines", shown.lines);
  message.add("lineColors", shown.line_colors);
  message.add("points", shown.points);
  message.add("pointColors", shown.point_colors);
  message.add("triangles", shown.triangles);
  message.add("triangleColors", shown.triangle_colors);
  return message.finish({{"kinds", std::move(listed)}});
}

}  // namespace penumbra::app
