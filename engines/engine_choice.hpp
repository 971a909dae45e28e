#pragma once

#include "render/device.hpp"
#include "visibility/method_options.hpp"

#include <cstdint>

namespace penumbra::engines {

/// What the option `engine` of a method that has both asks for.
enum class Engine : std::uint8_t {
  automatic,  ///< vectors where the Vulkan device is the processor itself
  vulkan,     ///< the device
  vectors,    ///< the processor's own vector units, for what they can do
};

inline constexpr visibility::ChoiceOption kEngine{
    "engine",
    {{"auto", Engine::automatic}, {"vulkan", Engine::vulkan}, {"native", Engine::vectors}},
    Engine::automatic,
    "vulkan: on the device alone; native: on the processor's own vector units, where they can do the light; auto: "
    "native "
    "where the Vulkan device is the processor anyway, or cannot do the light. The same bits"};

/// On vector units, what they can do?
bool runs_on_vectors(const render::Device& device, Engine engine);

}  // namespace penumbra::engines
