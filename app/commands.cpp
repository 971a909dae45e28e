#include "app/commands.hpp"

#include <CLI/CLI.hpp>

namespace penumbra::app {

Command::Command(CLI::App& app, const std::string& name, const std::string& help)
    : cli_(*app.add_subcommand(name, help)) {}

bool Command::chosen() const {
  return cli_.parsed();
}

}  // namespace penumbra::app
