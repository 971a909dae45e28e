#pragma once

#include "visibility/method.hpp"

#include <glm/vec2.hpp>

#include <cstdint>
#include <memory>

namespace penumbra::maps {

/// Where the texels of a sequence's frame lie: by what share of a texel they are moved, on either axis in [−½, ½).
/// Frame 0: not at all.
glm::dvec2 jitter_of(std::uint32_t frame);

/// Scherzer, Jeschke and Wimmer 2007: what so many pictures of a still camera make of a hard shadow. `method` has a map
/// of `size` texels a side from the light's centre, moved by *jitter of a texel when a light is prepared; `jitter` must
/// outlive it.
struct HistoryOptions {
  std::uint32_t frames = 1, size = 0;
};
std::unique_ptr<visibility::Method> with_history(std::unique_ptr<visibility::Method> method,
                                                 std::unique_ptr<glm::dvec2> jitter, const HistoryOptions& options);

}  // namespace penumbra::maps
