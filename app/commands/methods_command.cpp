#include "app/commands.hpp"
#include "app/method_list.hpp"
#include "app/methods.hpp"

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <utility>

namespace penumbra::app {
namespace {

using visibility::MethodDescription;
using visibility::OptionDescription;

void print_table(const std::vector<const MethodDescription*>& methods) {
  fmt::print("{:<18} {:<10} {:<8} {:<32} {}\n", "method", "family", "output", "lights", "paper");
  for (const MethodDescription* method : methods) {
    fmt::print("{:<18} {:<10} {:<8} {:<32} {}\n", method->name, visibility::name_of(method->family),
               visibility::name_of(method->output), fmt::format("{}", fmt::join(light_names(*method), ", ")),
               method->paper);
    fmt::print("{:<18} exact for: {}\n", "", method->exact_for);
    for (const OptionDescription& option : method->options) {
      fmt::print("{:<18} {}={} (default {}): {}\n", "", option.name, option.values(), option.default_value,
                 option.help);
    }
    for (const auto& [option, value, with] : variants_of(*method)) {
      fmt::print("{:<18} with {}={}: {}; {}{}{}\n", "", option, value, visibility::name_of(with.output),
                 fmt::join(light_names(with), ", "), with.textures ? "" : "; no textures",
                 with.any_pattern ? "" : "; light samples in rows alone");
    }
  }
}

class MethodsCommand : public Command {
 public:
  explicit MethodsCommand(CLI::App& app)
      : Command(app, "methods", "list the shadow methods: family, paper, output, what each is exact for, options") {
    cli_.add_flag("--json", json_, "as JSON");
  }

  int run(const GlobalOptions&) override {
    if (json_)
      fmt::print("{}\n", methods_json().dump(2));
    else
      print_table(all_methods());
    return 0;
  }

 private:
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_methods_command(CLI::App& app) {
  return std::make_unique<MethodsCommand>(app);
}

}  // namespace penumbra::app
