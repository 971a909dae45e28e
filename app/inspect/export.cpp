// SPDX-License-Identifier: Apache-2.0
// Colours defects and writes them as PLY.

#include "app/inspect/export.hpp"

#include "mesh/soup_ply.hpp"
#include "session/inspect/report.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace penumbra::app {
namespace {

using mesh::Color;
using mesh::Diagnosis;

constexpr Color kIntersection = {150, 0, 0};

struct Legend {
  mesh::Defect Diagnosis::*counted;
  std::string_view what, color_name;
  Color color;
  bool faces, edges;   ///< coloured elements
  bool point = false;  ///< the first point of a location is a vertex to be marked
};

/// Legend in increasing order of severity.
constexpr std::array<Legend, 9> kLegend = {{
    {&Diagnosis::needles, "needles", "green", {60, 170, 60}, true, false},
    {&Diagnosis::duplicate_faces, "duplicate faces", "blue", {40, 80, 220}, true, false},
    {&Diagnosis::opposite_faces, "opposite faces", "cyan", {0, 190, 210}, true, false},
    {&Diagnosis::non_manifold_vertices,
     "non-manifold vertices: the triangles there",
     "violet",
     {150, 60, 200},
     true,
     false,
     true},
    {&Diagnosis::zero_area_triangles, "zero-area triangles", "black", {0, 0, 0}, true, true},
    {&Diagnosis::t_junctions, "T-junctions: the edge", "yellow", {240, 220, 0}, false, true, true},
    {&Diagnosis::inconsistent_windings, "inconsistent windings: the edge", "orange", {250, 140, 0}, false, true},
    {&Diagnosis::boundary_edges, "boundary edges", "red", {255, 0, 0}, false, true},
    {&Diagnosis::non_manifold_edges, "non-manifold edges", "magenta", {255, 0, 200}, false, true},
}};

/// Adds an edge with two new points, which avoids a search for the soup's vertices at its ends.
void add_edge(mesh::PlyMesh& ply, const glm::dvec3& a, const glm::dvec3& b, Color color) {
  const auto first = static_cast<std::uint32_t>(ply.positions.size());
  ply.positions.push_back(a);
  ply.positions.push_back(b);
  ply.edges.push_back({first, first + 1, color});
}

/// Adds the edges of a defect: of a T-junction, the edge between its second and third point (the first is the vertex);
/// of any other defect, the edges between all points in turn.
void add_edges(mesh::PlyMesh& ply, const mesh::DefectPlace& place, const Legend& legend) {
  const std::size_t first = legend.counted == &Diagnosis::t_junctions ? 1 : 0;
  for (std::size_t i = first; i + 1 < place.points.size(); ++i) {
    add_edge(ply, place.points[i], place.points[i + 1], legend.color);
  }
}

}  // namespace

MarkedMesh mark_defects(const mesh::TriangleSoup& soup, const session::ObjectReport& report) {
  MarkedMesh marked;
  mesh::PlyMesh& ply = marked.ply;
  ply.positions = soup.positions;
  ply.triangles = soup.triangles;
  ply.triangle_colors.assign(soup.triangles.size(), kSoundColor);
  if (report.diagnosis.self_intersections) {
    for (const mesh::DefectPlace& place : report.diagnosis.self_intersections->first) {
      for (const std::uint32_t triangle : place.triangles) ply.triangle_colors[triangle] = kIntersection;
    }
  }
  for (const Legend& legend : kLegend) {
    for (const mesh::DefectPlace& place : (report.diagnosis.*legend.counted).first) {
      if (legend.edges) add_edges(ply, place, legend);
      if (legend.point && !place.points.empty()) marked.points.push_back({place.points.front(), legend.color});
      if (!legend.faces) continue;
      for (const std::uint32_t triangle : place.triangles) ply.triangle_colors[triangle] = legend.color;
    }
  }
  return marked;
}

void export_defects(const std::filesystem::path& file, const mesh::TriangleSoup& soup,
                    const session::ObjectReport& report) {
  mesh::write_ply(file, mark_defects(soup, report).ply);
}

std::vector<DefectKind> kinds_of_defects(const mesh::Diagnosis& diagnosis) {
  std::vector<DefectKind> kinds;
  for (const Legend& legend : kLegend)
    kinds.push_back({legend.what.substr(0, legend.what.find(':')), legend.color, (diagnosis.*legend.counted).count});
  return kinds;
}

std::string defect_legend() {
  std::string text = "  grey       no defect\n  dark red   self-intersecting triangles\n";
  for (const Legend& legend : kLegend) text += fmt::format("  {:<9}  {}\n", legend.color_name, legend.what);
  return text;
}

}  // namespace penumbra::app
