// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace penumbra::app {

/// Options common to all commands.
struct GlobalOptions {
  bool quiet = false, verbose = false;
  std::uint32_t threads = 0;           ///< largest number of threads at work; 0: the number of processors
  std::vector<std::string> arguments;  ///< arguments of the program
};

/// Subcommand: holds the options it added to the command line, and runs if chosen.
class Command {
 public:
  virtual ~Command() = default;
  /// Runs the command and returns the exit code. Throws Error.
  virtual int run(const GlobalOptions& global) = 0;
  [[nodiscard]] bool chosen() const;

 protected:
  Command(CLI::App& app, const std::string& name, const std::string& help);
  CLI::App& cli_;
};

/// Parses the command line, runs the named command and returns its exit code. Throws Error.
int run_command_line(int argc, char** argv);

std::unique_ptr<Command> make_render_command(CLI::App& app);
std::unique_ptr<Command> make_compare_command(CLI::App& app);
std::unique_ptr<Command> make_sweep_command(CLI::App& app);
std::unique_ptr<Command> make_bake_command(CLI::App& app);
std::unique_ptr<Command> make_inspect_command(CLI::App& app);
std::unique_ptr<Command> make_methods_command(CLI::App& app);
std::unique_ptr<Command> make_devices_command(CLI::App& app);
std::unique_ptr<Command> make_convert_command(CLI::App& app);
std::unique_ptr<Command> make_wedges_command(CLI::App& app);
std::unique_ptr<Command> make_submit_command(CLI::App& app);
std::unique_ptr<Command> make_serve_command(CLI::App& app);
std::unique_ptr<Command> make_view_command(CLI::App& app);
std::unique_ptr<Command> make_help_command(CLI::App& app);
std::unique_ptr<Command> make_version_command(CLI::App& app);
std::unique_ptr<Command> make_completion_command(CLI::App& app);
std::unique_ptr<Command> make_man_command(CLI::App& app);

}  // namespace penumbra::app
