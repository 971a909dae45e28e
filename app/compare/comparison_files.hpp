#pragma once

#include "app/options.hpp"
#include "app/process/output_files.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// What a comparison writes of each entry beside its EXR and its error picture.
struct EntryFiles {
  bool png = false, bits = false;
};

/// The name of an entry's files, without their endings: the entry with a comma for each colon, which some file systems
/// and tools do not take in a name. A name that would be too long for them is cut, and ends with digits that only this
/// entry has.
std::string file_stem(std::string label);

/// The files in a comparison's folder: DIR/<entry>.exr and so on.
class ComparisonFiles {
 public:
  ComparisonFiles(std::filesystem::path folder, EntryFiles wanted) : out_(std::move(folder)), wanted_(wanted) {}

  /// Makes the folder, and refuses what could not be written in the end, or is the scene. `stats`: a second place for
  /// metrics.json; empty: none.
  void claim(const std::filesystem::path& scene, std::span<const MethodEntry> entries,
             const std::filesystem::path& stats);
  /// UsageError if a file that is written is one of these.
  void refuse_inputs(std::span<const std::filesystem::path> inputs) const { outputs_.refuse_inputs(inputs); }

  [[nodiscard]] std::filesystem::path of(const std::string& label, const char* ending) const {
    return out_ / (file_stem(label) + ending);
  }

  /// Removes the files of an entry that failed: they are of an earlier run, or of one that did not end, and would pass
  /// for what the report speaks of. Other files are not touched: they may be anything. What stays, in words.
  [[nodiscard]] std::vector<std::string> remove(const std::string& label) const;

 private:
  /// What a run of that name writes, without the error picture.
  [[nodiscard]] std::vector<std::filesystem::path> files_of(const std::string& label) const;

  std::filesystem::path out_;
  EntryFiles wanted_;
  OutputFolder folder_;
  OutputFiles outputs_;
};

}  // namespace penumbra::app
