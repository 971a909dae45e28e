// SPDX-License-Identifier: Apache-2.0
// Parses the command line and runs the chosen command.

#include "app/commands.hpp"

#include "app/command_words.hpp"
#include "app/process/process.hpp"
#include "app/unknown_arguments.hpp"
#include "base/error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace penumbra::app {
namespace {

constexpr const char* kDescription =
    "Penumbra: soft shadows from area lights, geometry-based, image-based and ray-traced, on the same view samples.\n"
    "Results go to stdout, messages to stderr.";

constexpr const char* kFooter =
    "Exit codes: 0 done; 1 the job ran and a check failed; 2 wrong usage; 3 bad input; 4 device or resource; "
    "130 interrupted. An output file appears whole or not at all; if the results cannot be written to stdout (a full "
    "disk, a closed pipe), the code is 4.\n"
    "`penumbra help COMMAND` explains a command, `penumbra methods NAME` a method.";

void start_log(const GlobalOptions& global) {
  auto logger = spdlog::stderr_logger_st("penumbra");
  logger->set_pattern("penumbra: %l: %v");
  logger->set_level(global.quiet ? spdlog::level::err : global.verbose ? spdlog::level::debug : spdlog::level::info);
  spdlog::set_default_logger(logger);
}

/// Rejects `--flag=3`: CLI11 would interpret the text as the flag's value.
void refuse_values_of_flags(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_items_expected_max() == 0) option->disable_flag_override();
  }
  for (CLI::App* command : app.get_subcommands({})) refuse_values_of_flags(*command);
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app(kDescription, "penumbra");
  app.footer(kFooter);
  app.set_version_flag("-V,--version", "penumbra " PENUMBRA_VERSION, "print the program's version");
  app.set_help_flag("-h,--help", "print this help");
  use_grouped_help(app);
  app.require_subcommand(0, 1);  // a missing command is rejected below: CLI11 would not name an unknown word
  app.fallthrough();             // --quiet and --verbose may come before or after the command's name

  GlobalOptions global;
  global.arguments.assign(argv + 1, argv + argc);
  auto* quiet = app.add_flag("-q,--quiet", global.quiet, "only errors on stderr, no progress bar");
  app.add_flag("-v,--verbose", global.verbose, "report each step on stderr")->excludes(quiet);
  app.add_option(
         "--threads", global.threads,
         "largest number of threads that work at once (default: the number of processors); results do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));

  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(make_render_command(app));
  commands.push_back(make_compare_command(app));
  commands.push_back(make_sweep_command(app));
  commands.push_back(make_bake_command(app));
  commands.push_back(make_inspect_command(app));
  commands.push_back(make_methods_command(app));
  commands.push_back(make_devices_command(app));
  commands.push_back(make_convert_command(app));
  commands.push_back(make_wedges_command(app));
  commands.push_back(make_submit_command(app));
  commands.push_back(make_view_command(app));
  commands.push_back(make_serve_command(app));
  commands.push_back(make_help_command(app));
  commands.push_back(make_version_command(app));
  commands.push_back(make_completion_command(app));
  commands.push_back(make_man_command(app));
  group_options(app);
  refuse_values_of_flags(app);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // `penumbra WORD --help`: CLI11 handles --help before it checks WORD.
    const bool no_command =
        app.get_subcommands().empty() &&
        std::ranges::any_of(app.remaining(), [](const std::string& word) { return !word.starts_with('-'); });
    if (error.get_exit_code() == 0 && !no_command) {  // --help, --version: on stdout
      app.exit(error);
      check_stdout();
      return 0;
    }
    const bool unknown = no_command || dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
    say(fmt::format("penumbra: error: {}\nRun `penumbra {}--help` for its options.\n",
                    unknown ? explain_unknown_arguments(app) : error.what(),
                    app.get_subcommands().empty() ? "" : app.get_subcommands().front()->get_name() + " "));
    return static_cast<int>(ExitCode::usage);
  }
  start_log(global);
  std::optional<tbb::global_control> threads;
  if (global.threads > 0) threads.emplace(tbb::global_control::max_allowed_parallelism, global.threads);
  const auto chosen = std::ranges::find_if(commands, [](const auto& command) { return command->chosen(); });
  if (chosen == commands.end()) throw UsageError("no command; `penumbra --help` lists the commands");
  const int code = (*chosen)->run(global);
  check_stdout();
  return code;
}

Command::Command(CLI::App& app, const std::string& name, const std::string& help)
    : cli_(*app.add_subcommand(name, help)) {}

bool Command::chosen() const {
  return cli_.parsed();
}

}  // namespace penumbra::app
