// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "visibility/view_samples.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// Statistics of an AlphaFilter.
struct AlphaCounts {
  std::uint64_t mask_pairs = 0;   ///< pairs decided by a MASK's texels
  std::uint64_t blend_pairs = 0;  ///< pairs whose light is attenuated
};

/// Masks and transmittances of light that passed surfaces with holes and translucent surfaces.
struct FilteredMasks {
  std::span<std::uint32_t> masks;  ///< words_per_mask() words for each pixel; bits hidden by texels are cleared
  /// Fraction of each pair's light (sample_count() pairs for each pixel) that translucent surfaces let pass; unchanged
  /// where there are none. Empty: not computed.
  std::span<float> transmittances;
  std::span<std::uint8_t> dimmed;  ///< for each pixel, 1: some of its transmittances are below 1
};

/// The contribution to a pair's truth (docs/definitions.md) of triangles that let light through: for every method's
/// masks of opaque occluders, MASK surfaces clear further bits where texels are opaque, and BLEND surfaces attenuate
/// the rest. Exact: the triangles met are those of segment_meets_triangle.
class AlphaFilter {
 public:
  /// `scene` must outlive this object. `holes`: includes surfaces with holes (MASK); else only translucent ones.
  explicit AlphaFilter(const SceneFloats& scene, bool holes = true);

  /// Returns whether the light meets translucent surfaces.
  [[nodiscard]] bool dims(const Light& light) const;
  /// Filters the pixels from `first` on, as many as there are masks. The result does not depend on the number of
  /// threads.
  AlphaCounts filter(const ViewSamples& samples, const Light& light, std::size_t first,
                     const FilteredMasks& filtered) const;

 private:
  const SceneFloats& scene_;
  bool holes_;
  TriangleTree tree_;  // over scene.alphas.casters
};

/// Returns V of masks whose light is attenuated: each visible light sample counts with its transmittance. `n`: the view
/// sample's normal.
float dimmed_share(const Light& light, std::span<const std::uint32_t> mask, std::span<const float> transmittances,
                   const glm::vec3& n);

}  // namespace penumbra::visibility
