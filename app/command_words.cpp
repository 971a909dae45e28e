// SPDX-License-Identifier: Apache-2.0
// Collects the words of commands and options from CLI11 and formats help.

#include "app/command_words.hpp"

#include "app/wrapped_lines.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <sstream>
#include <string_view>
#include <utility>

namespace penumbra::app {
namespace {

constexpr std::array kGroups = {"Input", "Light", "Picture", "Method", "Output", "General"};
constexpr std::size_t kHelpColumn = 34;       // where descriptions begin
constexpr std::size_t kNarrowHelpColumn = 8;  // the same on narrow terminals, where a description is below its name
constexpr std::size_t kTwoColumns = 72;       // least width of a terminal with names and descriptions side by side

/// Returns the group of each option that several commands have, or that is not about output. All other options are
/// outputs.
const std::map<std::string_view, std::string_view>& groups() {
  static const std::map<std::string_view, std::string_view> table = [] {
    std::map<std::string_view, std::string_view> map;
    const auto add = [&](std::string_view group, std::initializer_list<std::string_view> names) {
      for (const std::string_view name : names) map.emplace(name, group);
    };
    add("Input", {"allow-outside", "lenient", "frame", "frames", "fps", "clip", "studio", "no-studio", "floor", "mesh",
                  "instances", "uv", "vertices", "side", "weld", "no-self-intersections", "scene"});
    add("Light", {"light", "add-light", "light-samples", "sample-pattern", "sample-seed", "lamp-radius", "sun-angle",
                  "lumens-per-watt"});
    add("Picture", {"size", "camera", "normals", "pixel-samples", "pixel-filter", "filter-width", "motion-samples",
                    "moment", "shutter", "aperture", "focus-distance", "exposure", "margin", "sample-pixels"});
    add("Method", {"method", "methods", "method-option", "device", "reference", "reference-samples", "runs", "over",
                   "construction", "from", "error-budget"});
    add("General", {"help", "quiet", "verbose", "threads", "version"});
    return map;
  }();
  return table;
}

/// Returns a command line for the most common use of the command; tests/docs/examples.py runs each as a reader would,
/// in a folder with the shipped scenes.
std::string_view example_of(const CLI::App& command) {
  static const std::map<std::string_view, std::string_view> table = {
      {"render", "penumbra render scenes/room.json -o room.exr --png room.png"},
      {"compare", "penumbra compare scenes/fusion.json -o out --methods pcss --size 256x256"},
      {"sweep", "penumbra sweep scenes/fusion.json -o out --methods pcss --over size=128,256"},
      {"bake", "penumbra bake scenes/contact.json --mesh floor --size 256 -o floor.exr"},
      {"inspect", "penumbra inspect scenes/broken.json --png defects.png"},
      {"methods", "penumbra methods pcss"},
      {"devices", "penumbra devices"},
      {"convert", "penumbra convert scenes/room.json -o room.glb"},
      {"wedges", "penumbra wedges scenes/fusion.json --light key --validate"},
      {"submit", "penumbra submit shot.glb --frames 1-240 -o shot/beauty.####.exr"},
      {"view", "penumbra view scenes/bunny.json"},
      {"serve", "penumbra serve"},
      {"help", "penumbra help render"},
      {"version", "penumbra version"},
      {"completion", "penumbra completion bash > penumbra.bash"},
      {"man", "penumbra man render > penumbra-render.1"},
  };
  const auto found = table.find(command.get_name());
  return found != table.end() ? found->second : std::string_view();
}

std::string_view group_of(const CLI::Option& option) {
  for (const std::string& name : option.get_lnames()) {
    const auto found = groups().find(name);
    if (found != groups().end()) return found->second;
  }
  return "Output";
}

std::string with_default(const CLI::Option& option) {
  std::string text = option.get_description();
  const std::string value = option.get_default_str();
  if (!value.empty() && text.find("(default") == std::string::npos && option.get_type_size() != 0)
    text += fmt::format(" (default: {})", value);
  return text;
}

/// Returns the type of an option's value, without CLI11's description of its checks (":INT in [1 - 4096]").
std::string value_name(const CLI::Option& option) {
  const std::string name = option.get_type_name();
  return name.substr(0, std::min(name.find(":INT in"), name.find(":UINT in")));
}

class GroupedFormatter : public CLI::Formatter {
 public:
  GroupedFormatter() {
    label("Positionals", "Arguments");
    label("Subcommands", "Commands");
    label("SUBCOMMAND", "COMMAND");
  }

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    std::stringstream text;
    text << paragraphs(make_description(app)) << paragraphs(make_usage(app, std::move(name))) << make_positionals(app);
    for (const char* group : kGroups) {
      const auto options = app->get_options(
          [&](const CLI::Option* option) { return option->get_group() == group && option->nonpositional(); });
      if (!options.empty()) text << make_group(group, false, options);
    }
    text << make_subcommands(app, mode) << '\n';
    if (!example_of(*app).empty()) text << paragraphs(fmt::format("Example:\n  {}\n", example_of(*app)));
    text << paragraphs(make_footer(app));
    if (app->get_parent() != nullptr)
      text << paragraphs("All commands also take --quiet, --verbose and --threads N: `penumbra --help`.\n");
    return text.str();
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return row(make_option_name(option, is_positional) + make_option_opts(option), with_default(*option));
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text;
    const std::string value = option->get_positional() ? "" : value_name(*option);
    if (option->get_type_size() != 0 && !value.empty()) text += " " + value;
    if (option->get_expected_max() == CLI::detail::expected_max_vector_size) text += " ...";
    if (option->get_required()) text += " (required)";
    return text;
  }

