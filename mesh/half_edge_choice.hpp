// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/half_edge_view.hpp"

#include <cstdint>
#include <vector>

namespace penumbra::mesh {

/// Triangles that a half-edge structure can hold, and their windings. Inside mesh/ only.
struct HeldTriangles {
  static constexpr std::uint32_t kNotHeld = 0xffffffffu;

  std::vector<std::uint32_t> patch;  ///< for each triangle, its component among the held ones; kNotHeld if it is listed
                                     ///< instead
  std::vector<bool> turn;            ///< for each triangle: true if its winding is reversed
  std::vector<ListedFace> listed;    ///< ascending
  std::uint32_t patches = 0;
};

HeldTriangles choose_held(const EdgeGraph& graph);

/// For each corner (3 · triangle + corner) of a held triangle, its fan: corners at one point that are connected through
/// edges of two held triangles. Fans are numbered in the order of their first corners.
struct HeldFans {
  std::vector<std::uint32_t> of_corner;  ///< kNotHeld where the triangle is not held
  std::vector<std::uint32_t> point;      ///< for each fan, the edge graph's vertex
};

HeldFans find_held_fans(const MeshView& mesh, const EdgeGraph& graph, const HeldTriangles& held);

}  // namespace penumbra::mesh
