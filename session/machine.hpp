// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/machine.hpp"

#include <string>

namespace penumbra::session {

/// Makes the machine for a command. `wanted`: in the form of `--device`. PENUMBRA_VALIDATION=1 in the environment
/// enables the validation layer.
render::Machine make_machine(const std::string& wanted);

}  // namespace penumbra::session
