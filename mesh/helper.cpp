// SPDX-License-Identifier: Apache-2.0
// Starts helper programs and supervises them: pipes, deadlines, limits on output.

#include "mesh/helper.hpp"

#include "base/child.hpp"
#include "base/descriptor.hpp"
#include "base/error.hpp"
#include "mesh/import_wire.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
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
    // dladdr gives a program's name as its caller typed it; a library's name is its path.
    if (std::filesystem::path file = std::filesystem::canonical(info.dli_fname, error);
        !error && file.extension() != "" && file.filename().string().find(".so") != std::string::npos)
      return file.parent_path();
  }
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw ResourceError("cannot find the running program's folder: {}", error.message());
  return self.parent_path();
}

std::filesystem::path find_helper(const HelperProgram& program) {
  if (const char* named = std::getenv(program.variable); named != nullptr && *named != '\0') return named;
  // Looks next to the file that holds this code, the program or the library, and where `cmake --install` puts helpers.
  const std::filesystem::path folder = folder_of_this_code();
  for (const char* const place : {".", "../bin", "../../bin"}) {
    std::error_code ignored;
    if (auto helper = (folder / place / program.file).lexically_normal(); std::filesystem::exists(helper, ignored))
      return helper;
  }
  return folder / program.file;  // if it does not exist, starting it reports that
}

ResourceError missing(const HelperProgram& program, const std::string& file, int error) {
  return ResourceError(
      "cannot start {} {}: {}; it is built beside the program and the library{}, or is named by the "
      "environment variable {}",
      program.words, file, reason(error), program.built_with, program.variable);
}

/// Capacity of the output pipe, if the system allows it: the child continues writing while this process reads.
constexpr std::size_t kPipeBytes = std::size_t{1} << 20;

/// Standard streams of the child.
struct Streams {
  Pipe life;  ///< the child's input: nothing is written, and the end of file means that this process or the job has
              ///< ended
  Pipe output, errors;
};

pid_t start(const HelperProgram& program, const std::vector<std::string>& arguments, const Streams& streams,
            const std::vector<int>& files) {
  ChildCommand command{{find_helper(program).string()},
                       {streams.life.read.get(), streams.output.write.get(), streams.errors.write.get()}};
  command.words.insert(command.words.end(), arguments.begin(), arguments.end());
  command.files.insert(command.files.end(), files.begin(), files.end());
  const ChildStart started = start_child(command);
  if (started.error == EAGAIN || started.error == ENOMEM) {
    throw ResourceError(
        "cannot start {}: {}; raise the limit on processes (ulimit -u, the control group's pids.max), or that on "
        "memory",
        program.words, reason(started.error));
  }
  if (started.error != 0) throw missing(program, command.words.front(), started.error);
  return started.pid;
}

/// Reads once from a pipe that poll reported as ready, and closes the pipe at its end. Calls `take(bytes)` with the
/// bytes read.
template <typename Take>
void drain(Descriptor& from, std::span<std::byte> buffer, Take take) {
  const ssize_t count = ::read(from.get(), buffer.data(), buffer.size());
  if (count > 0) {
    take(buffer.first(static_cast<std::size_t>(count)));
  } else if (count == 0 || (errno != EINTR && errno != EAGAIN)) {
    from.close();
  }
}

/// Collects the child's output until the child ends, or until it exceeds a limit and is killed.
HelperEnding supervise(Child& child, Streams streams, const HelperRun& run) {
  constexpr std::size_t kKeptErrors = 4096;
  const Clock::time_point deadline = run.time ? Clock::now() + *run.time : Clock::time_point::max();
  Pipe &output = streams.output, &errors = streams.errors;
  output.write.close();  // needed for the pipes to reach their end
  errors.write.close();
  HelperEnding outcome;
  std::array<std::byte, 4096> buffer;
  const auto remaining = [&] { return std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count(); };
  constexpr std::chrono::milliseconds kStep{100};
  Clock::time_point next_step = Clock::now();
  const auto step = [&] {
    if (run.step == nullptr || Clock::now() < next_step) return;
    (*run.step)();
    next_step = Clock::now() + kStep;
  };

  while (outcome.how == HelperEnding::How::by_itself && (output.read.is_open() || errors.read.is_open())) {
    step();
    if (remaining() <= 0) {
      outcome.how = HelperEnding::How::out_of_time;
      break;
    }
    std::array<pollfd, 2> waiting{{{output.read.get(), POLLIN, 0}, {errors.read.get(), POLLIN, 0}}};  // -1 is skipped
    const int timeout =
        static_cast<int>(std::min<std::int64_t>(remaining(), run.step != nullptr ? kStep.count() : 1000));
    if (::poll(waiting.data(), waiting.size(), timeout) <= 0) continue;  // timeout, or a signal
    if (waiting[0].revents != 0) {
      drain(output.read, outcome.output.room(kPipeBytes), [&](std::span<const std::byte> bytes) {
        if (bytes.size() > run.output_bytes - outcome.output.size())
          outcome.how = HelperEnding::How::too_much_output;
        else
          outcome.output.add(bytes.size());
      });
    }
    if (waiting[1].revents != 0) {
      drain(errors.read, buffer, [&](std::span<const std::byte> bytes) {  // excess bytes are read and dropped
        const auto kept = bytes.first(std::min(bytes.size(), kKeptErrors - outcome.errors.size()));
        outcome.errors.append(reinterpret_cast<const char*>(kept.data()), kept.size());
      });
    }
  }
  // A child that closed its streams may still run: the deadline applies to its end as well.
  while (outcome.how == HelperEnding::How::by_itself && !child.has_ended()) {
    step();
    if (remaining() <= 0)
      outcome.how = HelperEnding::How::out_of_time;
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  child.kill();
  outcome.status = child.wait();
  return outcome;
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

void require_helper(const HelperProgram& program) {
  const std::filesystem::path file = find_helper(program);
  if (::access(file.c_str(), X_OK) != 0) throw missing(program, file.string(), errno);
}

HelperEnding run_helper(const HelperProgram& program, const HelperRun& run) {
  Streams streams{make_pipe(), make_pipe(), make_pipe()};
  // optional: without it the pipe is only slower
  ::fcntl(streams.output.write.get(), F_SETPIPE_SZ, static_cast<int>(kPipeBytes));
  Child child(start(program, run.arguments, streams, run.files));
  streams.life.read.close();
  return supervise(child, std::move(streams), run);
}

std::string HelperEnding::first_line() const {
  const std::string said = printable(std::string_view(errors).substr(0, errors.find('\n')));
  return said.empty() ? said : "; it said: " + said;
}

HelperStatus get_status(WireReader& from) {
  for (const char expected : kHelperMagic) {
    if (from.get<char>() != expected) throw WireError("it does not begin like an answer");
  }
  const auto status = static_cast<HelperStatus>(from.get<std::uint8_t>());
  if (status > HelperStatus::out_of_memory) throw WireError("its status is unknown");
  return status;
}

}  // namespace penumbra::mesh
