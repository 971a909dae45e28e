// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace penumbra {

/// Empty folder for temporary files. The destructor removes the folder with all that is in it. Within
/// UnwindsAfterSignals a signal removes it, too.
class ScratchFolder {
 public:
  /// Makes the folder in `parent`. Throws ResourceError with the system's reason if that fails.
  explicit ScratchFolder(const std::filesystem::path& parent);
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace penumbra
