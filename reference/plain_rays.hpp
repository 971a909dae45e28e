// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reference/embree_scene.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

struct RTCIntersectContext;

namespace penumbra::reference {

/// The speed reference: the fastest plain use of Embree in robust mode that is known here, for benchmarks only. Uses a
/// renderer's practice: no filter function, the ray's origin moved off the surface, packets of neighbouring rays, all
/// cores. (Embree's ray streams, rtcOccludedNp and rtcOccluded1M, were two to four times slower.) Not an oracle: the
/// moved origin loses contact shadows below its offset.
class PlainRays {
 public:
  struct Options {
    int width = 0;           ///< rays traced together: 1, 4, 8 or 16; 0: this processor's width
    bool coherent = true;    ///< Embree's hint for packets
    bool neighbours = true;  ///< packets of neighbours on the light instead of consecutive light samples
    bool one_frame = false;  ///< a hierarchy of medium quality, as for a mesh that is used for one frame
  };
  explicit PlainRays(const Options& options);

  /// Call once for each mesh.
  void prepare_mesh(const visibility::SceneFloats& scene);
  /// Call once for each light; rebuilds without the light's own body if it has one.
  void prepare_light(const visibility::Light& light);
  /// Returns the first hits of a perspective camera's rays, in packets of neighbours in a row: triangle, p and n in
  /// float, as in a renderer. The rest of ViewSamples stays empty. Only casters of shadows are in the scene.
  [[nodiscard]] visibility::ViewSamples look(const visibility::PinholeCamera& camera) const;
  /// Computes V of each pixel; background, emitters and objects that receive no shadow have 1. `samples` and
  /// `visibility` must outlive the call.
  void evaluate(const visibility::ViewSamples& samples, std::span<float> visibility) const;

 private:
  /// The scaled light points, in the order of tracing, by axis, padded to whole packets.
  struct PointArrays {
    std::vector<float> x, y, z;
    template <typename Scaled>
    void assign(std::span<const glm::vec3> points, std::span<const std::uint32_t> order, const Scaled& scaled);
  };

  /// Calls body<kWidth>() with the chosen packet width.
  template <typename Body>
  void with_width(const Body& body) const;
  template <int kWidth>
  void look_at_pixels(const visibility::PinholeCamera& camera, visibility::ViewSamples& samples) const;
  template <int kWidth>
  [[nodiscard]] int trace_pixel(const glm::vec3& p, const glm::vec3& n, const PointArrays& points,
                                RTCIntersectContext& context) const;
  template <int kWidth>
  void evaluate_pixels(const visibility::ViewSamples& samples, std::span<float> visibility) const;
  void build(std::int32_t without_light);

  Options options_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  std::optional<EmbreeScene> embree_;
  std::int32_t built_without_ = -1;
  std::vector<std::uint32_t> order_;
  PointArrays points_;  // points of a light that is not a sphere
  float offset_ = 0;
};

}  // namespace penumbra::reference
