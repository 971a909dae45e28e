#pragma once

#include <cstdint>
#include <memory>
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
  /// What the library reads the archive through, as if it were a file.
  struct Cursor {
    std::string_view content;
    std::uint64_t at = 0;
  };
  struct Close {
    void operator()(void* archive) const;
  };

  std::string file_;
  std::unique_ptr<Cursor> cursor_;
  std::unique_ptr<void, Close> archive_;
  std::vector<std::string> names_;
};

}  // namespace penumbra::mesh
