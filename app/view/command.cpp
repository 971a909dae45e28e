// SPDX-License-Identifier: Apache-2.0
// Command `view`: serves a scene to a browser.

#include "app/commands.hpp"
#include "app/process/process.hpp"
#include "app/process/terminal_progress.hpp"
#include "app/reading_options.hpp"
#include "app/run_options.hpp"
#include "app/view/file_watch.hpp"
#include "app/view/live_view.hpp"
#include "base/child.hpp"
#include "base/descriptor.hpp"
#include "base/error.hpp"
#include "session/options.hpp"
#include "session/session.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace penumbra::app {
namespace {

/// Returns the path of a program, found as by a shell; empty: not found.
std::string program_path(const std::string& name) {
  const char* const variable = std::getenv("PATH");
  std::string rest = variable == nullptr ? "" : variable;
  while (!rest.empty()) {
    const std::string folder = rest.substr(0, rest.find(':'));
    rest.erase(0, folder.size() + 1);
    const std::string path = folder + "/" + name;
    if (!folder.empty() && access(path.c_str(), X_OK) == 0) return path;
  }
  return "";
}

class ViewCommand : public Command {
 public:
  explicit ViewCommand(CLI::App& app)
      : Command(app, "view",
                "show the scene in a browser, where camera and lights can be moved: serves one page on this machine, "
                "and prints its address") {
    cli_.add_option("SCENE", run_.scene,
                    "scene file: .json (penumbra-scene/1), .gltf or .glb; or a mesh file, around which a studio is put")
        ->required();
    cli_.add_option("--host", host_,
                    "address of this machine to serve on; addresses other than the loopback address admit, without "
                    "encryption, every client that knows the complete address")
        ->type_name("ADDRESS")
        ->capture_default_str();
    cli_.add_option("--port", port_, "port to serve on; 0: any free port")
        ->type_name("N")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    cli_.add_flag("--no-browser", no_browser_, "do not open the address in a browser");
    cli_.add_flag("--watch", watch_, "read the scene again when its file, or a file that it names, changes");
    cli_.add_option("--method", method_, "method to begin with, NAME:key=value:... (default: exact areas)")
        ->type_name("NAME");
    cli_.add_option("--method-b", other_, "second method, for comparison, NAME:key=value:... (default: none)")
        ->type_name("NAME");
    cli_.add_option("--light-samples", samples_, "light samples to begin with, 1 to 4096 (default: exact areas)")
        ->type_name("N")
        ->check(CLI::Range(1, 4096));
    cli_.add_option("--size", run_.size, "image size in pixels (default: the scene's)")->type_name("WxH");
    cli_.add_option("--camera", run_.camera,
                    "camera: name of one in the scene, fit for a camera that sees the whole scene, or "
                    "EX,EY,EZ:TX,TY,TZ[:FOV], eye, target and vertical degrees (default: the scene's first)")
        ->type_name("NAME|fit|E:T[:FOV]");
    cli_.add_option("--device", run_.device, "Vulkan device: part of its name, its index, or cpu (default: the best)")
        ->type_name("NAME|INDEX|cpu");
    cli_.add_option("--instances", instances_,
                    "instances of meshes: copies (take time and memory at the start); shared (needed triangles are "
                    "found again for each picture; only for methods that need the space between view samples and "
                    "lights alone); or auto (copies up to 5,000,000 triangles)")
        ->type_name("auto|copies|shared");
    add_allow_outside(cli_, run_.allow_outside);
    add_lenient(cli_, run_.lenient);
    add_gltf_options(cli_, run_.gltf);
    add_studio_options(cli_, run_.studio);
  }

  int run(const GlobalOptions& global) override {
    if (!run_.size.empty()) static_cast<void>(session::parse_size(run_.size));
    TerminalProgress progress(!global.quiet);
    progress.begin("reading " + run_.scene.filename().string(), 1);
    FileWatch files({run_.scene});  // set before reading: the scene is read again after changes during reading
    WholeScene whole = read_whole_scene(run_, session::parse_instances(instances_, {}));
    progress.clear();
    for (const std::string& warning : whole.scene.warnings) spdlog::warn("{}", warning);
    LiveView view(run_, std::move(whole), {host_, static_cast<std::uint16_t>(port_)});
    if (!method_.empty()) view.renderer().apply({{"type", "method"}, {"slot", "a"}, {"entry", method_}}, 0);
    if (!other_.empty()) view.renderer().apply({{"type", "method"}, {"slot", "b"}, {"entry", other_}}, 0);
    if (samples_ != 0) view.renderer().apply({{"type", "samples"}, {"count", samples_}}, 0);
    fmt::print("{}\n", view.address());
    std::fflush(stdout);
    check_stdout();
    spdlog::info("serving {}; Ctrl-C ends it", run_.scene.filename().string());
    const std::optional<Child> browser = no_browser_ ? std::nullopt : open_browser(view.address());
    for (;;) {  // until a signal ends the process
      view.renderer().watch(std::chrono::milliseconds(200));
      if (!watch_) continue;
      files.look_at(view.renderer().sources());
      if (!files.changed()) continue;
      spdlog::info("{} has changed: reading it again", run_.scene.filename().string());
      view.renderer().reload();
    }
  }

 private:
  /// Returns nullopt without a display: there is no browser to open.
  static std::optional<Child> open_browser(const std::string& address) {
    const bool has_display = std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
    const std::string opener = has_display ? program_path("xdg-open") : "";
    if (opener.empty()) return std::nullopt;
    const Descriptor nothing(open("/dev/null", O_RDWR | O_CLOEXEC));
    const ChildStart start = start_child({{opener, address}, {nothing.get(), nothing.get(), nothing.get()}});
    if (start.error != 0) return std::nullopt;
    return std::optional<Child>(std::in_place, start.pid);
  }

  session::RunOptions run_;
  std::string host_ = network::ServerPlace().host;
  int port_ = 0;
  std::uint32_t samples_ = 0;
  bool no_browser_ = false, watch_ = false;
  std::string method_, other_, instances_;
};

}  // namespace

std::unique_ptr<Command> make_view_command(CLI::App& app) {
  return std::make_unique<ViewCommand>(app);
}

}  // namespace penumbra::app
