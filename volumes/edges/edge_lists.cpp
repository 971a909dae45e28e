#include "volumes/edges/edge_lists.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "volumes/edges/find_edges.comp.spv.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra::volumes {
namespace {

using visibility::Texel;
using visibility::TriangleTree;

constexpr std::uint32_t kBlock = 8, kClusters = 4;  // as in edge_scatter.glsl

render::Buffer make_texels(const render::Device& device, const char* name, const std::vector<Texel>& texels) {
  return render::make_buffer<Texel>(device, name, texels, render::BufferUse::texels);
}

}  // namespace

/// Head of the buffer of lists.
struct EdgeLists::Counts {
  std::uint32_t words = 0, questions = 0, unfinished = 0;
};

EdgeLists::EdgeLists(const render::Device& device, std::string method, bool crops)
    : device_(&device), method_(std::move(method)), sides_(method_), crops_(crops), view_(device) {
  const std::uint32_t lanes = device.limits().subgroup_size;
  if (lanes >= TriangleTree::kWidth && kBlock * kBlock % lanes == 0) return;
  throw ResourceError("{} needs subgroups of 8, 16, 32 or 64 lanes; {} has {}", method_, device.info().name, lanes);
}

void EdgeLists::prepare_mesh(const visibility::SceneFloats& scene) {
  scene_ = &scene;
  part_levels_ = 0;
  scale_ = visibility::device_scale(scene);
  tree_ = visibility::make_triangle_tree(scene);
  triangles_.prepare(*device_, scene, tree_, scale_);
  sides_.prepare_mesh(scene);
  const std::vector<EdgeRecord> records = sides_.records(std::nullopt);
  edge_count_ = records.size();
  whole_ = upload(records);
}

EdgeLists::SideBuffers EdgeLists::upload(const std::vector<EdgeRecord>& records) const {
  const EdgeTexels texels = edge_texels(records, scale_);
  SideBuffers side;
  side.depth = texels.depth;
  side.nodes.emplace(make_texels(*device_, "edge nodes", texels.nodes));
  for (std::size_t i = 0; i < side.slots.size(); ++i) {
    side.slots[i].emplace(make_texels(*device_, "edges", texels.slots[i]));
  }
  return side;
}

void EdgeLists::prepare_light(const visibility::Light& light, const visibility::LightFrame& frame) {
  PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first: {}", light.name);
  light_ = &light;
  frame_ = frame;
  retries_ = 0;
  const LightEdges edges = sides_.prepare_light(light, frame, scale_);
  cut_ = edges.front.has_value();
  touch_ = visibility::find_touch(*scene_, tree_, light);
  front_.reset();
  back_.reset();
  if (edges.front || edges.has_body) front_ = upload(sides_.records(edges.front));
  if (edges.back) back_ = upload(sides_.records(edges.back));
  build_pass();
}

/// Its stack: depth first, `teams` nodes at a time, each leaves at most seven more than it takes. Cut edges may deepen
/// a hierarchy.
void EdgeLists::build_pass() {
  const std::uint32_t lanes = device_->limits().subgroup_size, teams = lanes / TriangleTree::kWidth;
  const std::vector<std::uint32_t> constants{
      lanes, lanes, teams * TriangleTree::kWidth * (std::max(tree_.depth, whole_.depth) + 10), crops_ ? 1U : 0U};
  if (pass_ && constants == constants_) return;
  pass_.emplace(*device_, render::ComputePassOptions{.name = "find edges",
                                                     .spirv = shaders::kFindEdgesComp,
                                                     .push_bytes = sizeof(gpu::ScatterPush),
                                                     .constants = constants,
                                                     .full_subgroups = true});
  constants_ = constants;
}

void EdgeLists::prepare_view(const visibility::ViewSamples& samples) {
  samples_ = &samples;
  view_.prepare(samples, *scene_, scale_);
}

void EdgeLists::load(const visibility::Tile& tile) {
  tile_ = tile;
  view_.load(tile);
}

std::uint64_t EdgeLists::blocks() const {
  return std::uint64_t{(samples_->width + kBlock - 1) / kBlock} * ((tile_.row_count + kBlock - 1) / kBlock);
}

