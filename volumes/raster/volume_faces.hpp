#pragma once

#include "visibility/view_samples.hpp"
#include "volumes/raster/light_volumes.hpp"
#include "volumes/raster/volume_count.shared.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace penumbra::volumes {

enum class CountVariant {
  z_fail,           ///< faces beyond p, the far end included
  z_pass,           ///< faces between the eye and p: what is counted where the eye is stays out
  z_pass_from_eye,  ///< the same, from the count where the eye is; z_fail where that is beyond double
};

enum FaceKind : std::uint32_t { kSideFaces = 0, kFanFaces = 1, kCapFaces = 2, kLowerFanFaces = 3, kUpperFanFaces = 4 };

/// The faces of shadow volumes that a picture of them needs, and what every pixel's count starts from.
struct VolumeFaces {
  struct Kind {
    FaceKind kind;
    std::vector<gpu::VolumeFace> faces;
  };
  std::vector<Kind> kinds;
  std::vector<gpu::VolumePart> parts;  ///< of the volumes; those that cannot toggle do not
  bool before = false;                 ///< is it the segment from the eye to p that is followed, not the ray beyond p?
  glm::dvec3 apex{0};                  ///< where all fans at infinity meet
  std::int32_t at_start = 0;           ///< what every pixel's count starts from
  std::int32_t at_eye = 0;             ///< what z_pass leaves out
  std::uint64_t fragments = 0;         ///< the areas of all boxes, about

  [[nodiscard]] std::size_t count(FaceKind kind) const;
};
VolumeFaces faces_on_screen(const LightVolumes& volumes, const visibility::PinholeCamera& camera, CountVariant variant);

}  // namespace penumbra::volumes
