#include "mesh/import_helper.hpp"

#include "base/child.hpp"
#include "base/descriptor.hpp"
#include "base/error.hpp"
#include "base/memory.hpp"
#include "mesh/import_wire.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <new>
#include <span>
#include <system_error>
#include <thread>
#include <utility>

namespace penumbra::mesh {
namespace {

using Clock = std::chrono::steady_clock;

std::string reason(int error) {
  return std::generic_category().message(error);
}

std::filesystem::path folder_of_this_code() {
  Dl_info info{};
  std::error_code error;
  if (::dladdr(reinterpret_cast<void*>(&reason), &info) != 0 && info.dli_fname != nullptr) {
    // The name of a program is what its caller called it by; that of a library is its path.
    if (std::filesystem::path file = std::filesystem::canonical(info.dli_fname, error);
        !error && file.extension() != "" && file.filename().string().find(".so") != std::string::npos)
      return file.parent_path();
  }
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw ResourceError("cannot find the running program's folder: {}", error.message());
  return self.parent_path();
}

std::filesystem::path find_helper() {
  if (const char* named = std::getenv("PENUMBRA_IMPORT_HELPER"); named != nullptr && *named != '\0') return named;
  // Beside the file that holds this code, the program or the library, or where `cmake --install` puts it.
  const std::filesystem::path folder = folder_of_this_code();
  for (const char* const place : {".", "../bin", "../../bin"}) {
    std::error_code ignored;
    if (auto helper = (folder / place / "penumbra-import").lexically_normal(); std::filesystem::exists(helper, ignored))
      return helper;
  }
  return folder / "penumbra-import";  // whose absence is said when it is started
}

/// What the output's pipe holds where the system allows that: the child goes on writing while this process reads.
constexpr std::size_t kPipeBytes = std::size_t{1} << 20;

/// What the child gets as its standard streams.
struct Streams {
  Pipe life;  ///< its input: nothing comes, and its end is that of this process or of the job
  Pipe output, errors;
};

/// A copy of `fd` above all numbers that the child's own files will have.
Descriptor moved_up(const Descriptor& fd) {
  Descriptor copy(::fcntl(fd.get(), F_DUPFD_CLOEXEC, kFolderDescriptor + 1));
  if (!copy.is_open()) throw ResourceError("cannot duplicate a file descriptor: {}", reason(errno));
  return copy;
}

/// posix_spawn's two argument objects, set so that the child sees the given streams, the file that it is to read, that
/// file's folder, and nothing else of ours.
class SpawnSettings {
 public:
  SpawnSettings(const Streams& streams, const InputFile& input)
      : content_(moved_up(input.content)), folder_(moved_up(input.folder)) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawnattr_init(&attributes_);
    ::posix_spawn_file_actions_adddup2(&actions_, streams.life.read.get(), STDIN_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, streams.output.write.get(), STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, streams.errors.write.get(), STDERR_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, content_.get(), kInputDescriptor);
    ::posix_spawn_file_actions_adddup2(&actions_, folder_.get(), kFolderDescriptor);
    // Libraries of this program may have opened files without O_CLOEXEC (GPU drivers do).
    ::posix_spawn_file_actions_addclosefrom_np(&actions_, kFolderDescriptor + 1);
    // The child starts with default signal handling whatever this program blocks or ignores.
    sigset_t none, all;
    ::sigemptyset(&none);
    ::sigfillset(&all);
    ::posix_spawnattr_setsigmask(&attributes_, &none);
    ::posix_spawnattr_setsigdefault(&attributes_, &all);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;
  ~SpawnSettings() {
    ::posix_spawn_file_actions_destroy(&actions_);
    ::posix_spawnattr_destroy(&attributes_);
  }
  [[nodiscard]] const posix_spawn_file_actions_t* actions() const { return &actions_; }
  [[nodiscard]] const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  Descriptor content_, folder_;
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

pid_t spawn(std::vector<std::string> arguments, const Streams& streams, const InputFile& input) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const SpawnSettings settings(streams, input);
  pid_t pid = -1;
  const int error = ::posix_spawn(&pid, argv[0], settings.actions(), settings.attributes(), argv.data(), ::environ);
  if (error == EAGAIN || error == ENOMEM) {
    throw ResourceError(
        "cannot start the import helper: {}; raise the limit on processes (ulimit -u, the control group's pids.max), "
        "or that on memory",
        reason(error));
  }
  if (error != 0) {
    throw ResourceError(
        "cannot start the import helper {}: {}; it is built beside the program and the library, or is named by the "
        "environment variable PENUMBRA_IMPORT_HELPER",
        arguments[0], reason(error));
  }
  return pid;
}

enum class Ending { by_itself, out_of_time, too_much_output };

struct Outcome {
  Ending ending = Ending::by_itself;
  int status = 0;  ///< as waitpid gives it
  GrowingBytes output;
  std::string errors;  ///< the first few KiB of what it wrote to stderr
};

/// Reads once from a pipe that poll called ready; closes it at its end. `take(bytes)` gets what was read.
template <typename Take>
void drain(Descriptor& from, std::span<std::byte> buffer, Take take) {
  const ssize_t count = ::read(from.get(), buffer.data(), buffer.size());
  if (count > 0) {
    take(buffer.first(static_cast<std::size_t>(count)));
  } else if (count == 0 || (errno != EINTR && errno != EAGAIN)) {
    from.close();
  }
}

/// Collects the child's output until it ends, or until it has cost too much, and then ends it.
Outcome supervise(Child& child, Streams streams, const ImportLimits& limits) {
  constexpr std::size_t kKeptErrors = 4096;
  const Clock::time_point deadline = Clock::now() + limits.time;
  Pipe &output = streams.output, &errors = streams.errors;
  output.write.close();  // or the pipes would never end
  errors.write.close();
  Outcome outcome;
  std::array<std::byte, 4096> buffer;
  const auto remaining = [&] { return std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count(); };

  while (outcome.ending == Ending::by_itself && (output.read.is_open() || errors.read.is_open())) {
    if (remaining() <= 0) {
      outcome.ending = Ending::out_of_time;
      break;
    }
    std::array<pollfd, 2> waiting{{{output.read.get(), POLLIN, 0}, {errors.read.get(), POLLIN, 0}}};  // -1 is skipped
    const int timeout = static_cast<int>(std::min<std::int64_t>(remaining(), 1000));
    if (::poll(waiting.data(), waiting.size(), timeout) <= 0) continue;  // time passed, or a signal came
    if (waiting[0].revents != 0) {
      drain(output.read, outcome.output.room(kPipeBytes), [&](std::span<const std::byte> bytes) {
        if (bytes.size() > limits.output_bytes - outcome.output.size())
          outcome.ending = Ending::too_much_output;
        else
          outcome.output.add(bytes.size());
      });
    }
    if (waiting[1].revents != 0) {
      drain(errors.read, buffer, [&](std::span<const std::byte> bytes) {  // what is too much is read and forgotten
        const auto kept = bytes.first(std::min(bytes.size(), kKeptErrors - outcome.errors.size()));
        outcome.errors.append(reinterpret_cast<const char*>(kept.data()), kept.size());
      });
    }
  }
  // Closing its streams is not ending: it has until the deadline for that as well.
  while (outcome.ending == Ending::by_itself && !child.has_ended()) {
    if (remaining() <= 0)
      outcome.ending = Ending::out_of_time;
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  child.kill();
  outcome.status = child.wait();
  return outcome;
}

std::string in_seconds(std::chrono::milliseconds time) {
  return fmt::format("{:g} s", static_cast<double>(time.count()) / 1000.0);
}

/// Throws what the outcome means for the user, unless the child ended as it should.
void require_good_ending(const Outcome& outcome, const std::string& file, const ImportLimits& limits) {
  const bool cpu_limit = WIFSIGNALED(outcome.status) && WTERMSIG(outcome.status) == SIGXCPU;
  if (outcome.ending == Ending::out_of_time || cpu_limit) {
    throw InputError("{}: reading it took longer than {} and was stopped; the file is damaged or too large", file,
                     in_seconds(limits.time));
  }
  if (outcome.ending == Ending::too_much_output) {
    throw InputError("{}: it holds more than {} of triangles; make it smaller", file, in_bytes(limits.output_bytes));
  }
  // Only the first line: what follows is a library's stack trace at best.
  std::string said = printable(std::string_view(outcome.errors).substr(0, outcome.errors.find('\n')));
  if (!said.empty()) said = fmt::format("; it said: {}", said);
  if (WIFSIGNALED(outcome.status)) {
    throw InputError(
        "{}: the importer crashed on it (signal {}), which is the importer's fault, whether or not the file is "
        "damaged; "
        "save it in another format{}",
        file, WTERMSIG(outcome.status), said);
  }
  if (WEXITSTATUS(outcome.status) != 0) {
    throw InputError("{}: the importer gave up (exit code {}); the file is probably damaged{}", file,
                     WEXITSTATUS(outcome.status), said);
  }
}

struct FittedLimits {
  ImportLimits limits;
  MemoryRoom room;
};

/// What the file may cost on this machine now: the helper's own memory; and its answer, which this process holds up to
/// three times (as it grows, and as what is made of it).
FittedLimits fit_to_machine(ImportLimits limits) {
  give_back_memory();  // what this process only keeps is the helper's, too
  const MemoryRoom room = memory_room();
  limits.memory_bytes = std::min(limits.memory_bytes, room.bytes);
  limits.output_bytes = std::min(limits.output_bytes, room.bytes / 4);
  return {limits, room};
}

ResourceError out_of_room(const std::string& file, std::uint64_t bytes, const MemoryRoom& room) {
  return ResourceError("{}: reading it needs more than {} of memory, and {} is all that {}", file, in_bytes(bytes),
                       in_bytes(room.bytes), room.limit);
}

}  // namespace

std::span<std::byte> GrowingBytes::room(std::size_t least) {
  if (capacity_ - size_ < least) {
    const std::size_t wanted = std::max(2 * capacity_, size_ + least);
    void* moved = std::realloc(memory_.get(), wanted);
    if (moved == nullptr) throw std::bad_alloc();
    static_cast<void>(memory_.release());  // realloc has freed it
    memory_.reset(static_cast<std::byte*>(moved));
    capacity_ = wanted;
  }
  return {memory_.get() + size_, capacity_ - size_};
}

HelperAnswer run_import_helper(const HelperJob& job, const ImportLimits& wanted) {
  const std::string file = job.input.name.string();
  const auto [limits, room] = fit_to_machine(wanted);
  std::vector<std::string> arguments{
      find_helper().string(),     job.kind, std::to_string(limits.time.count()), std::to_string(limits.memory_bytes),
      std::to_string(::getpid()), file};
  arguments.insert(arguments.end(), job.flags.begin(), job.flags.end());
  Streams streams{make_pipe(), make_pipe(), make_pipe()};
  ::fcntl(streams.output.write.get(), F_SETPIPE_SZ, static_cast<int>(kPipeBytes));  // where not, it is only slower
  Child child(spawn(std::move(arguments), streams, job.input));
  streams.life.read.close();
  Outcome outcome = supervise(child, std::move(streams), limits);
  if (outcome.ending == Ending::too_much_output && limits.output_bytes < wanted.output_bytes) {
    throw out_of_room(file, limits.output_bytes, room);
  }
  require_good_ending(outcome, file, limits);

  HelperAnswer answer;
  answer.bytes = std::move(outcome.output);
  try {
    WireReader from(answer.bytes.all());
    for (const char expected : kHelperMagic) {
      if (from.get<char>() != expected) throw WireError("it does not start as an answer does");
    }
    const auto status = static_cast<HelperStatus>(from.get<std::uint8_t>());
    if (status == HelperStatus::out_of_memory) {
      if (limits.memory_bytes < wanted.memory_bytes) throw out_of_room(file, limits.memory_bytes, room);
      struct stat info {};
      const bool known = ::fstat(job.input.content.get(), &info) == 0;
      throw InputError(
          "{}: reading it needs more than {} of memory, though the file has {} only: it is damaged, or repeats what "
          "it holds too often, or is too large",
          file, in_bytes(limits.memory_bytes), known ? in_bytes(static_cast<std::uint64_t>(info.st_size)) : "little");
    }
    if (status == HelperStatus::bad_input) throw InputError("{}", from.get_string());
    if (status != HelperStatus::done) throw WireError("its status is unknown");
    for (std::string& name : from.get_raw_strings()) answer.sources.emplace_back(std::move(name));
    answer.payload_at = answer.bytes.size() - from.remaining();
  } catch (const WireError& error) {
    throw InputError("{}: the importer's answer is damaged ({}); the file is probably damaged", file, error.what());
  }
  return answer;
}

}  // namespace penumbra::mesh
