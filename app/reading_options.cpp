// SPDX-License-Identifier: Apache-2.0
// The options `--allow-outside` and `--lenient`, with one help text for all commands that read scenes.

#include "app/reading_options.hpp"

#include <CLI/CLI.hpp>

namespace penumbra::app {

void add_allow_outside(CLI::App& command, bool& allow_outside) {
  command.add_flag("--allow-outside", allow_outside, "let a scene name files outside its own folder");
}

void add_lenient(CLI::App& command, bool& lenient) {
  command.add_flag("--lenient", lenient,
                   "leave out, with a warning, features that affect shadows and that are not supported, or not by the "
                   "output's format; without this option such a scene is refused");
}

}  // namespace penumbra::app
