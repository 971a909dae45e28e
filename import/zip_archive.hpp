// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::import {

/// A zip archive in memory. Every failure is an InputError with the names of the archive and the entry.
class ZipArchive {
 public:
  static bool is_one(std::string_view content) { return content.starts_with("PK\x03\x04"); }

  /// `content` must outlive this object; `file` is its name in messages.
  ZipArchive(std::string_view content, std::string file);

  /// Returns the entries' names, in the archive's order.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] bool contains(std::string_view name) const;
  /// Returns an entry's content, unpacked, after checking its checksum.
  [[nodiscard]] std::string read(std::string_view name) const;

 private:
  struct Entry {
    std::uint64_t at = 0;                ///< offset of its own header
    std::uint64_t packed = 0, size = 0;  ///< bytes in the archive, and unpacked
    std::uint32_t checksum = 0, method = 0;
    bool encrypted = false;
  };
  static void take_sizes(std::string_view extra, Entry& entry);
  static std::string inflated(std::string_view packed, std::uint64_t size);

  std::string_view content_;
  std::string file_;
  std::vector<std::string> names_;
  std::vector<Entry> entries_;  ///< in the order of `names_`
};

}  // namespace penumbra::import
