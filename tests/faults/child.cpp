// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/child.hpp"

#include "tests/child_arguments.hpp"
#include "tests/child_pipes.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
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

using Clock = std::chrono::steady_clock;

constexpr const char* kScene = R"({
  "format": "penumbra-scene/1", "size": [48, 32],
  "camera": {"eye": [2, 3, 6], "target": [0, 0.5, 0]},
  "meshes": [
    {"name": "floor", "quad": {"center": [0, 0, 0], "halfU": [4, 0, 0], "halfV": [0, 0, -4]}},
    MESH
  ],
  "lights": [{"name": "key", "rectangle": {"center": [0, 4, 0], "halfU": [0.5, 0, 0], "halfV": [0, 0, 0.5]}}]
})";

std::string scene_with(const std::string& mesh) {
  std::string text = kScene;
  return text.replace(text.find("MESH"), 4, mesh);
}

/// Returns a user number that probably nobody has, another one for each run.
uid_t stranger() {
  static uid_t serial = 0;
  return 1'000'000'000 + static_cast<uid_t>(::getpid()) * 100 + serial++ % 100;
}

/// Returns the variables that are added to the environment. A sanitizer is told to accept a library that is loaded
/// before it, and not to look for leaks at the end if it could not start the process for that.
std::map<std::string, std::string> additions(const Conditions& conditions) {
  std::map<std::string, std::string> added = conditions.environment;
  if (!kSanitized) return added;
  const char* own = std::getenv("ASAN_OPTIONS");
  std::string options = own == nullptr ? "" : own;
  if (added.contains("LD_PRELOAD")) options += ":verify_asan_link_order=0";
  if (std::ranges::any_of(conditions.limits, [](const Limit& limit) { return limit.resource == RLIMIT_NPROC; }))
    options += ":detect_leaks=0";
  added["ASAN_OPTIONS"] = options;
  return added;
}

/// Returns whether other users may enter all folders above the file.
bool is_reachable(const std::filesystem::path& file) {
  for (std::filesystem::path folder = file.parent_path();; folder = folder.parent_path()) {
    const auto allowed = std::filesystem::status(folder).permissions();
    if ((allowed & std::filesystem::perms::others_exec) == std::filesystem::perms::none) return false;
    if (folder == folder.parent_path()) return true;
  }
}

/// The program and its helper where other users can start them: in the build folder or, if that is below a folder that
/// only its owner may enter, such as root's home, as copies that are removed with this process.
class StrangersProgram {
 public:
  StrangersProgram() {
    if (is_reachable(path_)) return;
    folder_ = std::filesystem::temp_directory_path() / ("penumbra-strangers-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    std::filesystem::permissions(folder_, std::filesystem::perms(0755));
    for (const auto& file : {path_, path_.parent_path() / "penumbra-import"})
      std::filesystem::copy_file(file, folder_ / file.filename(), std::filesystem::copy_options::overwrite_existing);
    path_ = folder_ / path_.filename();
  }
  StrangersProgram(const StrangersProgram&) = delete;
  StrangersProgram& operator=(const StrangersProgram&) = delete;
  ~StrangersProgram() {
    std::error_code error;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, error);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_ = PENUMBRA_PROGRAM, folder_;
};

std::string program_of(const Conditions& conditions) {
  if (!conditions.as_stranger) return PENUMBRA_PROGRAM;
  static const StrangersProgram program;
  return program.path().string();
}

/// Prepares a stream of the child after fork, with calls that are safe there.
void set_stream(Stream stream, int number, int captured) {
  switch (stream) {
    case Stream::captured:
      ::dup2(captured, number);
      break;
    case Stream::closed:
      ::close(number);
      break;
    case Stream::full:
      ::dup2(::open("/dev/full", O_RDWR | O_CLOEXEC), number);
      break;
    case Stream::broken_pipe: {
      int ends[2];
      if (::pipe(ends) != 0) ::_exit(125);
      ::dup2(ends[1], number);
      ::close(ends[0]);
      ::close(ends[1]);
      break;
    }
  }
}

}  // namespace

bool is_documented(int code) {
  constexpr std::array kCodes = {0, 1, 2, 3, 4, 130};
  return std::ranges::find(kCodes, code) != kCodes.end();
}

