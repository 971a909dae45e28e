// penumbra-import: reads one foreign file in a process of its own. Not for users: penumbra starts it, tells it what to
// read and at what cost, and takes its answer from its standard output (mesh/import_helper.hpp says how).

#include "base/error.hpp"
#include "base/memory.hpp"
#include "mesh/import_helper.hpp"
#include "import/read.hpp"
#include "mesh/import_wire.hpp"
#include "mesh/opened_files.hpp"
#include "import/gltf/gltf_import.hpp"
#include "scenes/scene_wire.hpp"
#include "import/texture_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>

#if defined(PENUMBRA_SHADOW_MEMORY)
// Sanitizers reserve terabytes of addresses, so that the limit must be on resident memory instead. Leaks are Assimp's
// (on eleven of its own test files), and end with this process.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "detect_leaks=0:hard_rss_limit_mb=4096";
}
#endif

namespace {

using namespace penumbra;

struct Arguments {
  std::string_view kind;
  std::uint64_t milliseconds = 0, bytes = 0, asker = 0;
  const char* file = nullptr;
  scenes::ReadOptions options;
};

bool parse(std::string_view text, std::uint64_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// `flag` is --name=NUMBER.
bool parse_number(std::string_view flag, std::string_view name, std::optional<double>& value) {
  if (!flag.starts_with(name)) return false;
  flag.remove_prefix(name.size());
  double number = 0;
  const auto [end, error] = std::from_chars(flag.data(), flag.data() + flag.size(), number);
  value = number;
  return error == std::errc() && end == flag.data() + flag.size();
}

bool parse(int argc, char** argv, Arguments& arguments) {
  if (argc < 6) return false;
  arguments.kind = argv[1];
  arguments.file = argv[5];
  for (int i = 6; i < argc; ++i) {
    const std::string_view flag = argv[i];
    if (parse_number(flag, "--lamp-radius=", arguments.options.lamp_radius) ||
        parse_number(flag, "--sun-angle=", arguments.options.sun_angle) ||
        parse_number(flag, "--lumens-per-watt=", arguments.options.lumens_per_watt) ||
        parse_number(flag, "--time=", arguments.options.time)) {
      continue;
    }
    if (constexpr std::string_view kClip = "--clip="; flag.starts_with(kClip)) {
      arguments.options.clips.emplace_back(flag.substr(kClip.size()));
      continue;
    }
    if (flag != "--allow-outside" && flag != "--without-light" && flag != "--lenient") return false;
    arguments.options.allow_outside |= flag == "--allow-outside";
    arguments.options.lenient |= flag == "--lenient";
    arguments.options.needs_light &= flag != "--without-light";
  }
  constexpr std::array<std::string_view, 3> kKinds = {"mesh", "gltf", "texture"};
  return std::ranges::find(kKinds, arguments.kind) != kKinds.end() && parse(argv[2], arguments.milliseconds) &&
         parse(argv[3], arguments.bytes) && parse(argv[4], arguments.asker);
}

void limit(__rlimit_resource resource, rlim_t value) {
  const rlimit both{value, value};
  setrlimit(resource, &both);  // fails only where a lower limit is in force already
}

/// Sees to it that this process ends with the one that asked, at whatever moment that is killed; false: it is gone
/// already. Standard input is a pipe whose other end only the asker has.
bool end_with_asker(std::uint64_t asker) {
  // Two ways, since each has its hole: the first is bound to the thread that asked; for the second, another child of
  // the asker may for a moment hold the pipe's other end.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (static_cast<std::uint64_t>(getppid()) != asker) return false;  // it died before, so that no signal will come
  const int pipe = fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (pipe < 0 || nothing < 0 || dup2(nothing, STDIN_FILENO) < 0) return false;
  close(nothing);
  fcntl(pipe, F_SETOWN, getpid());
  fcntl(pipe, F_SETSIG, SIGKILL);
  fcntl(pipe, F_SETFL, O_ASYNC);  // SIGKILL when the other end closes …
  pollfd state{pipe, POLLIN, 0};
  return poll(&state, 1, 0) == 0;  // … unless it did so before
}

/// From here on this process can read files and answer, and not much more.
void confine(const Arguments& arguments) {
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  prctl(PR_SET_DUMPABLE, 0);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);  // it writes to a pipe only
  limit(RLIMIT_NOFILE, 64);
  limit(RLIMIT_CPU, arguments.milliseconds / 1000 + 2);  // the asker's clock comes first, unless it has died
#if !defined(PENUMBRA_SHADOW_MEMORY)
  limit(RLIMIT_AS, arguments.bytes);
  limit(RLIMIT_NPROC, 0);  // no threads, no children
#endif
}

struct Answer {
  mesh::WireWriter head, payload;
  // What the payload says without copying it.
  mesh::ImportedMesh mesh;
  scenes::Scene scene;
  scenes::Texture texture;
};

Answer message(mesh::HelperStatus status) {
  Answer answer;
  for (const char c : mesh::kHelperMagic) answer.head.put(c);
  answer.head.put(static_cast<std::uint8_t>(status));
  return answer;
}

mesh::ImportedMesh read_mesh(const mesh::InputFile& input, const Arguments& arguments) {
  if (scenes::is_gltf(input.name)) return scenes::import_gltf_mesh(input, arguments.options);
  return mesh::read_mesh(input);
}

Answer answer_for(const Arguments& arguments) {
  const mesh::InputFile input{arguments.file, Descriptor(mesh::kInputDescriptor), Descriptor(mesh::kFolderDescriptor)};
  mesh::note_opened_file(std::filesystem::absolute(input.name));
  try {
    Answer answer = message(mesh::HelperStatus::done);
    if (arguments.kind == "mesh") {
      answer.mesh = read_mesh(input, arguments);
      mesh::put_mesh(answer.payload, answer.mesh);
    } else if (arguments.kind == "gltf") {
      answer.scene = scenes::import_gltf(input, arguments.options);
      scenes::put_scene(answer.payload, answer.scene);
    } else {
      answer.texture = scenes::read_texture_file(input);
      scenes::put_texture(answer.payload, answer.texture);
    }
    answer.head.put_strings(mesh::opened_files());
    return answer;
  } catch (const std::bad_alloc&) {
    return message(mesh::HelperStatus::out_of_memory);
  } catch (const std::length_error&) {  // more than any memory could hold
    return message(mesh::HelperStatus::out_of_memory);
  } catch (const std::exception& error) {
    // What a library catches itself is told as text alone.
    if (std::string_view(error.what()).find("std::bad_alloc") != std::string_view::npos) {
      return message(mesh::HelperStatus::out_of_memory);
    }
    const bool ours = dynamic_cast<const Error*>(&error) != nullptr;
    Answer answer = message(mesh::HelperStatus::bad_input);
    answer.payload.put_string(ours ? error.what() : fmt::format("{}: {}", arguments.file, error.what()));
    return answer;
  }
}

bool write_all(int to, const mesh::WireWriter& from) {
  for (std::span<const std::byte> bytes : from.pieces()) {
    while (!bytes.empty()) {
      const ssize_t count = write(to, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  if (!parse(argc, argv, arguments)) {
    fmt::print(stderr, "penumbra-import reads meshes and scenes for penumbra; it is not meant to be called by hand.\n");
    return static_cast<int>(ExitCode::usage);
  }
  // First of all, while nothing is to be lost.
  if (!end_with_asker(arguments.asker)) return static_cast<int>(ExitCode::interrupted);
  // The answer goes where standard output went; what libraries print must not get into it.
  const int output = dup(STDOUT_FILENO);
  if (output < 0 || dup2(STDERR_FILENO, STDOUT_FILENO) < 0) return static_cast<int>(ExitCode::resource);
  confine(arguments);
  keep_freed_memory();
  const Answer answer = answer_for(arguments);
  // _exit: the libraries' own cleaning up after a hostile file is one more chance to crash.
  const bool told = write_all(output, answer.head) && write_all(output, answer.payload);
  _exit(told ? 0 : static_cast<int>(ExitCode::resource));
}
