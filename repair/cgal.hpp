// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "repair/steps.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

/// Inside repair/ only: conversion between soups and CGAL's meshes. Every file that includes this header is under the
/// GPL.
namespace penumbra::repair {

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalPoint = CgalKernel::Point_3;
using CgalMesh = CGAL::Surface_mesh<CgalPoint>;

/// Suppresses CGAL's messages on stderr during its lifetime: CGAL prints its complaints before it throws, and the
/// exceptions become sentences here.
class QuietCgal {
 public:
  QuietCgal();
  QuietCgal(const QuietCgal&) = delete;
  QuietCgal& operator=(const QuietCgal&) = delete;
  ~QuietCgal();

 private:
  CGAL::Failure_function error_, warning_;
};

/// The mesh, or some of its triangles: vertex i is position i, and each face has the index of its triangle. Making it
/// throws CGAL's exceptions, and std::logic_error if CGAL refuses a face.
struct CgalSurface {
  CgalMesh mesh;
  CgalMesh::Property_map<CgalMesh::Face_index, std::uint32_t> triangle;  ///< kNew for faces made later

  static constexpr std::uint32_t kNew = 0xffffffffu;
};
CgalSurface to_cgal(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles);
CgalSurface to_cgal(const TriangleSoup& soup);

/// Returns a face's vertices, counter-clockwise.
std::array<CgalMesh::Vertex_index, 3> corners(const CgalMesh& mesh, CgalMesh::Face_index face);

/// Returns pairs of faces that meet elsewhere than in common points. (CGAL also counts pairs that only touch where a
/// vertex was split in two.)
std::vector<std::pair<CgalMesh::Face_index, CgalMesh::Face_index>> intersections(const CgalMesh& mesh);

/// The parts of a soup that are connected through edges, which triangles share by their indices; numbered by their
/// first triangles. (closed_components.hpp has the parts of a mesh whose equal positions are merged.)
struct SurfaceParts {
  std::vector<std::uint32_t> of_triangle;
  std::vector<std::vector<std::uint32_t>> triangles;
  std::vector<bool> closed;
};
SurfaceParts surface_parts(const TriangleSoup& soup);

}  // namespace penumbra::repair
