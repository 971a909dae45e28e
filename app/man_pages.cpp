// SPDX-License-Identifier: Apache-2.0
// Formats manual pages.

#include "app/man_pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace penumbra::app {
namespace {

/// Escapes text for man(7): a backslash is \e, a typed hyphen is \-, and no line begins with a control character.
std::string roff(std::string_view text) {
  std::string result;
  bool starts_line = true;
  for (const char c : text) {
    if (starts_line && (c == '.' || c == '\'')) result += "\\&";
    starts_line = c == '\n';
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  return result;
}

/// Returns each line of a text as a line of the page, which man(1) fills to the terminal's width.
std::string lines_of(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    result += fmt::format("{}{}\n", result.empty() ? "" : ".br\n", roff(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string names_of(const OptionWords& option) {
  std::string text;
  const auto add = [&](const std::string& name) {
    text += fmt::format("{}\\fB{}\\fR", text.empty() ? "" : ", ", roff(name));
  };
  for (const std::string& name : option.short_names) add("-" + name);
  for (const std::string& name : option.long_names) add("--" + name);
  return option.value.empty() ? text : fmt::format("{} \\fI{}\\fR", text, roff(option.value));
}

std::string argument_of(const OptionWords& option) {
  const std::string name = fmt::format("\\fI{}\\fR{}", roff(option.argument), option.repeats ? " ..." : "");
  return option.required ? name : "[" + name + "]";
}

std::string paragraph(const std::string& head, const OptionWords& option) {
  return fmt::format(".TP\n{}\n{}\n", head, roff(option.help));
}

std::string options_of(const CommandWords& command) {
  std::string text;
  if (!command.arguments.empty()) text += ".SH ARGUMENTS\n";
  for (const OptionWords& argument : command.arguments) text += paragraph(argument_of(argument), argument);
  if (!command.options.empty()) text += ".SH OPTIONS\n";
  std::string_view group;
  for (const OptionWords& option : command.options) {
    if (option.group != group) text += fmt::format(".SS {}\n", option.group);
    group = option.group;
    text += paragraph(names_of(option), option);
  }
  return text;
}

}  // namespace

std::string man_page(std::span<const CommandWords> commands, const CommandWords& command) {
  const bool is_program = &command == commands.data();
  const std::string name = is_program ? "penumbra" : "penumbra-" + command.name;
  // First line of the program's description.
  const std::string what = command.help.substr(0, command.help.find('\n'));
  std::string text = fmt::format(".TH {} 1 \"\" \"Penumbra {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", upper(name),
                                 PENUMBRA_VERSION, roff(name), roff(what));
  text += fmt::format(".SH SYNOPSIS\n\\fB{}\\fR", roff(is_program ? "penumbra" : "penumbra " + command.name));
  if (is_program) text += " \\fICOMMAND\\fR";
  text += " [\\fIOPTIONS\\fR]";
  for (const OptionWords& argument : command.arguments) text += " " + argument_of(argument);
  text += "\n";
  if (is_program) {
    text += ".SH COMMANDS\n";
    for (const CommandWords& one : commands.subspan(1))
      text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(one.name), roff(one.help));
  }
  text += options_of(command);
  if (!command.example.empty()) text += fmt::format(".SH EXAMPLES\n.nf\n{}\n.fi\n", roff(command.example));
  if (!command.footer.empty()) text += ".SH NOTES\n" + lines_of(command.footer);
  if (!is_program)
    text +=
        ".SH EXIT STATUS\n0 done; 1 the job ran and a check failed; 2 wrong usage; 3 bad input; 4 device or "
        "resource; 130 interrupted.\n";
  text += is_program ? ".SH SEE ALSO\n" : ".SH SEE ALSO\n\\fBpenumbra\\fR(1)";
  for (const CommandWords& one : commands.subspan(1)) {
    if (&one != &command) text += fmt::format("{}\\fBpenumbra\\-{}\\fR(1)", text.ends_with('\n') ? "" : ", ", one.name);
  }
  return text + "\n";
}

}  // namespace penumbra::app
