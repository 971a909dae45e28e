// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::app {

/// Returns one word of a shell, for any text without a newline.
std::string shell_word(std::string_view text);
/// Returns one value of an #SBATCH line, for any text without a newline.
std::string sbatch_word(std::string_view text);
/// Returns a name in which Slurm replaces no %A and %a.
std::string sbatch_name(std::string_view name);

/// Job of a Slurm array.
struct BatchJob {
  std::string program;               ///< path of penumbra
  std::vector<std::string> words;    ///< after `submit`: words common to tasks and summary
  std::string frames;                ///< of the sequence
  std::string exposure;              ///< of all frames
  std::string first_frame;           ///< frame that determines the exposure and does not exist yet; empty: none
  std::vector<std::string> tasks;    ///< frames of each task
  std::vector<std::string> sbatch;   ///< further options: KEY or KEY=VALUE
  std::vector<std::string> summary;  ///< further words of the summary: how to submit again
  std::filesystem::path folder;      ///< of script and logs
  std::string name;                  ///< of the job
};

/// Returns the batch script: a Slurm array, whose summary is `bash SCRIPT summary`.
std::string text_of(const BatchJob& job);
std::filesystem::path script_of(const BatchJob& job);
/// Return the two commands that submit the job; `array`: the number printed by the first one.
std::vector<std::string> sbatch_array(const BatchJob& job);
std::vector<std::string> sbatch_summary(const BatchJob& job, std::string_view array);

/// Returns whether an option of sbatch is set by this program.
bool is_own_option(std::string_view name);

}  // namespace penumbra::app
