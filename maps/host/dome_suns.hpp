// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace penumbra::maps {

/// Option of methods of maps: number of suns that represent a dome.
inline constexpr visibility::IntegerOption kDomeSuns{
    "suns", 4, 1024, 64, "suns that stand for a dome, of equal power (median cut of its light samples)"};

/// Sun that represents a part of a dome, and the indices of its light samples.
struct DomeSun {
  visibility::Light light;
  std::vector<std::uint32_t> samples;
};
/// Returns `count` suns, or more if some would be wider than a sun's plane permits. `own_samples`: each sun has the
/// represented light samples as its own, and contains all of them; else a sun is a disk about as wide as their spread.
std::vector<DomeSun> dome_suns(const visibility::Light& dome, std::uint32_t count, bool own_samples);

/// Extends a method that supports suns to domes: evaluates one sun after another. Masks are assembled to the dome's; V
/// is the mean, weighted by each sun's cosine. Other lights are passed through unchanged.
std::unique_ptr<visibility::Method> with_dome_suns(std::unique_ptr<visibility::Method> method, std::uint32_t suns);

/// Returns the description of a method wrapped by with_dome_suns().
visibility::MethodDescription with_dome_suns(visibility::MethodDescription description);

}  // namespace penumbra::maps
