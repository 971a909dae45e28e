// SPDX-License-Identifier: Apache-2.0
// Writes the batch script of a Slurm array and its sbatch commands.

#include "app/farm/batch_script.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

namespace penumbra::app {
namespace {

std::string replaced(std::string_view text, char wanted, std::string_view by) {
  std::string result;
  for (const char c : text) c == wanted ? result.append(by) : result.append(1, c);
  return result;
}

/// Returns the words, each quoted for the shell.
std::string shell_words(const std::vector<std::string>& words) {
  std::vector<std::string> quoted;
  for (const std::string& word : words) quoted.push_back(shell_word(word));
  return fmt::format("{}", fmt::join(quoted, " "));
}

/// Returns whether the user specified a task's part of a node. Otherwise a task gets a whole node, because a frame uses
/// all cores.
bool shares_nodes(const BatchJob& job) {
  constexpr std::array kShares = {"cpus-per-task", "ntasks", "ntasks-per-node", "oversubscribe", "exclusive"};
  return std::ranges::any_of(job.sbatch, [&](const std::string& option) {
    return std::ranges::find(kShares, option.substr(0, option.find('='))) != kShares.end();
  });
}

}  // namespace

std::string shell_word(std::string_view text) {
  return "'" + replaced(text, '\'', R"('\'')") + "'";
}

std::string sbatch_word(std::string_view text) {
  return "\"" + replaced(replaced(text, '\\', R"(\\)"), '"', R"(\")") + "\"";
}

std::string sbatch_name(std::string_view name) {
  return replaced(name, '%', "%%");
}

bool is_own_option(std::string_view name) {
  constexpr std::array kOwn = {"array",    "output", "error",      "open-mode", "requeue", "no-requeue", "nodes",
                               "parsable", "wrap",   "dependency", "job-name",  "wait",    "test-only"};
  return std::ranges::find(kOwn, name) != kOwn.end();
}

std::filesystem::path script_of(const BatchJob& job) {
  return job.folder / "frames.sh";
}

std::string text_of(const BatchJob& job) {
  std::string text =
      "#!/bin/bash\n# Written by `penumbra submit`. These commands submit it, and a summary that runs after all of its "
      "tasks:\n";
  std::vector<std::string> summary = sbatch_summary(job, "");
  const std::string after = std::exchange(summary.back(), {});
  summary.pop_back();
  text += fmt::format("#   array=$({}); {} {}$array\n", shell_words(sbatch_array(job)), shell_words(summary), after);
  if (!job.first_frame.empty())
    text += fmt::format(
        "# The first frame determines the exposure of all frames, and must be rendered before:\n#   {} render {} {}\n",
        shell_word(job.program), shell_words(job.words), job.first_frame);
  text += fmt::format("#SBATCH --job-name={}\n", sbatch_word(job.name));
  text += fmt::format("#SBATCH --array=0-{}\n", job.tasks.size() - 1);
  text += fmt::format("#SBATCH --output={}\n", sbatch_word(sbatch_name(job.folder.string()) + "/%A_%a.log"));
  // A task that lost its node continues elsewhere, with the same log.
  text += "#SBATCH --open-mode=append\n#SBATCH --requeue\n#SBATCH --nodes=1\n";
  if (!shares_nodes(job)) text += "#SBATCH --exclusive\n";
  for (const std::string& option : job.sbatch) {
    const auto equals = option.find('=');
    text += fmt::format("#SBATCH --{}", option.substr(0, equals));
    if (equals != std::string::npos) text += "=" + sbatch_word(std::string_view(option).substr(equals + 1));
    text += "\n";
  }
  text += fmt::format("\npenumbra={}\nsubmit=(submit {})\n", shell_word(job.program), shell_words(job.words));
  text += fmt::format("if [[ ${{1-}} == summary ]]; then\n  exec \"$penumbra\" \"${{submit[@]}}\" {}\nfi\n",
                      shell_words(job.summary));
  text += "tasks=(\n";
  for (const std::string& frames : job.tasks) text += fmt::format("  {}\n", frames);
  text += ")\n";
  text += "frames=${tasks[$SLURM_ARRAY_TASK_ID]:?}\n";
  text += "printf 'frames %s on %s, %(%F %T)T\\n' \"$frames\" \"${SLURMD_NODENAME-$HOSTNAME}\" -1\n";
  text += fmt::format("exec \"$penumbra\" \"${{submit[@]}}\" {} {} --jobs=1 \"--frames=$frames\"\n",
                      shell_word("--exposure=" + job.exposure), shell_word("--logs=" + job.folder.string()));
  return text;
}

std::vector<std::string> sbatch_array(const BatchJob& job) {
  return {"sbatch", "--parsable", script_of(job).string()};
}

std::vector<std::string> sbatch_summary(const BatchJob& job, std::string_view array) {
  std::vector<std::string> words = {
      "sbatch",
      "--parsable",
      "--job-name=" + job.name + "-summary",
      "--output=" + sbatch_name(job.folder.string()) + "/summary-%j.log",
      "--open-mode=append",
      "--requeue",
      "--nodes=1",
  };
  for (const std::string& option : job.sbatch) words.push_back("--" + option);
  words.push_back("--wrap=bash " + shell_word(script_of(job).string()) + " summary");
  words.push_back(fmt::format("--dependency=afterany:{}", array));
  return words;
}

}  // namespace penumbra::app
