// SPDX-License-Identifier: Apache-2.0
// Generates completion scripts of shells.

#include "app/shell_completion.hpp"

#include "base/error.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace penumbra::app {
namespace {

/// Kind of completions of a value.
enum class ValueKind { nothing, files, methods, commands };

ValueKind values_of(const CommandWords& command, const OptionWords& option) {
  const auto is = [&](std::string_view name) {
    return std::ranges::find(option.long_names, name) != option.long_names.end();
  };
  if (option.is_flag()) return ValueKind::nothing;
  if (is("method") || is("methods") || is("reference")) return ValueKind::methods;
  if (option.argument == "COMMAND") return ValueKind::commands;
  if (option.argument == "NAME" && command.name == "methods") return ValueKind::methods;
  const bool is_file = !option.argument.empty() || option.value.find("FILE") != std::string::npos ||
                       option.value.find("OUT") != std::string::npos || option.value.find("DIR") != std::string::npos ||
                       option.value.find("MAP") != std::string::npos;
  return is_file ? ValueKind::files : ValueKind::nothing;
}

std::vector<std::string> hyphened(const OptionWords& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.short_names) names.push_back("-" + name);
  for (const std::string& name : option.long_names) names.push_back("--" + name);
  return names;
}

std::vector<std::string> hyphened(const CommandWords& command) {
  std::vector<std::string> names;
  for (const OptionWords& option : command.options) std::ranges::copy(hyphened(option), std::back_inserter(names));
  return names;
}

std::vector<std::string> names_of(std::span<const CommandWords> commands) {
  std::vector<std::string> names;
  for (const CommandWords& command : commands.subspan(1)) names.push_back(command.name);
  return names;
}

/// Returns the options with a value of this kind, in any command, as patterns of a shell's `case`.
std::string pattern_of(std::span<const CommandWords> commands, ValueKind kind) {
  std::vector<std::string> names;
  for (const CommandWords& command : commands) {
    for (const OptionWords& option : command.options) {
      if (!option.is_flag() && values_of(command, option) == kind)
        std::ranges::copy(hyphened(option), std::back_inserter(names));
    }
  }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return fmt::format("{}", fmt::join(names, "|"));
}

std::string bash(std::span<const CommandWords> commands, std::span<const std::string> methods) {
  std::string cases;
  for (const CommandWords& command : commands.subspan(1)) {
    const bool takes_methods =
        !command.arguments.empty() && values_of(command, command.arguments.front()) == ValueKind::methods;
    const bool takes_commands =
        !command.arguments.empty() && values_of(command, command.arguments.front()) == ValueKind::commands;
    cases += fmt::format("    {}) options=\"{}\"; words=\"{}\" ;;\n", command.name, fmt::join(hyphened(command), " "),
                         takes_methods    ? "$methods"
                         : takes_commands ? "$commands"
                                          : "");
  }
  return fmt::format(R"(# Completion of bash for penumbra: written by `penumbra completion bash`.
_penumbra() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" previous="${{COMP_WORDS[COMP_CWORD-1]}}" command="" options="" words="" i
  local commands="{0}"
  local methods="{1}"
  local global="{2}"
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case " $commands " in *" ${{COMP_WORDS[i]}} "*) command="${{COMP_WORDS[i]}}"; break ;; esac
  done
  case "$previous" in
    {3}) COMPREPLY=($(compgen -W "$methods" -- "$current")); return ;;
    {4}) COMPREPLY=($(compgen -f -- "$current")); return ;;
    {5}) return ;;
  esac
  case "$command" in
{6}    *) words="$commands" ;;
  esac
  if [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options $global" -- "$current"))
  elif [[ -n $words ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  else
    COMPREPLY=($(compgen -f -- "$current"))
  fi
}}
complete -o filenames -F _penumbra penumbra
)",
                     fmt::join(names_of(commands), " "), fmt::join(methods, " "),
                     fmt::join(hyphened(commands.front()), " "), pattern_of(commands, ValueKind::methods),
                     pattern_of(commands, ValueKind::files), pattern_of(commands, ValueKind::nothing), cases);
}

/// Escapes a text in single quotes: characters in `stops` get a backslash.
std::string in_quotes(std::string_view text, std::string_view stops) {
  std::string result;
  for (const char c : text) {
    if (c == '\'')
      result += "'\\''";
    else if (c == '\n')
      result += ' ';
    else
      result += stops.find(c) == std::string_view::npos ? std::string(1, c) : std::string("\\") + c;
  }
  return result;
}

