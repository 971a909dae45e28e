// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <sys/types.h>

namespace penumbra::session {

/// Output file of a command.
struct OutputFile {
  std::string option;  ///< option that requests the file, for messages: "-o", "--stats"
  std::filesystem::path path;
};

/// Equal for two paths if and only if they lead to the same file, now or once it is written.
struct FileIdentity {
  dev_t device = 0;
  ino_t inode = 0;
  std::filesystem::path name;  ///< name in the folder identified by the two numbers; empty: the numbers are the file's
                               ///< own
  auto operator<=>(const FileIdentity&) const = default;
};

/// All output files of a command. No two of them may be the same file, and none may be an input file. Identity is
/// decided by device and inode (for a file that does not exist, by its folder and name), so that links, relative names
/// and "a/../b" are recognised.
class OutputFiles {
 public:
  /// Adds a file; an empty path is ignored. Throws UsageError if another output is the same file.
  void add(const std::string& option, const std::filesystem::path& path);

  /// Throws UsageError if an output is one of `inputs`. To be called for inputs on the command line before any are
  /// read, and again for all opened files before any output is written.
  void refuse_inputs(std::span<const std::filesystem::path> inputs) const;

  /// Throws ResourceError now, before long work, if an output is not writable.
  void require_writable() const;

 private:
  std::vector<OutputFile> files_;
  std::map<FileIdentity, std::size_t> numbers_;  ///< indices into files_
};

/// Folder for outputs. The destructor removes the folders made by make() that are still empty: a command that fails
/// early leaves nothing.
class OutputFolder {
 public:
  OutputFolder() = default;
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder();

  /// Makes the folder and its parents. Throws ResourceError if it cannot be made.
  void make(const std::filesystem::path& folder);

 private:
  std::vector<std::filesystem::path> made_;  // innermost first
};

}  // namespace penumbra::session
