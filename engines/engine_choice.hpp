// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/machine.hpp"
#include "visibility/method_options.hpp"

#include <cstdint>

namespace penumbra::engines {

/// Values of the option `engine` of a method that has both engines.
enum class Engine : std::uint8_t {
  automatic,  ///< the GPU; vectors if there is none
  vulkan,     ///< the Vulkan device
  vectors,    ///< the processor's own vector units, for lights that they support
};

inline constexpr visibility::ChoiceOption kEngine{
    "engine",
    {{"auto", Engine::automatic}, {"vulkan", Engine::vulkan}, {"native", Engine::vectors}},
    Engine::automatic,
    "vulkan: only on the device; native: on the processor's own vector units, if they support the light; auto: "
    "native "
    "if there is no GPU, or it does not support the light. All give the same bits"};

/// Returns whether a method runs on vector units for lights that they support. Looks for a GPU only for
/// Engine::automatic.
bool runs_on_vectors(const render::Machine& machine, Engine engine);

}  // namespace penumbra::engines
