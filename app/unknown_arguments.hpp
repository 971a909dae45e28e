#pragma once

#include <string>

namespace CLI {
class App;
}

namespace penumbra::app {

/// What is wrong with a command line that has words nobody asked for, once CLI11 has refused it: the first of them as a
/// command or option that there is not, and the nearest name that there is.
std::string explain_unknown_arguments(const CLI::App& app);

}  // namespace penumbra::app