const EdgeLists::SideBuffers& EdgeLists::of_side(float side) const {
  return side < 0 && back_ ? *back_ : front_ ? *front_ : whole_;
}

void EdgeLists::describe(gpu::ScatterPush& push) const {
  for (int i = 0; i < 3; ++i) {
    push.center[i] = frame_.center[i];
    push.u[i] = frame_.u[i];
    push.v[i] = frame_.v[i];
  }
  push.deviation = frame_.deviation;
  push.reach = visibility::reach_of(*scene_, frame_, scale_);
  push.cut_reach = cut_ ? 4 * push.reach : 0;
  push.keeps_rest = light_->two_sided ? 1 : 0;
  push.light = static_cast<std::uint32_t>(light_->index);
  push.width = samples_->width;
  push.first_row = view_.place_of(tile_.first_row);
  push.row_count = tile_.row_count;
  push.block_count = static_cast<std::uint32_t>(blocks());
  push.triangle_depth = tree_.depth;
  push.near_plane = touch_.any_near ? 1 : 0;
  std::uint64_t rows = 0;
  for (const std::uint32_t sample : touch_.samples) {
    rows |=
        light_->rows >= 1 && light_->rows <= 64 ? std::uint64_t{1} << (sample / light_->columns) : ~std::uint64_t{0};
  }
  push.touched_low = static_cast<std::uint32_t>(rows);
  push.touched_high = static_cast<std::uint32_t>(rows >> 32U);
}

std::uint64_t EdgeLists::find(render::Commands& commands, gpu::ScatterPush& push, float side, std::uint32_t keep) {
  const SideBuffers& edges = of_side(side);
  describe(push);
  push.side = side;
  push.edge_depth = edges.depth;
  const std::uint64_t pixels = std::uint64_t{tile_.row_count} * samples_->width;
  render::grow(*device_, heads_, "heads of lists", blocks() * kClusters * 8 + pixels * 4);
  for (;; ++retries_) {
    const Counts counts = walk(commands, push, edges, keep);
    if (counts.unfinished != 0) {
      // What is left of the deepest walk when all levels are taken is one leaf.
      if (part_levels_ >= std::max(tree_.depth, edges.depth)) {
        throw ResourceError("{}: {} cuts off loops that a hierarchy over {} triangles needs", method_,
                            device_->info().name, scene_->triangles.size());
      }
      ++part_levels_;
    } else if (counts.words <= capacity_) {
      return counts.words;
    } else {
      capacity_ = counts.words + counts.words / 8;
    }
  }
}

/// Some processors' drivers end loops after 65,535 turns of a workgroup: where that is too few, the hierarchies are
/// walked in parts, one dispatch after the other.
EdgeLists::Counts EdgeLists::walk(render::Commands& commands, gpu::ScatterPush& push, const SideBuffers& edges,
                                  std::uint32_t keep) {
  push.list_capacity = capacity_;
  push.part_levels = part_levels_;
  render::grow(*device_, lists_, "edge lists", sizeof(Counts) + std::uint64_t{capacity_} * 4);
  commands.fill(*lists_, 0, 0, sizeof(Counts));
  commands.fill(*lists_, keep, sizeof(std::uint32_t), sizeof(std::uint32_t));
  times_.clear();
  Counts counts;
  for (push.part = 0; push.part < 1U << (3 * part_levels_); ++push.part) {
    pass_->record(commands, push,
                  {view_.buffer(), *heads_, *lists_, *edges.nodes, triangles_.nodes(), *edges.slots[0], *edges.slots[1],
                   *edges.slots[2], *edges.slots[3], *edges.slots[4], *edges.slots[5], triangles_.corners(0),
                   triangles_.corners(1), triangles_.corners(2)},
                  blocks());
    const std::vector<visibility::PassTime> part = commands.submit();
    times_.insert(times_.end(), part.begin(), part.end());
    lists_->read(std::span(&counts, 1));
    if (counts.unfinished != 0) break;
  }
  return counts;
}

std::uint32_t EdgeLists::question_count() const {
  Counts counts;
  lists_->read(std::span(&counts, 1));
  return counts.questions;
}

}  // namespace penumbra::volumes
