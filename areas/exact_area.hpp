// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>

namespace penumbra::areas {

/// Number type of the sweep over the light's plane. Projecting, clipping and facing are exact in both.
enum class SweepArithmetic {
  rounded,   ///< double, on vertices rounded once from the exact ones
  rational,  ///< rationals throughout, rounded once at the end: for verification of `rounded`; slow, and slower with
             ///< size
};

struct Receiver {
  glm::vec3 p{0};
  std::uint32_t carrier = 0;
  std::int8_t facing = 0;  ///< ViewSamples::facing
  glm::vec3 n{0};          ///< ViewSamples::n; only for the form factor
};

/// Amount of work for one view sample's area.
struct AreaWork {
  std::uint64_t triangles = 0;  ///< whose boxes touch the shaft from p to the light
  std::uint64_t edges = 0;      ///< on the light: signed edges that do not cancel, and cuts
};

/// Visibility and form factor of the light at one view sample.
struct ExactView {
  double visibility = 0;
  /// 1/π ∫ visible texel cos θp cos θl / d² dl; without a texture equal in all three components.
  glm::dvec3 form_factor{0};
  AreaWork work;
};

struct ExactAreaData;
class FormFactorSum;

/// Computes V of a view sample as an area, not a count: the part of the light's exact region that is strictly above the
/// carrier's plane and in no triangle's back-projection, over the region's own area. light_region.hpp defines the
/// region of each kind of light. With a texture areas are weighted with its luminance. Thread-safe after set_light().
class ExactArea {
 public:
  /// `scene` must outlive this object.
  explicit ExactArea(const visibility::SceneFloats& scene);
  /// `scene`, and `tree` of the same scene, must outlive this object.
  ExactArea(const visibility::SceneFloats& scene, const visibility::TriangleTree& tree);
  ~ExactArea();
  ExactArea(ExactArea&&) noexcept;
  ExactArea& operator=(ExactArea&&) noexcept;

  /// `light` must outlive its use by this object.
  void set_light(const visibility::Light& light);
  /// Returns V in [0, 1]; 0 if p is not strictly on an emitting side of the light.
  [[nodiscard]] double visibility(const Receiver& receiver, SweepArithmetic arithmetic = SweepArithmetic::rounded,
                                  AreaWork* work = nullptr) const;
  /// Returns the visible fraction, and the form factor (visibility/lights/form_factor.hpp) of the visible region: the
  /// trapezoids that the sweep finds uncovered, each in closed form, under a texture by texels or blocks of them
  /// (TextureBlocks); for an unoccluded light, UnshadowedLight::whole(). Cosines are those of receiver.n.
  [[nodiscard]] ExactView view(const Receiver& receiver, SweepArithmetic arithmetic = SweepArithmetic::rounded) const;
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  [[nodiscard]] bool sees_direction(const Receiver& receiver) const;
  double visible_share(const Receiver& receiver, SweepArithmetic arithmetic, AreaWork& work,
                       FormFactorSum* form_factor) const;

  std::unique_ptr<ExactAreaData> data_;
};

}  // namespace penumbra::areas
