#pragma once

#include "repair/steps.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

/// Inside repair/ only: soups as CGAL's meshes. Whatever includes this is GPL.
namespace penumbra::repair {

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalPoint = CgalKernel::Point_3;
using CgalMesh = CGAL::Surface_mesh<CgalPoint>;

/// CGAL states its complaints on stderr before it throws; here they become sentences, so while this lives it is quiet.
class QuietCgal {
 public:
  QuietCgal();
  QuietCgal(const QuietCgal&) = delete;
  QuietCgal& operator=(const QuietCgal&) = delete;
  ~QuietCgal();

 private:
  CGAL::Failure_function error_, warning_;
};

/// The mesh, or those triangles of it: vertex i is position i, and each face knows its triangle. Throws what CGAL
/// throws, and std::logic_error if CGAL does not take a face.
struct CgalSurface {
  CgalMesh mesh;
  CgalMesh::Property_map<CgalMesh::Face_index, std::uint32_t> triangle;  ///< kNew for faces made since

  static constexpr std::uint32_t kNew = 0xffffffffu;
};
CgalSurface to_cgal(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles);
CgalSurface to_cgal(const TriangleSoup& soup);

/// A face's vertices, counter-clockwise.
std::array<CgalMesh::Vertex_index, 3> corners(const CgalMesh& mesh, CgalMesh::Face_index face);

/// Pairs of faces that meet elsewhere than in common points. (CGAL also counts those that only touch where a vertex was
/// split in two.)
std::vector<std::pair<CgalMesh::Face_index, CgalMesh::Face_index>> intersections(const CgalMesh& mesh);

/// The parts of a soup that are connected through edges, which triangles share by their indices; numbered by their
/// first triangles. (closed_components.hpp has those of a mesh whose equal positions are one vertex.)
struct SurfaceParts {
  std::vector<std::uint32_t> of_triangle;
  std::vector<std::vector<std::uint32_t>> triangles;
  std::vector<bool> closed;
};
SurfaceParts surface_parts(const TriangleSoup& soup);

}  // namespace penumbra::repair
