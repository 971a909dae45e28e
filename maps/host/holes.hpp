#pragma once

#include "maps/host/holes.shared.h"
#include "visibility/scene_floats.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace penumbra::maps {

/// Has the triangle's surface holes (alphaMode MASK)?
bool has_holes(const visibility::SceneFloats& scene, std::uint32_t triangle);

/// The scene in which surfaces with holes cast shadow (SceneFloats::casts_shadow), for methods whose rasterisers leave
/// the holes out. Returns nullopt if there are none that cast.
std::optional<visibility::SceneFloats> with_holes_drawn(const visibility::SceneFloats& scene);

/// All surfaces with holes of a scene, as holes.glsl reads them. Which texels are holes is decided here, in double, as
/// the truth of a pair has it (visibility::alpha_at): a texel stands for the least vertex alpha that makes it solid.
class HoleSurfaces {
 public:
  /// `scene` must outlive it.
  explicit HoleSurfaces(const visibility::SceneFloats& scene);

  /// Surfaces, then pictures, four texels a word. Never empty.
  [[nodiscard]] const std::vector<std::uint32_t>& words() const { return words_; }
  /// Appends what each corner of a triangle with holes carries: gpu::kPlaceWords words a corner.
  void add_corners(std::uint32_t triangle, std::vector<std::uint32_t>& places) const;

 private:
  const visibility::SceneFloats* scene_;
  std::vector<std::uint32_t> number_;  // of each object's surface among those with holes
  std::vector<std::uint32_t> words_;
};

}  // namespace penumbra::maps
