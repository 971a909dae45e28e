#pragma once

namespace CLI {
class App;
}

namespace penumbra::app {

/// --allow-outside: of a command that reads scenes.
void add_allow_outside(CLI::App& command, bool& allow_outside);
/// --lenient: of a command that reads glTF.
void add_lenient(CLI::App& command, bool& lenient);

}  // namespace penumbra::app
