#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

namespace penumbra::app {

/// Notices when files change on disk, by their times and sizes. A change counts once the files have been the same at
/// two looks: editors write in pieces.
class FileWatch {
 public:
  explicit FileWatch(std::vector<std::filesystem::path> files);
  /// Has one changed since the last true answer, or since the files were named?
  bool changed();
  /// Looks at these from now on; those that it knew already stay as they are known.
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