  std::string make_subcommand(const CLI::App* command) const override {
    return row(command->get_name(), command->get_description());
  }

 private:
  [[nodiscard]] std::string paragraphs(const std::string& text) const {
    return wrapped_lines(text, {.width = width_, .indent = 2});
  }

  /// Puts a description to the right of a name; below the name if the name is too long, or the terminal too narrow.
  [[nodiscard]] std::string row(const std::string& name, const std::string& description) const {
    const std::size_t column = width_ < kTwoColumns ? kNarrowHelpColumn : kHelpColumn;
    std::string text = wrapped_lines("  " + name, {.width = width_, .indent = 2});
    if (!description.empty()) {
      const bool fits = text.find('\n') == std::string::npos && columns_of(text) < column;
      text += fits ? std::string(column - columns_of(text), ' ') : '\n' + std::string(column, ' ');
      text += wrapped_lines(description, {.width = width_, .start = column, .indent = column});
    }
    return text + '\n';
  }

  std::size_t width_ = help_width();
};

OptionWords words_of(const CLI::Option& option) {
  OptionWords words;
  words.short_names = option.get_snames();
  words.long_names = option.get_lnames();
  words.help = with_default(option);
  words.group = option.get_group();
  words.required = option.get_required();
  words.repeats = option.get_expected_max() == CLI::detail::expected_max_vector_size;
  if (option.get_positional()) words.argument = option.get_name(true, false);
  if (option.get_items_expected_max() > 0 && option.get_type_size() != 0) words.value = value_name(option);
  return words;
}

CommandWords words_of(const CLI::App& command) {
  CommandWords words{
      command.get_name(), command.get_description(), std::string(example_of(command)), command.get_footer(), {}, {}};
  for (const CLI::Option* option : command.get_options()) {
    (option->get_positional() ? words.arguments : words.options).push_back(words_of(*option));
  }
  const auto place = [](const OptionWords& option) {
    return std::ranges::find(kGroups, option.group) - kGroups.begin();
  };
  std::ranges::stable_sort(words.options, {}, place);
  return words;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

}  // namespace

std::vector<CommandWords> words_of_commands(const CLI::App& app) {
  std::vector<CommandWords> all = {words_of(app)};
  for (const CLI::App* command : commands_of(app)) all.push_back(words_of(*command));
  return all;
}

std::string help_text(const CLI::App& app) {
  const std::string name = app.get_parent() == nullptr ? app.get_name() : "penumbra " + app.get_name();
  return app.get_formatter()->make_help(&app, name, CLI::AppFormatMode::Normal);
}

void use_grouped_help(CLI::App& app) {
  app.formatter(std::make_shared<GroupedFormatter>());
}

void group_options(CLI::App& app) {
  const auto group = [](CLI::App& command) {
    for (CLI::Option* option : command.get_options()) option->group(std::string(group_of(*option)));
  };
  group(app);
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) group(*command);
}

}  // namespace penumbra::app
