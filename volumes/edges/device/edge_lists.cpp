// SPDX-License-Identifier: Apache-2.0
// Host of find_edges.comp: prepares the hierarchies of edges and triangles for a light, runs the pass, and grows its
// lists until they fit.

#include "volumes/edges/device/edge_lists.hpp"

#include "base/assert.hpp"
#include "render/features.hpp"
#include "volumes/edges/device/find_edges.comp.spv.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra::volumes {
namespace {

using visibility::TriangleTree;

constexpr std::uint32_t kBlock = 8, kClusters = 4;  // as in edge_scatter.glsl
constexpr std::uint32_t kFirstWords = 1U << 20;

std::uint64_t blocks(const EdgeListInput& input) {
  return std::uint64_t{(input.width + kBlock - 1) / kBlock} * ((input.band.row_count + kBlock - 1) / kBlock);
}

}  // namespace

EdgeLists::EdgeLists(const render::Device& device, std::string method, bool crops)
    : device_(&device),
      method_(std::move(method)),
      sides_(method_),
      crops_(crops),
      lists_(device, {"edge lists", sizeof(Head), sizeof(std::uint32_t), kFirstWords}) {
  render::require_features(device.info(), shaders::kFindEdgesComp, "find edges");  // checked now; the pass is made when
                                                                                   // the light is known
}

void EdgeLists::prepare_mesh(const visibility::SceneFloats& scene, const TriangleTree& tree, float scale) {
  scene_ = &scene;
  tree_ = &tree;
  scale_ = scale;
  walk_.reset();
  sides_.prepare_mesh(scene);
  const EdgeRecords records = sides_.records();
  edge_count_ = records.size();
  whole_.emplace(*device_, edge_texels(records, tree, scale_));
  without_body_.reset();
  back_.reset();
  front_ = &*whole_;
}

void EdgeLists::prepare_light(const visibility::Light& light, const visibility::DeviceLight& frame) {
  PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first: {}", light.name);
  light_ = &light;
  frame_ = frame;
  prepare_edges();
  touch_ = visibility::find_touch(*scene_, *tree_, light);
  build_pass();
}

/// Prepares the edges of all casters, without the light's body if it has one, and cut at the light's plane if something
/// lies behind it.
void EdgeLists::prepare_edges() {
  const LightEdges edges = sides_.prepare_light(*light_, frame_, scale_);
  is_cut_ = edges.front.has_value();
  back_is_used_ = edges.back.has_value();
  const EdgeUpload* before = front_;
  front_->restore();
  if (edges.has_body && !(without_body_ && without_body_->light == light_->index)) {
    without_body_.emplace(
        WithoutBody{light_->index, EdgeUpload(*device_, edge_texels(sides_.records(), *tree_, scale_))});
    before = nullptr;
  }
  front_ = edges.has_body ? &without_body_->edges : &*whole_;
  if (before != front_) back_.reset();
  const auto input = [&](const LightSide& side) {
    return CutInput{*scene_, *tree_, sides_.casters(), edges.has_body ? light_->index : -1, side};
  };
  if (edges.back) {
    if (!back_) back_.emplace(*device_, front_->texels());
    back_->cut(input(*edges.back));
  }
  if (edges.front) front_->cut(input(*edges.front));
}

/// Chooses the size of the traversal's stack. Nodes are taken in depth-first order, one for each team at a time, and
/// each adds at most seven more than it removes. Cut edges add a level to a hierarchy, and may be many. The size is
/// rounded up, so that few scenes need different passes.
void EdgeLists::build_pass() {
  const std::uint32_t lanes = device_->limits().subgroup_size, of_teams = std::max(lanes, TriangleTree::kWidth);
  const std::uint32_t depth = std::max({tree_->depth, whole_->depth(), front_->depth(), back_ ? back_->depth() : 0U});
  const std::uint32_t levels = (depth + 3) / 4 * 4 + 10;
  const std::vector<std::uint32_t> constants{lanes, lanes, of_teams * levels, crops_ ? 1U : 0U};
  if (pass_ && constants == constants_) return;
  pass_.emplace(*device_, render::ComputePassOptions{.name = "find edges",
                                                     .spirv = shaders::kFindEdgesComp,
                                                     .push_bytes = sizeof(gpu::ScatterPush),
                                                     .constants = constants,
                                                     .full_subgroups = true});
  constants_ = constants;
}

