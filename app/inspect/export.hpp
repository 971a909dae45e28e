// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/soup_ply.hpp"
#include "session/inspect/examine.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::app {

/// Colour of triangles without a defect.
inline constexpr mesh::Color kSoundColor = {200, 200, 200};

/// Kind of defect that has a colour, and the number found.
struct DefectKind {
  std::string_view what;
  mesh::Color color;
  std::uint64_t count = 0;
};
/// Returns all kinds except intersections, in increasing order of severity.
std::vector<DefectKind> kinds_of_defects(const mesh::Diagnosis& diagnosis);

/// All triangles of a soup with defective ones coloured, defective edges as coloured edges, and defective vertices.
struct MarkedMesh {
  struct Point {
    glm::dvec3 position;
    mesh::Color color;
  };
  mesh::PlyMesh ply;
  std::vector<Point> points;
};

/// Returns the marked mesh. `report` must list every location. An element with several defects has the colour of
/// the one that is last in the legend.
MarkedMesh mark_defects(const mesh::TriangleSoup& soup, const session::ObjectReport& report);

/// Writes the marked triangles and edges as PLY.
void export_defects(const std::filesystem::path& file, const mesh::TriangleSoup& soup,
                    const session::ObjectReport& report);

/// Returns the colours, one line for each defect.
std::string defect_legend();

}  // namespace penumbra::app
