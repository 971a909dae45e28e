// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include <unistd.h>

namespace penumbra::fuzz {

/// A new, empty folder for the file of a fuzz target, so that files to which it refers do not exist.
class Folder {
 public:
  Folder() : path_((std::filesystem::temp_directory_path() / "penumbra-fuzz-XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) std::abort();
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  /// Writes `data` to a file of this name, and returns its path.
  [[nodiscard]] std::filesystem::path write(const std::string& name, std::span<const std::uint8_t> data) const {
    std::filesystem::path file = std::filesystem::path(path_) / name;
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
    return file;
  }

 private:
  std::string path_;
};

}  // namespace penumbra::fuzz
