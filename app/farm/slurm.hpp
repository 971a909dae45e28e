// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::app {

/// Slurm's default limit of the tasks of one array (slurm.conf(5), MaxArraySize less one).
inline constexpr std::size_t kDefaultMostTasks = 1001;

/// Runs a command of Slurm and returns its output. Throws ResourceError with Slurm's message if it fails.
std::string run_slurm(const std::vector<std::string>& command);

/// Returns the largest number of tasks of an array from the output of `scontrol show config`: indices stay below
/// MaxArraySize. Throws ResourceError if arrays are disabled.
std::size_t most_tasks(std::string_view config);

/// Returns the job's number from the output of `sbatch --parsable` ("12", or "12;cluster"). Throws ResourceError for
/// any other text.
std::string job_number(std::string_view printed);

/// Returns whether any part of the job is still waiting or running.
bool is_queued(const std::string& job);
/// Returns whether any part of the job was cancelled. Jobs that ended long ago are unknown.
bool was_cancelled(const std::string& job);

}  // namespace penumbra::app
