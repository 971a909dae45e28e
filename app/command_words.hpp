#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace penumbra::app {

/// An option, a flag or an argument of a command, as its description says it.
struct OptionWords {
  std::vector<std::string> short_names, long_names;  ///< without hyphens; an argument has none
  std::string argument;                              ///< an argument's name; else empty
  std::string value;                                 ///< what the value is, such as FILE.json; empty: a flag
  std::string help;                                  ///< with the default at its end
  std::string group;                                 ///< Input, Light, Picture, Method, Output or General
  bool required = false, repeats = false;

  [[nodiscard]] bool is_flag() const { return argument.empty() && value.empty(); }
};

/// A command with its options. Help, man pages and completions of shells are made from these words.
struct CommandWords {
  std::string name, help, footer;
  std::vector<OptionWords> arguments, options;
};

/// All commands, in the order of the help; the first one is the program itself, with the options of every command.
std::vector<CommandWords> words_of_commands(const CLI::App& app);

/// Help of the program or of a command, as --help prints it.
std::string help_text(const CLI::App& app);

/// Makes help say options in groups, input first and output last, with defaults as "(default: …)", in lines that fit a
/// terminal. Before commands are added.
void use_grouped_help(CLI::App& app);
/// Puts the options of all commands into these groups. After commands have been added.
void group_options(CLI::App& app);

}  // namespace penumbra::app
