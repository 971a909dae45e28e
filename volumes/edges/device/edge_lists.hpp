// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/device/growing_list.hpp"
#include "engines/device/part_walk.hpp"
#include "engines/device/triangle_upload.hpp"
#include "engines/device/view_upload.hpp"
#include "render/commands.hpp"
#include "render/compute_pass.hpp"
#include "render/device.hpp"
#include "visibility/lights/device_light.hpp"
#include "visibility/lights/light_touch.hpp"
#include "visibility/method.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "volumes/edges/device/edge_scatter.shared.h"
#include "volumes/edges/edge_set.hpp"
#include "volumes/edges/edge_tree.hpp"
#include "volumes/edges/edge_sides.hpp"
#include "volumes/edges/device/edge_upload.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::volumes {

/// The view samples for which lists are made: those in a band of a tile's rows that are on one side of the light (+1:
/// the side that u × v points to; −1: the other side).
struct EdgeListInput {
  const device::ViewUpload& view;
  const device::TriangleUpload& triangles;
  std::uint32_t width;  ///< width of the picture
  visibility::Tile tile, band;
  float side;
};

/// Lists, for each cluster of view samples in a block of pixels, the edges between it and the light that may be
/// silhouettes, and the triangles that may be between it and one corner of the light's rectangle: runs find_edges.comp
/// and holds its input. Any planar light. Lists that are too short grow; nothing is cut off.
class EdgeLists {
 public:
  /// Head of lists().
  struct Head {
    std::uint32_t words = 0, unfinished = 0;
  };

  /// `method` names the method in errors. `crops` = false also lists edges that are not silhouettes as seen from their
  /// cluster.
  EdgeLists(const render::Device& device, std::string method, bool crops = true);

  /// `tree`: hierarchy over the scene's triangles. `scale`: scale of all lengths on the device.
  void prepare_mesh(const visibility::SceneFloats& scene, const visibility::TriangleTree& tree, float scale);
  /// `frame`: make_device_light(light, scale). Throws InputError if float32 cannot represent light and scene together.
  void prepare_light(const visibility::Light& light, const visibility::DeviceLight& frame);

  /// Sets the lists' fields of `push` and finds the lists. Returns false if the lists would exceed the largest storage
  /// buffer.
  [[nodiscard]] bool find(render::Commands& commands, gpu::ScatterPush& push, const EdgeListInput& input);

  [[nodiscard]] std::size_t edge_count() const { return edge_count_; }  ///< number of uncut records
  [[nodiscard]] const visibility::LightTouch& touch() const { return touch_; }
  // Results of the last find():
  [[nodiscard]] std::uint64_t words() const { return words_; }  ///< length of the lists
  [[nodiscard]] std::uint64_t retries() const { return retries_; }
  [[nodiscard]] const std::vector<visibility::PassTime>& times() const { return times_; }
  [[nodiscard]] const render::Buffer& heads() const { return *heads_; }
  [[nodiscard]] const render::Buffer& lists() const { return lists_.buffer(); }
  /// Returns bindings 0 to 11 of the kernels that read the lists: view samples, heads, lists, EdgeTexels::slots, and
  /// the triangles' corners.
  [[nodiscard]] std::vector<render::BufferReference> inputs(const EdgeListInput& input) const;

 private:
  void prepare_edges();
  void build_pass();
  [[nodiscard]] const EdgeUpload& of_side(float side) const { return side < 0 && back_is_used_ ? *back_ : *front_; }
  void describe(gpu::ScatterPush& push, const EdgeListInput& input) const;
  Head walk(render::Commands& commands, gpu::ScatterPush& push, const EdgeListInput& input);

  const render::Device* device_;
  std::string method_;
  EdgeSides sides_;
  visibility::LightTouch touch_;
  bool crops_;
  std::optional<render::ComputePass> pass_;
  std::vector<std::uint32_t> constants_;

  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::TriangleTree* tree_ = nullptr;
  float scale_ = 1;
  std::optional<EdgeUpload> whole_;  // edges of all casters
  std::size_t edge_count_ = 0;
  struct WithoutBody {
    std::int32_t light;
    EdgeUpload edges;
  };
  std::optional<WithoutBody> without_body_;  // edges without the body of the last light that has one
  EdgeUpload* front_ = nullptr;              // whole_ or without_body_
  std::optional<EdgeUpload> back_;           // a copy of *front_, if the light's plane cuts edges and the light emits
                                             // to both sides

  const visibility::Light* light_ = nullptr;
  visibility::DeviceLight frame_;
  bool is_cut_ = false, back_is_used_ = false;

  std::unique_ptr<render::Buffer> heads_;
  device::GrowingList lists_;
  device::PartWalk walk_;
  std::uint64_t words_ = 0, retries_ = 0;
  std::vector<visibility::PassTime> times_;
};

}  // namespace penumbra::volumes
