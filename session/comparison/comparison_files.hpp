// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/options.hpp"
#include "session/process/output_files.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Files of each entry in addition to its EXR and its error picture.
struct EntryFiles {
  bool png = false, bits = false;
};

/// Returns the name of an entry's files, without their endings: the entry with a comma for each colon, which some file
/// systems and tools do not accept in a name. A name that would be too long is cut, and ends with a hash of the entry.
std::string file_stem(std::string label);

/// Files in a comparison's folder: DIR/<entry>.exr and so on.
class ComparisonFiles {
 public:
  ComparisonFiles(std::filesystem::path folder, EntryFiles wanted) : out_(std::move(folder)), wanted_(wanted) {}

  /// Makes the folder, and throws for files that could not be written in the end, or that are the scene. `stats`: a
  /// second copy of metrics.json; empty: none.
  void claim(const std::filesystem::path& scene, std::span<const MethodEntry> entries,
             const std::filesystem::path& stats);
  /// Throws UsageError if a file to be written is one of `inputs`.
  void refuse_inputs(std::span<const std::filesystem::path> inputs) const { outputs_.refuse_inputs(inputs); }

  [[nodiscard]] std::filesystem::path of(const std::string& label, const char* ending) const {
    return out_ / (file_stem(label) + ending);
  }

  /// Removes the files of an entry that failed. They were left by an earlier or incomplete run, and would be misleading
  /// next to the report. Other files are not touched. Returns messages about files that could not be removed.
  [[nodiscard]] std::vector<std::string> remove(const std::string& label) const;

 private:
  /// Returns the files written by a run with this name, without the error picture.
  [[nodiscard]] std::vector<std::filesystem::path> files_of(const std::string& label) const;

  std::filesystem::path out_;
  EntryFiles wanted_;
  OutputFolder folder_;
  OutputFiles outputs_;
};

}  // namespace penumbra::session
