#pragma once

#include "render/tree_texels.hpp"
#include "volumes/edge_set.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// The hierarchies of edge scatter as a processor's vector units like them: eight children, edges or triangles side by
/// side, all numbers scaled like the device's.
namespace penumbra::volumes {

constexpr std::size_t kWide = 8;
using WideFloats = std::array<float, kWide>;
using WideWords = std::array<std::uint32_t, kWide>;
using WidePoints = std::array<WideFloats, 3>;  ///< x, y, z

struct alignas(64) WideNode {
  WidePoints middle, half;
  std::array<WideFloats, 4> cone;  ///< of normals: axis, cosine (EdgeTexels)
  WideWords reference;             ///< TriangleTree::Child::reference
  std::uint32_t used = 0;          ///< a bit a child
};

/// EdgeRecords. Unused ones have used = 0.
struct alignas(64) WideEdges {
  WidePoints a, b;
  std::array<WidePoints, 2> n, anchor;
  std::array<WideWords, 2> plane;
  std::uint32_t used = 0;
};

struct alignas(64) WideTriangles {
  std::array<WidePoints, 3> corner;
  WideWords plane, emits;  ///< the light that it is the body of
  std::uint32_t used = 0;
};

struct WideEdgeTree {
  std::vector<WideNode> nodes;
  std::vector<WideEdges> leaves;
};
struct WideTriangleTree {
  std::vector<WideNode> nodes;
  std::vector<WideTriangles> leaves;
};

WideEdgeTree wide_edge_tree(const EdgeTexels& texels);
WideTriangleTree wide_triangle_tree(const visibility::SceneFloats& scene, const visibility::TriangleTree& tree,
                                    float scale);

}  // namespace penumbra::volumes
