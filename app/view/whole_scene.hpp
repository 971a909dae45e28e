// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/instances.hpp"
#include "scenes/scene.hpp"
#include "session/light_methods.hpp"
#include "session/options.hpp"
#include "session/pictures/request.hpp"

#include <cstdint>

namespace penumbra::app {

/// Scene of a live view, with its meshes.
struct WholeScene {
  scenes::Scene scene;
  scenes::Instances instances = {};  ///< instances that have no copies
  session::InstanceUse use = session::InstanceUse::automatic;
};

/// Reads a scene for the live view. Methods keep copies of instances from picture to picture, but making these takes
/// time and memory: by default instances become copies up to kMostCopies triangles, if memory suffices.
WholeScene read_whole_scene(const session::RunOptions& options, session::InstanceUse use);
/// Largest number of triangles for which copies are made by default. First pictures with copies took 4 s at 2,000,000
/// triangles and 48 s at 20,000,000, on two threads; without copies they took 2 s.
inline constexpr std::uint64_t kMostCopies = 5'000'000;

/// Throws UsageError if the method needs copies of instances that have none. `scene`: with the lights that it
/// evaluates.
void require_no_copies(const scenes::Scene& scene, const scenes::Instances& instances, const session::MethodWish& wish);

}  // namespace penumbra::app
