// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/device/growing_list.hpp"
#include "engines/device/mask_method.hpp"
#include "engines/device/part_walk.hpp"
#include "render/commands.hpp"
#include "render/compute_pass.hpp"
#include "render/device.hpp"
#include "visibility/lights/device_light.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "vsm/closed_parts.hpp"
#include "vsm/view_sample.shared.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::vsm {

/// Buffers that find_leaves.comp reads and writes besides its lists.
struct LeafListInput {
  const render::Buffer& view;
  const render::Buffer& table;  ///< SampleTable
  const render::Buffer& masks;
  const render::Buffer& questions;
  const render::Buffer& nodes;
};

/// Lists, for each block of pixels, the leaves of the tree of triangles that the shaft from the block's view samples to
/// the light meets, in chunks; closed parts of the scene save triangles. The pass also decides light samples that need
/// no triangles: by the light's plane and the horizon.
class LeafLists {
 public:
  /// `method` names the method in errors.
  LeafLists(const render::Device& device, std::string method);

  /// Finds closed parts.
  void prepare_mesh(const visibility::SceneFloats& scene, float scale);
  [[nodiscard]] device::TriangleNotes notes() const { return {tags_, closed_.turn}; }
  /// Marks in `triangles` those that are dispensable for this light. `frame` is scaled by `scale`.
  void prepare_light(const visibility::TriangleTree& tree, const visibility::DeviceLight& frame, float scale,
                     device::TriangleUpload& triangles);
  /// `constants`: the pass's specialization constants, of which the seventh is the number of leaves in a chunk.
  void build_pass(const std::vector<std::uint32_t>& constants);

  /// Makes the lists of the `blocks` blocks that `push` describes, and sets push.chunk_capacity to the number of
  /// chunks.
  [[nodiscard]] device::Attempt find(render::Commands& commands, gpu::ViewSamplePush& push, const LeafListInput& input,
                                     std::uint64_t blocks);

  [[nodiscard]] const render::Buffer& chunks() const { return chunks_.buffer(); }
  // Pass times of the last find().
  [[nodiscard]] const std::vector<visibility::PassTime>& times() const { return times_; }
  [[nodiscard]] bool was_cut_off() const { return was_cut_off_; }  ///< whether a driver ended a loop

 private:
  struct Head {
    std::uint32_t chunks = 0, unfinished = 0;
  };

  const render::Device* device_;
  std::string method_;
  std::optional<render::ComputePass> pass_;

  const visibility::SceneFloats* scene_ = nullptr;
  std::uint32_t depth_ = 0;  // depth of the tree
  ClosedParts closed_;
  std::vector<std::uint32_t> tags_;  // tags of triangles (part_tags)
  std::optional<render::Buffer> parts_;
  std::uint32_t parts_apart_ = 0;  // bit k: closed part k is separate from the light

  device::GrowingList chunks_;
  device::PartWalk walk_;
  bool was_cut_off_ = false;
  std::vector<visibility::PassTime> times_;
};

}  // namespace penumbra::vsm
