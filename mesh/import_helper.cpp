// SPDX-License-Identifier: Apache-2.0
// Runs `penumbra-import` on a foreign mesh file in a process with limits on time, memory and answer, and turns every
// ending of that process into an error that says what the user can do.

#include "mesh/import_helper.hpp"

#include "base/error.hpp"
#include "base/memory.hpp"
#include "mesh/import_wire.hpp"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <utility>

namespace penumbra::mesh {
namespace {

constexpr HelperProgram kImport{"penumbra-import", "PENUMBRA_IMPORT_HELPER", "the import helper", ""};

std::string in_seconds(std::chrono::milliseconds time) {
  return fmt::format("{:g} s", static_cast<double>(time.count()) / 1000.0);
}

/// Throws the error that corresponds to the helper's ending, unless the helper ended normally.
void require_good_ending(const HelperEnding& outcome, const std::string& file, const ImportLimits& limits) {
  const bool cpu_limit = WIFSIGNALED(outcome.status) && WTERMSIG(outcome.status) == SIGXCPU;
  if (outcome.how == HelperEnding::How::out_of_time || cpu_limit) {
    throw InputError("{}: reading it took longer than {} and was stopped; the file is damaged or too large", file,
                     in_seconds(limits.time));
  }
  if (outcome.how == HelperEnding::How::too_much_output) {
    throw InputError("{}: it holds more than {} of triangles; make it smaller", file, in_bytes(limits.output_bytes));
  }
  const std::string said = outcome.first_line();
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

/// Reduces limits to this machine's free memory: the helper's own memory, and its answer, which this process holds up
/// to three times (while it grows, and in converted form).
FittedLimits fit_to_machine(ImportLimits limits) {
  give_back_memory();  // kept free memory of this process becomes available to the helper
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

HelperAnswer run_import_helper(const HelperJob& job, const ImportLimits& wanted) {
  const std::string file = job.input.name.string();
  const auto [limits, room] = fit_to_machine(wanted);
  HelperRun run{{job.kind, std::to_string(limits.time.count()), std::to_string(limits.memory_bytes),
                 std::to_string(::getpid()), file},
                {job.input.content.get(), job.input.folder.get()},
                limits.time,
                limits.output_bytes,
                limits.step};
  run.arguments.insert(run.arguments.end(), job.flags.begin(), job.flags.end());
  HelperEnding outcome = run_helper(kImport, run);
  if (outcome.how == HelperEnding::How::too_much_output && limits.output_bytes < wanted.output_bytes) {
    throw out_of_room(file, limits.output_bytes, room);
  }
  require_good_ending(outcome, file, limits);

  HelperAnswer answer;
  answer.bytes = std::move(outcome.output);
  try {
    WireReader from(answer.bytes.all());
    const HelperStatus status = get_status(from);
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
    for (std::string& name : from.get_raw_strings()) answer.sources.emplace_back(std::move(name));
    answer.payload_at = answer.bytes.size() - from.remaining();
  } catch (const WireError& error) {
    throw InputError("{}: the importer's answer is damaged ({}); the file is probably damaged", file, error.what());
  }
  return answer;
}

}  // namespace penumbra::mesh
