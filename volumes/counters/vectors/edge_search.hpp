// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/vectors/trees.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/lights/device_light.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"
#include "volumes/wedges/penumbra_wedge.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Structures over receivers that list the edges relevant to a view sample. Inside volumes/ only.
namespace penumbra::volumes {

/// Search for candidates of silhouettes.
enum class Search : std::uint8_t {
  hierarchy,  ///< a hierarchy over edges, traversed with the shaft from a cluster of view samples to the light (used by
              ///< default)
  kd_tree,    ///< Lehtinen et al. 2006: a kd-tree over the space of receivers, with the wedges that meet each cell
  hemicube,   ///< Laine et al. 2005: a grid on a cube around the light's centre, with the wedges that appear in each
              ///< cell
};

struct EdgeSearchInput {
  const visibility::SceneFloats& scene;
  const visibility::Light& light;
  const visibility::DeviceLight& frame;  ///< scaled
  const vectors::WideEdgeTree& tree;     ///< edges that the counters use, scaled
  float scale;
  const visibility::ViewSamples& samples;
};

/// A structure over the wedges of all edges that may be silhouettes as seen from some point of the light. Planar
/// lights only.
class EdgeSearch {
 public:
  EdgeSearch(Search search, const EdgeSearchInput& input);

  /// Returns the number of wedges in p's cell.
  [[nodiscard]] std::size_t count(const glm::vec3& p) const;
  /// Finds the leaves of the edge tree (with TriangleTree::kLeafBit) that contain all edges that may affect these view
  /// samples, ascending. In addition to the cell's edges: edges of triangles that are coplanar with a carrier, since
  /// such triangles do not count there, and edges that were cut at the light's plane.
  void find_leaves(std::span<const glm::vec3> p, std::span<const std::uint32_t> planes,
                   std::vector<std::uint32_t>& leaves) const;

  [[nodiscard]] std::size_t wedge_count() const { return leaves_of_.begin.size() - 1; }
  [[nodiscard]] std::size_t entry_count() const { return entries_.size(); }
  [[nodiscard]] std::size_t cell_count() const { return cells_; }
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  /// A list for each index.
  struct Lists {
    std::vector<std::uint32_t> begin{0}, of;
    [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t i) const {
      return std::span(of).subspan(begin[i], begin[i + 1] - begin[i]);
    }
  };
  /// A node of the kd-tree, or of a face's quadtree. Wedges that contain a whole cell, or that were not divided
  /// further, are stored at the node.
  struct Node {
    std::uint32_t first = 0, count = 0;  ///< range of entries_
    std::uint32_t children = 0;          ///< 0: a leaf
    int axis = 0;
    double split = 0;
  };

  void map_leaves(const EdgeSearchInput& input, const std::vector<std::array<glm::dvec3, 2>>& edges);
  void build_kd_tree(const EdgeSearchInput& input, const std::vector<Wedge>& wedges);
  void build_hemicube(const std::vector<std::array<glm::dvec3, 2>>& edges, std::span<const glm::dvec3> light);
  void divide(std::uint32_t node, const Box& box, std::span<const Wedge> wedges, std::span<const std::uint32_t> list,
              std::vector<std::uint32_t>& pixels, const visibility::ViewSamples& samples, int depth);
  template <typename Visit>
  void for_each_list(const glm::vec3& p, const Visit& visit) const;
  [[nodiscard]] std::size_t cell_of(const glm::vec3& p) const;

  Search search_;
  glm::dvec3 center_{0};
  Lists leaves_of_, leaves_of_plane_;
  std::vector<std::uint32_t> always_;   // leaves
  std::vector<Node> nodes_;             // nodes of the kd-tree
  std::vector<std::uint32_t> entries_;  // wedges
  Lists cells_of_;                      // of the hemicube: entries of each cell
  std::size_t cells_ = 0;
};

}  // namespace penumbra::volumes
