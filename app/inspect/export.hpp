#pragma once

#include "app/inspect/examine.hpp"
#include "mesh/soup_ply.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::app {

/// All triangles of a soup with the bad ones coloured, bad edges as coloured edges, and bad vertices.
struct MarkedMesh {
  struct Point {
    glm::dvec3 position;
    mesh::Color color;
  };
  mesh::PlyMesh ply;
  std::vector<Point> points;
};

/// `report` must list every place. What several defects claim has the colour of the one that comes last in the legend.
MarkedMesh mark_defects(const mesh::TriangleSoup& soup, const ObjectReport& report);

/// Writes its triangles and edges as PLY.
void export_defects(const std::filesystem::path& file, const mesh::TriangleSoup& soup, const ObjectReport& report);

/// The colours, one defect a line.
std::string defect_legend();

}  // namespace penumbra::app
