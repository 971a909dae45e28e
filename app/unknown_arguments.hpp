// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace penumbra::app {

/// Returns a message about unknown words of a command line rejected by CLI11: the first of them as an unknown command
/// or option, and the nearest existing name.
std::string explain_unknown_arguments(const CLI::App& app);

}  // namespace penumbra::app
