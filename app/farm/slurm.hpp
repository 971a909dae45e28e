#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::app {

/// Tasks that one array may have where nobody has said otherwise (slurm.conf(5), MaxArraySize less one).
inline constexpr std::size_t kDefaultMostTasks = 1001;

/// Runs a command of Slurm and returns what it printed. Throws ResourceError if it cannot, in its own words.
std::string run_slurm(const std::vector<std::string>& command);

/// How many tasks an array may have, of `scontrol show config`: their numbers stay below MaxArraySize. Throws
/// ResourceError where there can be no arrays.
std::size_t most_tasks(std::string_view config);

/// The job's number, of what `sbatch --parsable` printed ("12", or "12;cluster"). Throws ResourceError for anything
/// else.
std::string job_number(std::string_view printed);

/// Is any of the job still waiting or running?
bool is_queued(const std::string& job);
/// Did somebody cancel any of it? Nothing is known of jobs that ended long ago.
bool was_cancelled(const std::string& job);

}  // namespace penumbra::app
