// SPDX-License-Identifier: Apache-2.0
// Host of find_leaves.comp: runs the pass, and grows its lists of chunks of leaves until they fit.

#include "vsm/leaf_lists.hpp"

#include "vsm/find_leaves.comp.spv.hpp"
#include "vsm/uploads.hpp"

#include <utility>

namespace penumbra::vsm {
namespace {

constexpr std::uint32_t kFirstChunks = 1U << 15;  // initial capacity, which grows

}  // namespace

LeafLists::LeafLists(const render::Device& device, std::string method)
    : device_(&device), method_(std::move(method)), chunks_(device, {"leaf lists", sizeof(Head), 0, kFirstChunks}) {}

void LeafLists::prepare_mesh(const visibility::SceneFloats& scene, float scale) {
  scene_ = &scene;
  walk_.reset();
  closed_ = find_closed_parts(scene);
  tags_ = part_tags(closed_);
  parts_.emplace(
      render::make_buffer<Texel>(*device_, "closed parts", part_texels(closed_, scale), render::BufferUse::texels));
}

void LeafLists::prepare_light(const visibility::TriangleTree& tree, const visibility::DeviceLight& frame, float scale,
                              device::TriangleUpload& triangles) {
  depth_ = tree.depth;
  parts_apart_ = parts_apart_from(closed_, frame, scale);
  if (parts_apart_ == 0) return;
  mark_dispensable(tree, find_dispensable(closed_, *scene_, frame, scale), triangles.node_texels());
  triangles.write_nodes();
}

void LeafLists::build_pass(const std::vector<std::uint32_t>& constants) {
  pass_.emplace(*device_, render::ComputePassOptions{.name = "find leaves",
                                                     .spirv = shaders::kFindLeavesComp,
                                                     .push_bytes = sizeof(gpu::ViewSamplePush),
                                                     .constants = constants,
                                                     .full_subgroups = true});
  constexpr std::uint64_t kChunkHead = 2;  // words, as in view_sample.glsl
  chunks_.set_item_bytes((kChunkHead + constants[6]) * sizeof(std::uint32_t));
}

device::Attempt LeafLists::find(render::Commands& commands, gpu::ViewSamplePush& push, const LeafListInput& input,
                                std::uint64_t blocks) {
  if (!chunks_.is_possible()) {
    chunks_.shrink();
    return device::Attempt::too_large;
  }
  chunks_.clear(commands);
  push.chunk_capacity = chunks_.capacity();
  push.part_levels = walk_.levels();
  push.closed_parts = parts_apart_;
  times_.clear();
  Head head;
  for (push.part = 0; push.part < walk_.parts() && head.unfinished == 0; ++push.part) {
    pass_->record(commands, push,
                  {input.view, input.table, input.masks, input.questions, chunks_.buffer(), input.nodes, *parts_},
                  blocks);
    const std::vector<visibility::PassTime> part = commands.submit();
    times_.insert(times_.end(), part.begin(), part.end());
    head = chunks_.head<Head>();
  }
  was_cut_off_ = head.unfinished != 0;
  if (was_cut_off_) {
    walk_.go_deeper({method_, device_->info().name, scene_->triangles.size(), depth_});
    return device::Attempt::again;
  }
  push.chunk_capacity = head.chunks;
  return chunks_.holds(head.chunks) ? device::Attempt::done : device::Attempt::again;
}

}  // namespace penumbra::vsm
