// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/frame_memory.hpp"

#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>

namespace penumbra::maps {

/// Returns the displacement of the texels in a frame of a sequence, in texels, on either axis in [−½, ½); none in frame
/// 0.
glm::dvec2 jitter_of(std::uint32_t frame);

/// Options of with_history() (Scherzer, Jeschke and Wimmer 2007): hard shadows accumulated over several pictures, of a
/// still camera or of a sequence. `method` has a map of `size` texels a side from the light's centre, displaced by
/// *jitter texels when a light is prepared; `jitter` must outlive the method.
struct HistoryOptions {
  std::uint32_t frames = 1;  ///< maps for each picture
  std::uint32_t size = 0;
  bool reproject = false;  ///< begin with V of the sequence's previous picture (visibility::RemembersFrames)
};

/// Returns V of a previous picture for the surface seen at `pixel`, interpolated between the pixels of that picture
/// around the surface's place that show the same surface; NaN if none does.
float reprojected(const visibility::KeptPicture& before, const visibility::ViewSamples& samples, std::size_t pixel);

std::unique_ptr<visibility::Method> with_history(std::unique_ptr<visibility::Method> method,
                                                 std::unique_ptr<glm::dvec2> jitter, const HistoryOptions& options);

}  // namespace penumbra::maps
