// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command_words.hpp"

#include <span>
#include <string>
#include <string_view>

namespace penumbra::app {

/// Returns the completion script of a shell (bash, zsh or fish) for the commands, their options, names of methods and
/// files. `shell` = "commands": returns the names of all commands in one line, separated by semicolons, for CMake.
/// Throws UsageError for any other word.
std::string shell_completion(std::string_view shell, std::span<const CommandWords> commands,
                             std::span<const std::string> methods);

}  // namespace penumbra::app
