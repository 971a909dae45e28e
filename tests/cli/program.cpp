// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/program.hpp"

#include "tests/child_arguments.hpp"
#include "tests/child_pipes.hpp"
#include "tests/unit/import/gltf_file.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace penumbra::tests {
namespace {

constexpr const char* kTinyScene = R"({
  "format": "penumbra-scene/1",
  "size": [48, 32],
  "camera": {"eye": [2, 3, 6], "target": [0, 0.5, 0], "up": [0, 1, 0], "verticalFov": 45},
  "meshes": [
    {"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [4, 0, 0], "halfV": [0, 0, -4]}, "color": [0.5, 0.5, 0.5]},
    {"name": "wedge", "triangles": [[-1,1,-1, 1,1,-1, 0,1.5,1], [-1,1,-1, 0,1.5,1, -1,0.2,1]]}
  ],
  "lights": [
    {"name": "key", "rectangle": {"center": [0, 4, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}, "radiance": [10, 10, 10]}
  ]
})";

std::vector<std::string> child_environment(const Invocation& invocation) {
  std::map<std::string, std::string> more{{"PENUMBRA_VALIDATION", "1"}};  // a validation message fails its test
  for (const auto& [name, value] : invocation.environment) more[name] = value;
  return environment_with(more);
}

/// Reads both pipes until the child closes them; sends the signals at their times.
void collect(pid_t child, int out, int err, const Invocation& invocation, Outcome& outcome) {
  const auto start = std::chrono::steady_clock::now();
  bool interrupted = false;
  ChildPipes pipes(out, err, outcome.out, outcome.err);
  while (pipes.open()) {
    pipes.read_within(10);
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (invocation.interrupt_after && !interrupted && elapsed >= *invocation.interrupt_after) {
      ::kill(child, SIGINT);
      interrupted = true;
    }
    if (elapsed > invocation.timeout) ::kill(child, SIGKILL);
  }
}

}  // namespace

Outcome run_program(const Invocation& invocation) {
  std::vector<std::string> arguments = invocation.arguments;
  arguments.insert(arguments.begin(), PENUMBRA_PROGRAM);
  std::vector<std::string> environment = child_environment(invocation);
  const std::vector<char*> argv = pointers(arguments), envp = pointers(environment);

  std::array<int, 2> out{}, err{};
  if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(err.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe");
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("fork");
  if (child == 0) {
    ::dup2(out[1], STDOUT_FILENO);
    ::dup2(err[1], STDERR_FILENO);
    ::signal(SIGINT, SIG_DFL);  // a shell ignores it for jobs in the background, and children inherit that
    ::execve(PENUMBRA_PROGRAM, argv.data(), envp.data());
    ::_exit(126);
  }
  ::close(out[1]);
  ::close(err[1]);
  Outcome outcome;
  collect(child, out[0], err[0], invocation, outcome);
  ::close(out[0]);
  ::close(err[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

ProgramTest::ProgramTest() {
  std::string name = (std::filesystem::temp_directory_path() / "penumbra-test-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": " + std::strerror(errno));
  folder_ = name;
}

ProgramTest::~ProgramTest() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::filesystem::path ProgramTest::write(const std::string& name, const std::string& text) const {
  std::filesystem::create_directories((folder_ / name).parent_path());
  std::ofstream(folder_ / name, std::ios::binary) << text;
  return folder_ / name;
}

std::vector<std::string> ProgramTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
    if (entry.is_regular_file()) names.push_back(entry.path().lexically_relative(folder_).string());
  }
  std::ranges::sort(names);
  return names;
}

std::string ProgramTest::read(const std::string& name) const {
  std::ifstream file(folder_ / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string ProgramTest::tiny_scene() const {
  return write("scene.json", kTinyScene).string();
}

std::string ProgramTest::moving_scene() const {
  test::Gltf gltf;
  // A body over a floor that its lamp shines down on, seen by two cameras from above.
  gltf.at("/nodes/1")["rotation"] = {1, 0, 0, 0};
  gltf.at("/nodes/0")["translation"] = {0, 1, 0};
  gltf.at("/nodes/0")["scale"] = {1, 1, 1};
  gltf.at("/nodes/0")["rotation"] = {-0.70710678, 0, 0, 0.70710678};
  gltf.at("/meshes").push_back(
      {{"primitives", {{{"attributes", {{"POSITION", 2}}}, {"indices", 3}, {"material", 0}}}}});
  gltf.at("/nodes").push_back({{"name", "Floor"}, {"mesh", 2}, {"scale", {4, 1, 4}}});
  gltf.at("/nodes/2") = {
      {"name", "Camera"}, {"camera", 0}, {"translation", {0, 4, 0}}, {"rotation", {-0.70710678, 0, 0, 0.70710678}}};
  gltf.at("/nodes").push_back(
      {{"name", "B.2"}, {"camera", 0}, {"translation", {1, 3, 0}}, {"rotation", {-0.70710678, 0, 0, 0.70710678}}});
  gltf.at("/scenes/0/nodes") = {0, 1, 2, 3, 4};
  gltf.animate(0, "translation", {0, 1}, {0, 1, 0, 1, 1, 0});
  gltf.animate(2, "translation", {0, 1}, {0, 4, 0, 0, 3, 0});
  return write("scene.glb", gltf.glb()).string();
}

Outcome ProgramTest::run(std::vector<std::string> arguments, std::map<std::string, std::string> environment) const {
  return run_program({.arguments = std::move(arguments), .environment = std::move(environment), .interrupt_after = {}});
}

std::string scene_text_with(const std::string& pointer, const std::string& json) {
  // The JSON library would not keep a number that no double can hold, so the text is put in place of a mark.
  constexpr const char* kMark = "@@";
  nlohmann::ordered_json scene = nlohmann::ordered_json::parse(kTinyScene);
  scene[nlohmann::ordered_json::json_pointer(pointer)] = kMark;
  std::string text = scene.dump();
  const std::string quoted = '"' + std::string(kMark) + '"';
  return text.replace(text.find(quoted), quoted.size(), json);
}

}  // namespace penumbra::tests
