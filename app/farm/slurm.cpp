// SPDX-License-Identifier: Apache-2.0
// Runs Slurm's commands and parses their output.

#include "app/farm/slurm.hpp"

#include "app/process/child_program.hpp"
#include "base/error.hpp"
#include "session/parse.hpp"

#include <algorithm>
#include <cctype>

namespace penumbra::app {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const auto first = text.find_first_not_of(kSpace);
  return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

}  // namespace

std::string run_slurm(const std::vector<std::string>& command) {
  ProgramEnding ending = run_program(command);
  if (ending.code == 127 && ending.errors.empty()) {
    throw ResourceError(
        "cannot run {}: it is not installed here, or not on PATH; submit from a machine of the farm, or render here "
        "with "
        "--jobs N (--dry-run shows the batch script)",
        command.front());
  }
  if (ending.code != 0)
    throw ResourceError("{} failed (exit code {}): {}", command.front(), ending.code, trimmed(ending.errors));
  return std::move(ending.output);
}

std::size_t most_tasks(std::string_view config) {
  for (const std::string_view line : session::split(config, '\n')) {
    const auto equals = line.find('=');
    if (equals == std::string_view::npos || trimmed(line.substr(0, equals)) != "MaxArraySize") continue;
    const auto most = session::parse_integer<std::size_t>(trimmed(line.substr(equals + 1)));
    if (!most) break;
    if (*most < 1) throw ResourceError("this farm has no job arrays (MaxArraySize is 0); ask its administrator");
    return *most;
  }
  return kDefaultMostTasks;
}

std::string job_number(std::string_view printed) {
  // sbatch may print messages of the site first.
  const std::string_view last = session::split(trimmed(printed), '\n').back();
  const std::string_view number = last.substr(0, last.find(';'));
  if (!session::parse_integer<std::uint64_t>(number))
    throw ResourceError("sbatch printed \"{}\"; expected a job number", trimmed(printed));
  return std::string(number);
}

bool is_queued(const std::string& job) {
  const ProgramEnding ending = run_program({"squeue", "--noheader", "--jobs=" + job});
  return ending.code == 0 && !trimmed(ending.output).empty();  // a job that ended long ago is unknown, and an error
}

bool was_cancelled(const std::string& job) {
  return run_program({"scontrol", "show", "job", job}).output.find("JobState=CANCELLED") != std::string::npos;
}

}  // namespace penumbra::app
