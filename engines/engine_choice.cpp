// SPDX-License-Identifier: Apache-2.0
// Chooses between the Vulkan device and the processor's vector units for methods that run on both: vector units where
// the machine has no GPU, unless the option `engine` says otherwise. Not from a paper.

#include "engines/engine_choice.hpp"

namespace penumbra::engines {

bool runs_on_vectors(const render::Machine& machine, Engine engine) {
  return engine == Engine::vectors || (engine == Engine::automatic && !machine.has_gpu());
}

}  // namespace penumbra::engines
