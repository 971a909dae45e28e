// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command_words.hpp"

#include <span>
#include <string>

namespace penumbra::app {

/// Returns the manual page of one command, penumbra-NAME(1), or, for the program itself (the first of all),
/// penumbra(1), in the language of man(7).
std::string man_page(std::span<const CommandWords> commands, const CommandWords& command);

}  // namespace penumbra::app
