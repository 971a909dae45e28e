#pragma once

#include "engines/device/triangle_upload.hpp"
#include "engines/device/view_upload.hpp"
#include "render/commands.hpp"
#include "render/compute_pass.hpp"
#include "render/device.hpp"
#include "visibility/light_frame.hpp"
#include "visibility/light_touch.hpp"
#include "visibility/method.hpp"
#include "visibility/triangle_tree.hpp"
#include "volumes/edges/edge_scatter.shared.h"
#include "volumes/edges/edge_set.hpp"
#include "volumes/edges/edge_sides.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::volumes {

/// For each cluster of view samples of a block of pixels the edges that may be silhouettes before the light, and the
/// triangles that may be before one corner of its frame: what find_edges.comp finds, with all that it reads. Any
/// planar light. Lists that are too short grow; nothing is cut off.
class EdgeLists {
 public:
  /// `method` names errors. `crops`: else also edges that are no silhouettes as seen from their cluster.
  EdgeLists(const render::Device& device, std::string method, bool crops = true);

  void prepare_mesh(const visibility::SceneFloats& scene);
  /// `frame`: make_light_frame(light, scale()). Throws InputError where float32 cannot span light and scene together.
  void prepare_light(const visibility::Light& light, const visibility::LightFrame& frame);
  void prepare_view(const visibility::ViewSamples& samples);
  void load(const visibility::Tile& tile);  ///< its view samples, if they are not on the device yet

  /// The lists of a tile for view samples on one side of the light (+1: where u × v points; −1: behind). Sets what it
  /// knows of `push`. `keep`: the questions that an earlier side has asked. Returns the length of the lists in words.
  std::uint64_t find(render::Commands& commands, gpu::ScatterPush& push, float side, std::uint32_t keep);
  [[nodiscard]] std::uint32_t question_count() const;

  [[nodiscard]] float scale() const { return scale_; }  ///< of everything on the device
  [[nodiscard]] const visibility::TriangleTree& tree() const { return tree_; }
  [[nodiscard]] std::size_t edge_count() const { return edge_count_; }  ///< records, none cut
  [[nodiscard]] std::uint64_t retries() const { return retries_; }
  [[nodiscard]] const std::vector<visibility::PassTime>& times() const { return times_; }  ///< of the last find

  [[nodiscard]] const render::Buffer& view() const { return view_.buffer(); }
  [[nodiscard]] const render::Buffer& heads() const { return *heads_; }
  [[nodiscard]] const render::Buffer& lists() const { return *lists_; }
  /// EdgeTexels::slots[i] of that side.
  [[nodiscard]] const render::Buffer& slots(float side, std::size_t i) const { return *of_side(side).slots[i]; }
  /// As device::TriangleUpload has them.
  [[nodiscard]] const render::Buffer& triangle_corners(std::size_t i) const { return triangles_.corners(i); }

 private:
  /// What device passes read of the edges on one side of the light's plane.
  struct SideBuffers {
    std::uint32_t depth = 0;
    std::optional<render::Buffer> nodes;
    std::array<std::optional<render::Buffer>, 6> slots;
  };
  [[nodiscard]] SideBuffers upload(const std::vector<EdgeRecord>& records) const;
  void build_pass();
  [[nodiscard]] const SideBuffers& of_side(float side) const;
  [[nodiscard]] std::uint64_t blocks() const;
  void describe(gpu::ScatterPush& push) const;
  struct Counts;
  Counts walk(render::Commands& commands, gpu::ScatterPush& push, const SideBuffers& edges, std::uint32_t keep);

  const render::Device* device_;
  std::string method_;
  EdgeSides sides_;
  visibility::LightTouch touch_;
  bool crops_;
  std::optional<render::ComputePass> pass_;
  std::vector<std::uint32_t> constants_;

  const visibility::SceneFloats* scene_ = nullptr;
  float scale_ = 1;
  visibility::TriangleTree tree_;
  device::TriangleUpload triangles_;
  SideBuffers whole_;  // of all casters, cut nowhere
  std::size_t edge_count_ = 0;

  const visibility::Light* light_ = nullptr;
  visibility::LightFrame frame_;
  bool cut_ = false;
  std::optional<SideBuffers> front_, back_;  // where `whole_` will not do

  const visibility::ViewSamples* samples_ = nullptr;
  device::ViewUpload view_;
  visibility::Tile tile_;
  std::unique_ptr<render::Buffer> heads_, lists_;
  std::uint32_t capacity_ = 1U << 20;  // words; grows
  std::uint32_t part_levels_ = 0;      // grows: 8 to that power are the parts that the hierarchies are walked in
  std::uint64_t retries_ = 0;
  std::vector<visibility::PassTime> times_;
};

}  // namespace penumbra::volumes
