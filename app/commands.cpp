#include "app/commands.hpp"

#include "base/error.hpp"

#include <CLI/CLI.hpp>

namespace penumbra::app {

Command::Command(CLI::App& app, const std::string& name, const std::string& help)
    : cli_(*app.add_subcommand(name, help)) {}

bool Command::chosen() const {
  return cli_.parsed();
}

namespace {

class CommandNotThereYet : public Command {
 public:
  CommandNotThereYet(CLI::App& app, const std::string& name) : Command(app, name, "(not there yet)") {
    cli_.allow_extras()->fallthrough(false);  // whatever follows: the answer is the same
  }

  int run(const GlobalOptions&) override {
    throw UsageError("{} is not there yet; what is: render, compare, methods, devices, convert, wedges",
                     cli_.get_name());
  }
};

}  // namespace

std::unique_ptr<Command> make_command_not_there_yet(CLI::App& app, const std::string& name) {
  return std::make_unique<CommandNotThereYet>(app, name);
}

}  // namespace penumbra::app
