// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/buffer.hpp"
#include "render/device.hpp"
#include "volumes/edges/cut_walk.hpp"
#include "volumes/edges/edge_tree.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace penumbra::volumes {

/// A hierarchy of edges on the device (EdgeTexels) that is cut at a light's plane, and restored for the next light.
/// Only parts that the plane cuts are recomputed and written: subtrees behind it are removed, and cut edges form a
/// second tree below a common root. CutEdges is its twin on vector units.
class EdgeUpload {
 public:
  EdgeUpload(const render::Device& device, EdgeTexels texels);

  void cut(const CutInput& input);
  void restore();

  /// Returns the texels on the device; nodes at the end may be unused.
  [[nodiscard]] const EdgeTexels& texels() const { return texels_; }
  [[nodiscard]] std::uint32_t root() const { return root_; }
  [[nodiscard]] std::uint32_t depth() const { return texels_.depth; }  ///< levels from the root; 0: no edges
  [[nodiscard]] const render::Buffer& nodes() const { return *nodes_; }
  [[nodiscard]] const render::Buffer& slots(std::size_t i) const { return *slots_[i]; }

 private:
  using Texels = std::vector<visibility::Texel>;
  class Dropping;

  void append(const EdgeTexels& more);
  void add_root(std::uint32_t first, std::uint32_t second);
  /// Updates `buffer` at the texels in `changed`, and from `first_new` on.
  void write(std::unique_ptr<render::Buffer>& buffer, const char* name, const Texels& texels,
             std::vector<std::uint32_t> changed, std::size_t first_new) const;
  void write_all(const std::vector<std::uint32_t>& nodes, const std::vector<std::uint32_t>& slots);

  const render::Device* device_;
  EdgeTexels texels_;
  std::uint32_t root_ = 0, whole_depth_ = 0;
  std::size_t whole_nodes_ = 0, whole_slots_ = 0;  // sizes in texels
  bool is_cut_ = false;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> dropped_nodes_;  // texel, and its previous reference
  std::vector<std::uint32_t> dropped_slots_;
  std::unique_ptr<render::Buffer> nodes_;
  std::array<std::unique_ptr<render::Buffer>, 6> slots_;
};

}  // namespace penumbra::volumes
