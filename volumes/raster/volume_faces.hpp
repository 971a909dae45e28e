// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/view_samples.hpp"
#include "volumes/raster/light_volumes.hpp"
#include "volumes/raster/volume_count.shared.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace penumbra::volumes {

enum class CountVariant {
  z_fail,           ///< faces beyond p, including the far end
  z_pass,           ///< faces between the eye and p, without the count at the eye
  z_pass_from_eye,  ///< z_pass with the count at the eye; z_fail where double cannot decide that
};

enum FaceKind : std::uint32_t { kSideFaces = 0, kFanFaces = 1, kCapFaces = 2, kLowerFanFaces = 3, kUpperFanFaces = 4 };

/// The faces of shadow volumes that a picture requires, and the initial value of every pixel's count.
struct VolumeFaces {
  struct Kind {
    FaceKind kind;
    std::vector<gpu::VolumeFace> faces;
  };
  std::vector<Kind> kinds;
  std::vector<gpu::VolumePart> parts;  ///< the volumes' parts; those that cannot toggle have lost kToggles
  bool before = false;                 ///< counts on the segment from the eye to p, not on the ray beyond p
  glm::dvec3 apex{0};                  ///< the direction where all fans at infinity meet
  std::int32_t at_start = 0;           ///< initial value of every pixel's count
  std::int32_t at_eye = 0;             ///< count at the eye, which z_pass ignores
  std::uint64_t fragments = 0;         ///< approximate number of fragments: the areas of all boxes

  [[nodiscard]] std::size_t count(FaceKind kind) const;
};
VolumeFaces faces_on_screen(const LightVolumes& volumes, const visibility::PinholeCamera& camera, CountVariant variant);

}  // namespace penumbra::volumes
