// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/pictures/request.hpp"

#include <string>

namespace CLI {
class App;
}

namespace penumbra::app {

/// Adds the options of `render` and `submit`, except --frame.
void add_picture_options(CLI::App& command, session::PictureOptions& options);
/// Adds --moment, for commands that make one picture.
void add_moments(CLI::App& command, session::PictureOptions& options);
/// Adds --tev to a command.
void add_tev(CLI::App& command, std::string& address);

}  // namespace penumbra::app