std::string_view zsh_action(ValueKind kind) {
  switch (kind) {
    case ValueKind::methods:
      return "($methods)";
    case ValueKind::commands:
      return "($names)";
    case ValueKind::files:
      return "_files";
    case ValueKind::nothing:
      break;
  }
  return " ";
}

std::string zsh_arguments(const CommandWords& command) {
  constexpr std::string_view kStops = "[]:\\";
  std::string text;
  for (const OptionWords& option : command.options) {
    for (const std::string& name : hyphened(option)) {
      text += fmt::format(" \\\n        '*{}[{}]", name, in_quotes(option.help, kStops));
      if (!option.is_flag())
        text += fmt::format(":{}:{}", in_quotes(option.value, kStops), zsh_action(values_of(command, option)));
      text += "'";
    }
  }
  for (const OptionWords& argument : command.arguments) {
    text += fmt::format(" \\\n        '{}:{}:{}'", argument.repeats ? "*" : "", in_quotes(argument.argument, kStops),
                        zsh_action(values_of(command, argument)));
  }
  return text;
}

std::string zsh(std::span<const CommandWords> commands, std::span<const std::string> methods) {
  std::string described, cases;
  for (const CommandWords& command : commands.subspan(1)) {
    described += fmt::format("    '{}:{}'\n", command.name, in_quotes(command.help, ":\\"));
    cases += fmt::format("    {})\n      _arguments{}\n      ;;\n", command.name, zsh_arguments(command));
  }
  return fmt::format(R"(#compdef penumbra
# Completion of zsh for penumbra: written by `penumbra completion zsh`.
_penumbra() {{
  local -a commands methods names
  commands=(
{}  )
  names=({})
  methods=({})
  local context state line
  _arguments -C{} \
        '1: :->command' '*:: :->rest'
  case $state in
    command) _describe command commands ;;
    rest)
  case $words[1] in
{}  esac
  ;;
  esac
}}
_penumbra "$@"
)",
                     described, fmt::join(names_of(commands), " "), fmt::join(methods, " "),
                     zsh_arguments(commands.front()), cases);
}

std::string fish(std::span<const CommandWords> commands, std::span<const std::string> methods) {
  constexpr std::string_view kStops = "\\";
  std::string text = "# Completion of fish for penumbra: written by `penumbra completion fish`.\n";
  const std::string names = fmt::format("{}", fmt::join(names_of(commands), " "));
  for (const CommandWords& command : commands) {
    const bool is_program = &command == commands.data();
    const std::string when = is_program ? "" : fmt::format(" -n '__fish_seen_subcommand_from {}'", command.name);
    if (!is_program)
      text += fmt::format("complete -c penumbra -f -n 'not __fish_seen_subcommand_from {}' -a {} -d '{}'\n", names,
                          command.name, in_quotes(command.help, kStops));
    const auto with_values = [&](ValueKind kind) -> std::string {
      if (kind == ValueKind::methods) return fmt::format(" -x -a '{}'", fmt::join(methods, " "));
      if (kind == ValueKind::commands) return fmt::format(" -x -a '{}'", names);
      return kind == ValueKind::files ? " -r -F" : " -x";
    };
    for (const OptionWords& option : command.options) {
      text += "complete -c penumbra" + when;
      for (const std::string& name : option.short_names) text += " -s " + name;
      for (const std::string& name : option.long_names) text += " -l " + name;
      if (!option.is_flag()) text += with_values(values_of(command, option));
      text += fmt::format(" -d '{}'\n", in_quotes(option.help, kStops));
    }
    for (const OptionWords& argument : command.arguments) {
      const ValueKind kind = values_of(command, argument);
      if (kind == ValueKind::methods || kind == ValueKind::commands)
        text += fmt::format("complete -c penumbra{}{}\n", when, with_values(kind));
    }
  }
  return text;
}

}  // namespace

std::string shell_completion(std::string_view shell, std::span<const CommandWords> commands,
                             std::span<const std::string> methods) {
  if (shell == "bash") return bash(commands, methods);
  if (shell == "zsh") return zsh(commands, methods);
  if (shell == "fish") return fish(commands, methods);
  if (shell == "commands") return fmt::format("{}\n", fmt::join(names_of(commands), ";"));
  throw UsageError("completion {}: expected bash, zsh, fish or commands", shell);
}

}  // namespace penumbra::app
