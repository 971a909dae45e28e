#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::mesh {

/// A zip archive in memory. Every failure is an InputError with the archive's name, and the entry's.
class ZipArchive {
 public:
  static bool is_one(std::string_view content) { return content.starts_with("PK\x03\x04"); }

  /// `content` must outlive this; `file` is its name in messages.
  ZipArchive(std::string_view content, std::string file);

  /// The entries' names, in the archive's order.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] bool contains(std::string_view name) const;
  /// An entry's content, unpacked and its checksum tested.
  [[nodiscard]] std::string read(std::string_view name) const;

 private:
  struct Entry {
    std::uint64_t at = 0;                ///< of its own header
    std::uint64_t packed = 0, size = 0;  ///< bytes in the archive, and unpacked
    std::uint32_t checksum = 0, method = 0;
    bool encrypted = false;
  };
  static void take_sizes(std::string_view extra, Entry& entry);
  static std::string inflated(std::string_view packed, std::uint64_t size);

  std::string_view content_;
  std::string file_;
  std::vector<std::string> names_;
  std::vector<Entry> entries_;  ///< as `names_`
};

}  // namespace penumbra::mesh
