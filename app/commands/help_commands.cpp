// SPDX-License-Identifier: Apache-2.0
// `penumbra help`, `version`, `completion` and `man`: all four write texts that are made from the same descriptions of
// commands and options as `--help`.

#include "app/command_words.hpp"
#include "app/commands.hpp"
#include "app/man_pages.hpp"
#include "app/shell_completion.hpp"
#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "session/methods.hpp"

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

namespace penumbra::app {
namespace {

/// Returns the command with this name, among those of the whole program.
const CLI::App& find_command(const CLI::App& program, const std::string& name) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == name) return *command;
    names.push_back(command->get_name());
  }
  throw UsageError("there is no command \"{}\"; commands: {}{}", name, fmt::join(names, ", "),
                   did_you_mean(name, names));
}

class HelpCommand : public Command {
 public:
  explicit HelpCommand(CLI::App& app) : Command(app, "help", "explain the program or a command, as --help does") {
    cli_.add_option("COMMAND", name_, "command to explain (default: the program)")->type_name("");
  }

  int run(const GlobalOptions&) override {
    const CLI::App& program = *cli_.get_parent();
    fmt::print("{}", help_text(name_.empty() ? program : find_command(program, name_)));
    return 0;
  }

 private:
  std::string name_;
};

class VersionCommand : public Command {
 public:
  explicit VersionCommand(CLI::App& app) : Command(app, "version", "print the program's version") {}

  int run(const GlobalOptions&) override {
    fmt::print("penumbra {}\n", PENUMBRA_VERSION);
    return 0;
  }
};

class CompletionCommand : public Command {
 public:
  explicit CompletionCommand(CLI::App& app)
      : Command(app, "completion", "print the script with which a shell completes commands, options and methods") {
    cli_.add_option("SHELL", shell_, "bash, zsh or fish; or commands, which prints only the commands' names")
        ->required()
        ->type_name("");
    cli_.footer(
        "`source <(penumbra completion bash)`; an installation puts the scripts of all three shells where these look "
        "for them.\n");
  }

  int run(const GlobalOptions&) override {
    std::vector<std::string> methods;
    for (const visibility::MethodDescription* method : session::all_methods()) methods.push_back(method->name);
    fmt::print("{}", shell_completion(shell_, words_of_commands(*cli_.get_parent()), methods));
    return 0;
  }

 private:
  std::string shell_;
};

class ManCommand : public Command {
 public:
  explicit ManCommand(CLI::App& app) : Command(app, "man", "print the manual page of the program or of a command") {
    cli_.add_option("COMMAND", name_, "command whose page is printed (default: the program)")->type_name("");
    cli_.footer("`penumbra man render | man -l -`; an installation has the pages as penumbra-render(1) and so on.\n");
  }

  int run(const GlobalOptions&) override {
    const std::vector<CommandWords> all = words_of_commands(*cli_.get_parent());
    if (!name_.empty()) find_command(*cli_.get_parent(), name_);
    const auto found =
        name_.empty() ? all.begin() : std::ranges::find(all.begin() + 1, all.end(), name_, &CommandWords::name);
    fmt::print("{}", man_page(all, *found));
    return 0;
  }

 private:
  std::string name_;
};

}  // namespace

std::unique_ptr<Command> make_help_command(CLI::App& app) {
  return std::make_unique<HelpCommand>(app);
}
std::unique_ptr<Command> make_version_command(CLI::App& app) {
  return std::make_unique<VersionCommand>(app);
}
std::unique_ptr<Command> make_completion_command(CLI::App& app) {
  return std::make_unique<CompletionCommand>(app);
}
std::unique_ptr<Command> make_man_command(CLI::App& app) {
  return std::make_unique<ManCommand>(app);
}

}  // namespace penumbra::app
