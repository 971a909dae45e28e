#pragma once

#include "app/inspect/examine.hpp"
#include "mesh/soup_ply.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::app {

/// All triangles of a soup with defective ones coloured, defective edges as coloured edges, and defective vertices.
struct MarkedMesh {
  struct Point {
    glm::dvec3 position;
    mesh::Color color;
  };
  mesh::PlyMesh ply;
  std::vector<Point> points;
};

/// Returns the marked mesh. `report` must list every location. An element with several defects has the colour of the
/// last of these in the legend.
MarkedMesh mark_defects(const mesh::TriangleSoup& soup, const ObjectReport& report);

/// Writes the marked triangles and edges as PLY.
void export_defects(const std::filesystem::path& file, const mesh::TriangleSoup& soup, const ObjectReport& report);

/// Returns the colours, one line for each defect.
std::string defect_legend();

}  // namespace penumbra::app
