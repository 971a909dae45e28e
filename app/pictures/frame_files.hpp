#pragma once

#include <filesystem>
#include <utility>
#include <vector>

namespace penumbra::app {

/// Where one picture goes; what is empty is not wanted.
struct FrameFiles {
  std::filesystem::path picture, stats, png, bits;

  /// All that are wanted, each with the option that asks for it.
  [[nodiscard]] std::vector<std::pair<const char*, std::filesystem::path>> all() const;
  /// Are all that are wanted there, each whole and as `render` writes it?
  [[nodiscard]] bool all_there() const;
  /// Files that exist but are incomplete, or were written by another program. Empty files only reserve a name for a
  /// running process, and are not listed.
  [[nodiscard]] std::vector<std::filesystem::path> spoilt() const;
};

}  // namespace penumbra::app
