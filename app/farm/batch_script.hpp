#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::app {

/// One word of a shell, whatever is in it; there must be no newline.
std::string shell_word(std::string_view text);
/// One value of an #SBATCH line, likewise.
std::string sbatch_word(std::string_view text);
/// A name whose every character stands for itself where Slurm looks for %A and %a.
std::string sbatch_name(std::string_view name);

/// What a Slurm array is to do.
struct BatchJob {
  std::string program;               ///< penumbra
  std::vector<std::string> words;    ///< after `submit`: what is the same for tasks and summary
  std::string frames;                ///< the sequence
  std::string exposure;              ///< of all
  std::string first_frame;           ///< decides the exposure and is not there yet; empty: no matter
  std::vector<std::string> tasks;    ///< each one's frames
  std::vector<std::string> sbatch;   ///< more options: KEY or KEY=VALUE
  std::vector<std::string> summary;  ///< what the summary is told besides: how it submits again
  std::filesystem::path folder;      ///< of script and logs
  std::string name;                  ///< the job's
};

/// The batch script: a Slurm array, whose summary is `bash SCRIPT summary`.
std::string text_of(const BatchJob& job);
std::filesystem::path script_of(const BatchJob& job);
/// The two commands that submit it; `array`: the number that the first one printed.
std::vector<std::string> sbatch_array(const BatchJob& job);
std::vector<std::string> sbatch_summary(const BatchJob& job, std::string_view array);

/// Names of sbatch's options that are this program's own to set.
bool is_own_option(std::string_view name);

}  // namespace penumbra::app
