// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace penumbra::app {

/// Option, flag or argument of a command, with its description.
struct OptionWords {
  std::vector<std::string> short_names, long_names;  ///< without hyphens; empty for an argument
  std::string argument;                              ///< an argument's name; else empty
  std::string value;                                 ///< name of the value, such as FILE.json; empty: a flag
  std::string help;                                  ///< with the default at its end
  std::string group;                                 ///< Input, Light, Picture, Method, Output or General
  bool required = false, repeats = false;

  [[nodiscard]] bool is_flag() const { return argument.empty() && value.empty(); }
};

/// Command with its options. Help, manual pages and shell completions are generated from these words.
struct CommandWords {
  std::string name, help;
  std::string example;  ///< a command line; empty for the program itself
  std::string footer;
  std::vector<OptionWords> arguments, options;
};

/// Returns all commands, in the order of the help; the first one is the program itself, with the options common to all
/// commands.
std::vector<CommandWords> words_of_commands(const CLI::App& app);

/// Returns the help of the program or of a command, as printed by --help.
std::string help_text(const CLI::App& app);

/// Makes help list options in groups, input first and output last, with defaults as "(default: …)", in lines that fit a
/// terminal. To be called before commands are added.
void use_grouped_help(CLI::App& app);
/// Puts the options of all commands into these groups. To be called after all commands have been added.
void group_options(CLI::App& app);

}  // namespace penumbra::app
