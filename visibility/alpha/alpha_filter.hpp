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

/// What an AlphaFilter met.
struct AlphaCounts {
  std::uint64_t mask_pairs = 0;   ///< that a MASK's texels decided
  std::uint64_t blend_pairs = 0;  ///< whose light is dimmed on its way
};

/// Masks whose light has passed surfaces with holes and translucent ones, with what is left of it.
struct FilteredMasks {
  std::span<std::uint32_t> masks;  ///< words_per_mask() words a pixel; bits that texels hide are taken out
  /// Of each pair (sample_count() a pixel), what translucent surfaces leave of its light; untouched where nothing does.
  /// Empty: nobody asks.
  std::span<float> transmittances;
  std::span<std::uint8_t> dimmed;  ///< of each pixel, 1: some of its transmittances are below 1
};

/// The part in a pair's truth (docs/definitions.md) of triangles that let light through: whatever method found what
/// stops all light, MASK takes further bits out of its masks where texels are there, and BLEND dims the rest. Exact:
/// the triangles met are those of segment_meets_triangle.
class AlphaFilter {
 public:
  /// `scene` must outlive it. `holes`: asks surfaces with holes (MASK), too; without, translucent ones alone.
  explicit AlphaFilter(const SceneFloats& scene, bool holes = true);

  /// Does the light meet translucent surfaces?
  [[nodiscard]] bool dims(const Light& light) const;
  /// The pixels from `first` on, as many as there are masks. Other threads' number changes nothing.
  AlphaCounts filter(const ViewSamples& samples, const Light& light, std::size_t first,
                     const FilteredMasks& filtered) const;

 private:
  const SceneFloats& scene_;
  bool holes_;
  TriangleTree tree_;  // over scene.alphas.casters
};

/// V of masks whose light is dimmed: each visible light sample counts with its transmittance. `n`: the view sample's
/// normal.
float dimmed_share(const Light& light, std::span<const std::uint32_t> mask, std::span<const float> transmittances,
                   const glm::vec3& n);

}  // namespace penumbra::visibility
