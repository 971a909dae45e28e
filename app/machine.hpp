#pragma once

#include "render/machine.hpp"

#include <string>

namespace penumbra::app {

/// Makes the machine that a command runs on. `wanted`: as `--device` takes it. PENUMBRA_VALIDATION=1 in the environment
/// switches the validation layer on.
render::Machine make_machine(const std::string& wanted);

}  // namespace penumbra::app
