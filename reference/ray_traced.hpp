// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reference/common_answers.hpp"
#include "reference/embree_packets.hpp"
#include "reference/embree_scene.hpp"
#include "visibility/method.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Class of the method `raytrace`. Inside ray_traced.cpp and dome_blocks.cpp only.
namespace penumbra::reference {

/// Traces a ray for each light sample of each view sample; rays to a dome for neighbouring pixels together.
class RayTraced final : public visibility::Method {
 public:
  explicit RayTraced(const visibility::MethodOptions& options);

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& scene) override;
  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override { samples_ = &samples; }
  [[nodiscard]] std::uint32_t max_tile_rows() const override;
  void evaluate(const visibility::Tile& tile) override;
  void read_masks(std::span<std::uint32_t> masks) override;
  void read_visibility(std::span<float> visibility) override;
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    return {{"rays", counts_.rays},
            {"shortRays", counts_.short_rays},
            {"horizonPairs", counts_.horizon_pairs},
            {"commonPairs", counts_.common_pairs}};
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    return (embree_ ? embree_->peak_bytes() : 0) + masks_.capacity() * sizeof(std::uint32_t);
  }

 private:
  /// The rays' pixels, for the filter function; Embree passes the address of the first member.
  struct PixelContext {
    RTCIntersectContext embree;
    const std::uint32_t* plane_of_primitive;
    const std::uint32_t* carrier_planes;  ///< plane of the carrier, for each number (`id`) of a ray
  };
  static void ignore_own_plane(const RTCFilterFunctionNArguments* hits);

  struct Counts {
    std::atomic<std::uint64_t> rays = 0, short_rays = 0, horizon_pairs = 0, common_pairs = 0;
  };

  /// One thread's workspace for one pixel.
  struct Workspace {
    std::vector<glm::vec3> points, scaled;  // points of a sphere
    std::vector<std::uint32_t> above;
    std::vector<std::uint32_t> above_all;       // of all pixels of a packet
    std::vector<std::uint32_t> clear, blocked;  // directions in which a block of pixels has one answer
  };

  [[nodiscard]] PixelContext context_of(const std::uint32_t* carrier_planes) const;
  /// Removes the light samples too near to p for Embree from `above`, and decides them exactly.
  void decide_short_rays(std::size_t pixel, const std::vector<glm::vec3>& scaled, std::vector<std::uint32_t>& above,
                         std::span<std::uint32_t> visible);
  template <int kWidth>
  void trace_pixel(std::size_t pixel, Workspace& work, std::span<std::uint32_t> visible);
  /// Traces rays to a dome in packets of one ray from each of some neighbouring pixels. Rays in one direction stay
  /// together in the tree, while rays from one pixel would diverge at its root. `pixels`: indices into the tile; at
  /// most kWidth.
  template <int kWidth>
  void trace_neighbours(const visibility::Tile& tile, std::span<const std::size_t> pixels, Workspace& work);
  /// Pixels of a tile: rows in [top, bottom), columns in [left, right).
  struct Block {
    std::size_t top = 0, bottom = 0, left = 0, right = 0;
  };
  /// Finds the directions of a dome in which one large triangle is in the way of all of these pixels. If the pixels lie
  /// on one plane, also finds those in which nothing is in their way (otherwise their own surfaces may be).
  void find_common(const visibility::Tile& tile, const Block& block, Workspace& work) const;
  template <int kWidth>
  void trace_to_dome(const visibility::Tile& tile, const Block& block, Workspace& work);
  template <int kWidth>
  void trace_tile(const visibility::Tile& tile);

  visibility::MethodDescription description_;
  int width_ = 0;  // 0: the processor's width
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  const visibility::ViewSamples* samples_ = nullptr;
  std::optional<EmbreeScene> embree_;
  std::optional<CommonAnswers> common_answers_;  // made with the first dome
  std::vector<std::uint32_t> plane_of_primitive_;
  std::vector<glm::vec3> scaled_points_;  // points of a light that is not a sphere
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> full_mask_;
  visibility::Bounds bounds_;
  visibility::Tile tile_;             // the last evaluated tile
  std::vector<std::uint32_t> masks_;  // masks of that tile
  Counts counts_;
};

}  // namespace penumbra::reference
