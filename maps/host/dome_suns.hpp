#pragma once

#include "visibility/method.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace penumbra::maps {

/// Of methods of maps: how many suns stand for a dome.
inline constexpr visibility::IntegerOption kDomeSuns{
    "suns", 4, 1024, 64, "suns that stand for a dome, of equal power (median cut of its light samples)"};

/// A sun in a dome's place, and which of its light samples it stands for.
struct DomeSun {
  visibility::Light light;
  std::vector<std::uint32_t> samples;
};
/// So many suns, or more if some would be wider than a sun's plane can hold. `own_samples`: each has the light samples
/// that it stands for as its own, and holds all of them; else it is a disk about as wide as they are spread.
std::vector<DomeSun> dome_suns(const visibility::Light& dome, std::uint32_t count, bool own_samples);

/// The method, which does suns, made to do domes: one sun after the other. Masks are put together into the dome's; of V
/// the mean is taken, each sun by its cosine. Other lights go through unchanged.
std::unique_ptr<visibility::Method> with_dome_suns(std::unique_ptr<visibility::Method> method, std::uint32_t suns);

/// The description of a method that with_dome_suns() wraps.
visibility::MethodDescription with_dome_suns(visibility::MethodDescription description);

}  // namespace penumbra::maps