void EdgeLists::describe(gpu::ScatterPush& push, const EdgeListInput& input) const {
  for (int i = 0; i < 3; ++i) {
    push.center[i] = frame_.center[i];
    push.u[i] = frame_.u[i];
    push.v[i] = frame_.v[i];
  }
  push.deviation = frame_.deviation;
  push.reach = visibility::reach_of(*scene_, frame_, scale_);
  push.cut_reach = is_cut_ ? 4 * push.reach : 0;
  push.side = input.side;
  push.keeps_rest = light_->two_sided ? 1 : 0;
  push.light = static_cast<std::uint32_t>(light_->index);
  push.width = input.width;
  push.first_row = input.view.place_of(input.tile.first_row + input.band.first_row);
  push.row_count = input.band.row_count;
  push.first_pixel = input.band.first_row * input.width;
  push.triangle_depth = tree_->depth;
  push.edge_depth = of_side(input.side).depth();
  push.edge_root = of_side(input.side).root();
  push.near_plane = touch_.any_near ? 1 : 0;
  std::uint64_t rows = 0;
  for (const std::uint32_t sample : touch_.samples) {
    rows |=
        light_->rows >= 1 && light_->rows <= 64 ? std::uint64_t{1} << (sample / light_->columns) : ~std::uint64_t{0};
  }
  push.touched_low = static_cast<std::uint32_t>(rows);
  push.touched_high = static_cast<std::uint32_t>(rows >> 32U);
}

bool EdgeLists::find(render::Commands& commands, gpu::ScatterPush& push, const EdgeListInput& input) {
  describe(push, input);
  const std::uint64_t pixels = std::uint64_t{input.band.row_count} * input.width;
  render::grow(*device_, heads_, "heads of lists", blocks(input) * kClusters * 8 + pixels * 4);
  for (retries_ = 0;; ++retries_) {
    if (!lists_.is_possible()) {
      lists_.shrink();
      return false;
    }
    const Head head = walk(commands, push, input);
    if (head.unfinished != 0) {
      walk_.go_deeper({method_, device_->info().name, scene_->triangles.size(),
                       std::max(tree_->depth, of_side(input.side).depth())});
    } else if (lists_.holds(head.words)) {
      words_ = head.words;
      return true;
    }
  }
}

EdgeLists::Head EdgeLists::walk(render::Commands& commands, gpu::ScatterPush& push, const EdgeListInput& input) {
  push.list_capacity = lists_.capacity();
  push.part_levels = walk_.levels();
  lists_.clear(commands);
  times_.clear();
  std::vector<render::BufferReference> buffers = inputs(input);
  buffers.insert(buffers.begin() + 3, {of_side(input.side).nodes(), input.triangles.nodes()});
  Head head;
  for (push.part = 0; push.part < walk_.parts(); ++push.part) {
    pass_->record(commands, std::as_bytes(std::span(&push, 1)), buffers, blocks(input));
    const std::vector<visibility::PassTime> part = commands.submit();
    times_.insert(times_.end(), part.begin(), part.end());
    head = lists_.head<Head>();
    if (head.unfinished != 0) break;
  }
  return head;
}

std::vector<render::BufferReference> EdgeLists::inputs(const EdgeListInput& input) const {
  std::vector<render::BufferReference> buffers{input.view.buffer(), *heads_, lists_.buffer()};
  for (std::size_t i = 0; i < 6; ++i) buffers.emplace_back(of_side(input.side).slots(i));
  for (std::size_t i = 0; i < 3; ++i) buffers.emplace_back(input.triangles.corners(i));
  return buffers;
}

}  // namespace penumbra::volumes
