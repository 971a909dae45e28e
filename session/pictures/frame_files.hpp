// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

namespace penumbra::session {

/// Files of one picture; an empty path is not requested.
struct FrameFiles {
  std::filesystem::path picture, stats, png, bits;

  /// Returns all requested files, each with its option.
  [[nodiscard]] std::vector<std::pair<const char*, std::filesystem::path>> all() const;
  /// Returns whether all requested files exist, complete and in the form written by `render`.
  [[nodiscard]] bool all_there() const;
  /// Returns files that exist but are incomplete, or were written by another program. Empty files only reserve a name
  /// for a running process, and are not listed.
  [[nodiscard]] std::vector<std::filesystem::path> spoilt() const;
};

}  // namespace penumbra::session
