// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/buffer.hpp"
#include "render/device.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/tree_texels.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::device {

/// A method's additions to triangles; empty: none.
struct TriangleNotes {
  std::span<const std::uint32_t> tags;  ///< for each triangle, bits that are OR-ed to the index of its plane
  std::span<const std::int8_t> turns;   ///< −1: the triangle's second and third corner are exchanged
};

/// A hierarchy of triangles on the device, scaled: two texels for each child of a node (visibility::node_texels); for
/// each slot of each leaf, one texel in each of three lists: (a, triangle), (b, plane and tag), (c, light whose body it
/// is).
class TriangleUpload {
 public:
  void prepare(const render::Device& device, const visibility::SceneFloats& scene, const visibility::TriangleTree& tree,
               float scale, const TriangleNotes& notes = {});

  [[nodiscard]] const render::Buffer& nodes() const { return *nodes_; }
  [[nodiscard]] const render::Buffer& corners(std::size_t i) const { return *corners_[i]; }
  /// Nodes that a method may change and write again.
  [[nodiscard]] std::vector<visibility::Texel>& node_texels() { return node_texels_; }
  void write_nodes() { nodes_->write(std::span<const visibility::Texel>(node_texels_)); }

 private:
  std::vector<visibility::Texel> node_texels_;
  std::optional<render::Buffer> nodes_;
  std::array<std::optional<render::Buffer>, 3> corners_;
};

}  // namespace penumbra::device
