// SPDX-License-Identifier: Apache-2.0
#include "engines/engine_choice.hpp"

namespace penumbra::engines {

bool runs_on_vectors(const render::Machine& machine, Engine engine) {
  return engine == Engine::vectors || (engine == Engine::automatic && !machine.has_gpu());
}

}  // namespace penumbra::engines
