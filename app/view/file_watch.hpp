// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

namespace penumbra::app {

/// Detects changes of files on disk, by their times and sizes. A change counts once the files have been the same at two
/// checks: editors write in pieces.
class FileWatch {
 public:
  explicit FileWatch(std::vector<std::filesystem::path> files);
  /// Returns whether a file has changed since the last true result, or since the files were named.
  bool changed();
  /// Watches these files from now on; the state of files already watched is kept.
  void look_at(std::vector<std::filesystem::path> files);

 private:
  struct Look {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    bool operator==(const Look&) const = default;
  };
  using Looks = std::map<std::filesystem::path, Look>;
  [[nodiscard]] Looks look() const;

  std::vector<std::filesystem::path> files_;
  Looks known_, last_;
};

}  // namespace penumbra::app
