// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace penumbra::app {

/// Adds --allow-outside to a command that reads scenes.
void add_allow_outside(CLI::App& command, bool& allow_outside);
/// Adds --lenient to a command that reads glTF.
void add_lenient(CLI::App& command, bool& lenient);

}  // namespace penumbra::app