Running::Running(const Conditions& conditions) : timeout_(conditions.timeout) {
  std::vector<std::string> arguments = conditions.arguments;
  const std::string program = program_of(conditions);
  arguments.insert(arguments.begin(), program);
  std::vector<std::string> environment = environment_with(additions(conditions));
  const std::vector<char*> argv = pointers(arguments), envp = pointers(environment);
  std::array<int, 2> out{}, err{};
  if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(err.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe");
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const uid_t user = stranger();
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("fork");
  if (pid_ == 0) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) ::signal(signal, SIG_DFL);
    set_stream(conditions.in, STDIN_FILENO, nothing);
    set_stream(conditions.out, STDOUT_FILENO, out[1]);
    set_stream(conditions.err, STDERR_FILENO, err[1]);
    for (const Limit& limit : conditions.limits) {
      const rlimit both{limit.value, limit.value};
      ::setrlimit(limit.resource, &both);
    }
    if (conditions.as_stranger && ::geteuid() == 0 && ::setresuid(user, user, user) != 0) ::_exit(125);
    ::execve(program.c_str(), argv.data(), envp.data());
    ::_exit(126);
  }
  for (const int end : {out[1], err[1], nothing}) ::close(end);
  out_ = out[0];
  err_ = err[0];
}

Running::~Running() {
  if (!status_) send(SIGKILL);
  reap(0);
  ::close(out_);
  ::close(err_);
}

void Running::reap(int options) {
  int status = 0;
  while (!status_) {
    const pid_t result = ::wait4(pid_, &status, options, &usage_);
    if (result == 0) return;
    if (result == pid_ || errno != EINTR) status_ = status;
  }
}

bool Running::has_ended() {
  reap(WNOHANG);
  return status_.has_value();
}

Ending Running::wait() {
  Ending ending;
  const auto start = Clock::now();
  ChildPipes pipes(out_, err_, ending.out, ending.err);
  while (pipes.open()) {
    pipes.read_within(100);
    if (std::chrono::duration<double>(Clock::now() - start).count() > timeout_) send(SIGKILL);
  }
  while (!has_ended()) {  // it may close its streams before it ends
    if (std::chrono::duration<double>(Clock::now() - start).count() > timeout_) send(SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ending.code = WIFEXITED(*status_) ? WEXITSTATUS(*status_) : 128 + WTERMSIG(*status_);
  ending.peak_bytes = static_cast<std::uint64_t>(usage_.ru_maxrss) * 1024;
  return ending;
}

std::optional<pid_t> Running::first_child() {
  const std::string tasks = "/proc/" + std::to_string(pid_) + "/task";
  while (!has_ended()) {
    std::error_code error;
    for (const auto& task : std::filesystem::directory_iterator(tasks, error)) {
      pid_t child = 0;
      if (std::ifstream(task.path() / "children") >> child) return child;
    }
  }
  return std::nullopt;
}

Ending run_under(const Conditions& conditions) {
  return Running(conditions).wait();
}

FaultTest::FaultTest() {
  std::string name = (std::filesystem::temp_directory_path() / "penumbra-faults-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": " + std::strerror(errno));
  folder_ = name;
  std::filesystem::permissions(folder_, std::filesystem::perms::all);
}

FaultTest::~FaultTest() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::string FaultTest::write(const std::string& name, const std::string& text) const {
  std::filesystem::create_directories((folder_ / name).parent_path());
  std::ofstream(folder_ / name, std::ios::binary) << text;
  return path(name);
}

std::string FaultTest::read(const std::string& name) const {
  std::ifstream file(folder_ / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> FaultTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
    if (!entry.is_directory()) names.push_back(entry.path().lexically_relative(folder_).string());
  }
  std::ranges::sort(names);
  return names;
}

std::string FaultTest::small_scene(const std::string& name) const {
  return write(name, scene_with(R"({"name": "wedge", "triangles": [[-1,1,-1, 1,1,-1, 0,1.5,1]]})"));
}

std::string FaultTest::slow_scene(int faces) const {
  std::string obj = "v 0 1 0\nv 1 1 0\nv 0 1 1\n";
  for (int i = 0; i < faces; ++i) obj += "f 1 2 3\n";
  write("slow.obj", obj);
  return write("slow.json", scene_with(R"({"name": "slow", "file": "slow.obj"})"));
}

}  // namespace penumbra::tests
