// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/runner.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/view_samples.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// One of the scene's lights, as a range of Session::lights: `count` consecutive pieces, or the light itself.
struct WholeLight {
  std::size_t first = 0, count = 1;
};

std::vector<WholeLight> whole_lights(std::span<const visibility::Light> lights);
/// Returns the names of whole_lights.
std::vector<std::string> whole_names(std::span<const visibility::Light> lights);
/// Returns, for each piece, the index of its whole light.
std::vector<std::size_t> wholes_of_pieces(std::span<const visibility::Light> lights);

/// Returns the class of each pixel for a whole light, from its classes for each piece. Pieces with p behind them are
/// ignored, unless p is behind all. Of the others: horizon if some piece is not completely above the horizon, judged if
/// all pieces are.
std::vector<visibility::PixelClass> whole_classes(const WholeLight& whole,
                                                  std::span<const std::vector<visibility::PixelClass>> pieces);

/// Returns V of a whole light at each pixel: of the area that emits toward p, the visible fraction,
///
///   V(p) = Σ area_i V_i(p) / Σ area_i    over the pieces i that p is in front of,
///
/// and 0 if there is none (docs/definitions.md). So V is 1 without occluders, whichever sides p sees. The area of a
/// sphere is that of its disk. Where a rule sets V of every piece to 1 or 0, V of the whole light is the same.
std::vector<float> whole_visibility(const WholeLight& whole, std::span<const visibility::Light> lights,
                                    std::span<const std::vector<visibility::PixelClass>> classes,
                                    std::span<const std::vector<float>> visibility);

/// Returns a run of all pieces as a run of whole lights: V and times, light by light.
MethodRun of_whole_lights(MethodRun run, const Session& session);

}  // namespace penumbra::session
