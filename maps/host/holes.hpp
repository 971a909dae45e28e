// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/holes.shared.h"
#include "visibility/scene_floats.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace penumbra::maps {

/// Returns whether the triangle's surface has holes (alphaMode MASK).
bool has_holes(const visibility::SceneFloats& scene, std::uint32_t triangle);

/// Returns the scene in which surfaces with holes cast shadow (SceneFloats::casts_shadow), for methods whose
/// rasterisers leave the holes out. Returns nullopt if no surface with holes casts shadow.
std::optional<visibility::SceneFloats> with_holes_drawn(const visibility::SceneFloats& scene);

/// All surfaces with holes of a scene, in the form used by holes.glsl. Texels are classified here, in double,
/// consistent with visibility::alpha_at: for each texel the least vertex alpha at which the texel is solid is stored.
class HoleSurfaces {
 public:
  /// `scene` must outlive this object.
  explicit HoleSurfaces(const visibility::SceneFloats& scene);

  /// Returns surfaces, then pictures, four texels a word. Never empty.
  [[nodiscard]] const std::vector<std::uint32_t>& words() const { return words_; }
  /// Appends the data of each corner of a triangle with holes: gpu::kPlaceWords words a corner.
  void add_corners(std::uint32_t triangle, std::vector<std::uint32_t>& places) const;

 private:
  const visibility::SceneFloats* scene_;
  std::vector<std::uint32_t> number_;  // for each object's surface, the index among those with holes
  std::vector<std::uint32_t> words_;
};

}  // namespace penumbra::maps
