// SPDX-License-Identifier: Apache-2.0
// `penumbra methods`: a table of all methods, one method in full, or both as JSON. Everything shown comes from
// `MethodDescription`, so that a new method needs no line here.

#include "app/commands.hpp"
#include "session/method_list.hpp"
#include "session/methods.hpp"

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::app {
namespace {

using visibility::MethodDescription;
using visibility::OptionDescription;

void print_table(const std::vector<const MethodDescription*>& methods) {
  fmt::print("{:<18} {:<10} {:<8} {:<32} {}\n", "method", "family", "output", "lights", "paper");
  for (const MethodDescription* method : methods) {
    fmt::print("{:<18} {:<10} {:<8} {:<32} {}\n", method->name, visibility::name_of(method->family),
               visibility::name_of(method->output), fmt::format("{}", fmt::join(session::light_names(*method), ", ")),
               method->paper);
    fmt::print("{:<18} exact for: {}\n", "", method->exact_for);
    for (const OptionDescription& option : method->options) {
      fmt::print("{:<18} {}={} (default: {}): {}\n", "", option.name, option.values(), option.default_value,
                 option.help);
    }
    for (const auto& [option, value, with] : session::variants_of(*method)) {
      fmt::print("{:<18} with {}={}: {}; {}{}{}\n", "", option, value, visibility::name_of(with.output),
                 fmt::join(session::light_names(with), ", "), with.textures ? "" : "; no textures",
                 with.any_pattern ? "" : "; light samples only in rows");
    }
  }
}

/// Prints one method in full: the contents of its row, each option on separate lines, an example of its use, and its
/// page.
void print_method(const MethodDescription& method) {
  const auto line = [](const char* label, const std::string& text) { fmt::print("{:<11} {}\n", label, text); };
  fmt::print("{}\n", method.name);
  line("family", visibility::name_of(method.family));
  line("paper", method.paper);
  line("output", visibility::name_of(method.output));
  line("exact for", method.exact_for);
  line("lights",
       fmt::format("{}{}", fmt::join(session::light_names(method), ", "), method.textures ? "" : "; no textures"));
  if (!method.any_pattern) line("samples", "only in rows (--sample-pattern rows or grid)");
  if (method.exact_area) {
    std::string with;
    for (const auto& [key, value] : method.exact_area->options) with += fmt::format(":{}={}", key, value);
    line("exact area", fmt::format("--method {}{}", method.name, with));
  }
  line("render", fmt::format("penumbra render SCENE -o OUT.exr --method {}{}", method.name,
                             method.options.empty() ? "" : "[:key=value…]"));
  line("page", fmt::format("docs/{}.md, with its picture and its error map", method.name));
  if (!method.options.empty()) fmt::print("options\n");
  for (const OptionDescription& option : method.options) {
    fmt::print("  {}={} (default: {})\n      {}\n", option.name, option.values(), option.default_value, option.help);
  }
  for (const auto& [option, value, with] : session::variants_of(method)) {
    fmt::print("  with {}={}: {}; {}{}{}\n", option, value, visibility::name_of(with.output),
               fmt::join(session::light_names(with), ", "), with.textures ? "" : "; no textures",
               with.any_pattern ? "" : "; light samples only in rows");
  }
}

class MethodsCommand : public Command {
 public:
  explicit MethodsCommand(CLI::App& app)
      : Command(app, "methods", "list the shadow methods: family, paper, output, what each is exact for, options") {
    cli_.add_option("NAME", names_, "methods to show in full (default: a table of all methods)")->type_name("");
    cli_.add_flag("--json", json_, "print JSON in place of the table");
  }

  int run(const GlobalOptions&) override {
    for (const std::string& name : names_) session::describe_method(name);  // throws for an unknown name
    if (json_) {
      nlohmann::ordered_json json = session::methods_json();
      if (!names_.empty()) {
        auto chosen = nlohmann::ordered_json::array();
        for (auto& row : json["methods"]) {
          if (std::ranges::find(names_, row["name"].get<std::string>()) != names_.end())
            chosen.push_back(std::move(row));
        }
        json["methods"] = std::move(chosen);
      }
      fmt::print("{}\n", json.dump(2));
    } else if (names_.empty()) {
      print_table(session::all_methods());
    }
    for (std::size_t i = 0; !json_ && i < names_.size(); ++i) {
      if (i > 0) fmt::print("\n");
      print_method(session::describe_method(names_[i]));
    }
    return 0;
  }

 private:
  std::vector<std::string> names_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_methods_command(CLI::App& app) {
  return std::make_unique<MethodsCommand>(app);
}

}  // namespace penumbra::app
