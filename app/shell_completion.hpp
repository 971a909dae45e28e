#pragma once

#include "app/command_words.hpp"

#include <span>
#include <string>
#include <string_view>

namespace penumbra::app {

/// The completion script of a shell (bash, zsh or fish) for the commands, their options, names of methods and files.
/// `commands`: the names of all commands in one line, semicolons between, for CMake. Throws UsageError for another
/// word.
std::string shell_completion(std::string_view shell, std::span<const CommandWords> commands,
                             std::span<const std::string> methods);

}  // namespace penumbra::app
