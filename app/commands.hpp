#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace penumbra::app {

/// What all commands share.
struct GlobalOptions {
  bool quiet = false, verbose = false;
  std::uint32_t threads = 0;           ///< the most that work at once; 0: as many as there are processors
  std::vector<std::string> arguments;  ///< what followed the program's name
};

/// A subcommand: holds the options that it added to the command line, and does the job when it was chosen.
class Command {
 public:
  virtual ~Command() = default;
  /// Returns the exit code, or throws Error.
  virtual int run(const GlobalOptions& global) = 0;
  [[nodiscard]] bool chosen() const;

 protected:
  Command(CLI::App& app, const std::string& name, const std::string& help);
  CLI::App& cli_;
};

/// Parses the command line, and runs the command that it names. Returns the exit code, or throws Error.
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
std::unique_ptr<Command> make_view_command(CLI::App& app);
std::unique_ptr<Command> make_help_command(CLI::App& app);
std::unique_ptr<Command> make_version_command(CLI::App& app);
std::unique_ptr<Command> make_completion_command(CLI::App& app);
std::unique_ptr<Command> make_man_command(CLI::App& app);

}  // namespace penumbra::app
