// SPDX-License-Identifier: Apache-2.0
// `penumbra serve`: hands stdin and stdout to a Service and exits without clean-up, since finishing a picture that is
// no longer wanted could take seconds.

#include "app/commands.hpp"
#include "app/serve/service.hpp"
#include "base/error.hpp"
#include "session/options.hpp"

#include <CLI/CLI.hpp>

#include <unistd.h>

namespace penumbra::app {
namespace {

class ServeCommand : public Command {
 public:
  explicit ServeCommand(CLI::App& app)
      : Command(app, "serve",
                "make pictures for another program, such as Blender's viewport, which sends messages to stdin and gets "
                "answers from stdout (docs/serve.md); exits at the end of its input") {
    cli_.add_option("--device", run_.device, "Vulkan device: part of its name, its index, or cpu (default: the best)")
        ->type_name("NAME|INDEX|cpu");
    cli_.add_option("--normals", run_.normals,
                    "normals of the pictures that are shown: shading or geometric (default: shading)")
        ->type_name("KIND");
  }

  int run(const GlobalOptions& /*global*/) override {
    static_cast<void>(session::parse_normals(run_.normals));
    if (::isatty(STDIN_FILENO) != 0)
      throw UsageError("stdin is a terminal; another program sends the messages (docs/serve.md)");
    Service service(run_, STDIN_FILENO, STDOUT_FILENO);
    service.run();
    ::_exit(0);  // without clean-up: waiting for the current picture or the device could take seconds
  }

 private:
  session::RunOptions run_;
};

}  // namespace

std::unique_ptr<Command> make_serve_command(CLI::App& app) {
  return std::make_unique<ServeCommand>(app);
}

}  // namespace penumbra::app
