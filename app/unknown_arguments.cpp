// SPDX-License-Identifier: Apache-2.0
// Explains unknown words of a command line by the nearest existing names.

#include "app/unknown_arguments.hpp"

#include "base/did_you_mean.hpp"

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace penumbra::app {
namespace {

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

std::vector<std::string> names_of_options(const CLI::App& app, const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* one : {&command, &app}) {
    for (const CLI::Option* option : one->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  }
  return names;
}

}  // namespace

std::string explain_unknown_arguments(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining(true);
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const auto option = std::ranges::find_if(words, [](const std::string& word) { return word.starts_with('-'); });
  if (chosen.empty()) {
    const auto command = std::ranges::find_if(words, [](const std::string& word) { return !word.starts_with('-'); });
    if (command == words.end()) return fmt::format("no command comes after {}", fmt::join(words, " "));
    const std::vector<std::string> names = names_of_commands(app);
    return fmt::format("there is no command \"{}\"; commands: {}{}", *command, fmt::join(names, ", "),
                       did_you_mean(*command, names));
  }
  const CLI::App& command = *chosen.front();
  if (option != words.end()) {
    const std::string name = option->substr(0, option->find('='));
    return fmt::format("{} has no option {}{}", command.get_name(), name,
                       did_you_mean(name, names_of_options(app, command)));
  }
  return fmt::format("{} does not expect {}", command.get_name(), fmt::join(words, " "));
}

}  // namespace penumbra::app
