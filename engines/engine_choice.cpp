#include "engines/engine_choice.hpp"

namespace penumbra::engines {

bool runs_on_vectors(const render::Device& device, Engine engine) {
  return engine == Engine::vectors || (engine == Engine::automatic && device.info().kind == "cpu");
}

}  // namespace penumbra::engines
