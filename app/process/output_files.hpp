#pragma once

#include <compare>
#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <sys/types.h>

namespace penumbra::app {

/// A file that a command is going to write.
struct OutputFile {
  std::string option;  ///< what asks for it, for messages: "-o", "--stats"
  std::filesystem::path path;
};

/// Equal for two paths if and only if they lead to one file, now or when it will have been written.
struct FileIdentity {
  dev_t device = 0;
  ino_t inode = 0;
  std::filesystem::path name;  ///< in the folder that the two numbers are of; empty: they are the file's own
  auto operator<=>(const FileIdentity&) const = default;
};

/// All files that a command writes. No two of them may be one file, and none may be a file that it reads; which files
/// are one is decided by what they are (device and inode; of what is not there yet, its folder and name), so that
/// links, relative names and "a/../b" do not hide it.
class OutputFiles {
 public:
  /// Adds a file; an empty path is none. UsageError if another output is the same file.
  void add(const std::string& option, const std::filesystem::path& path);

  /// UsageError if an output is one of these. Call it for what the command line names before anything is read, and
  /// again for all that was opened before anything is written.
  void refuse_inputs(std::span<const std::filesystem::path> inputs) const;

  /// ResourceError now, before long work, if one of them could not be written.
  void require_writable() const;

 private:
  std::vector<OutputFile> files_;
  std::map<FileIdentity, std::size_t> numbers_;  ///< into files_
};

/// A folder for outputs. What of it, and of the folders around it, had to be made goes again with this object if it is
/// still empty then: a command that is refused leaves nothing.
class OutputFolder {
 public:
  OutputFolder() = default;
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder();

  /// Throws ResourceError if it cannot be made.
  void make(const std::filesystem::path& folder);

 private:
  std::vector<std::filesystem::path> made_;  // innermost first
};

}  // namespace penumbra::app
