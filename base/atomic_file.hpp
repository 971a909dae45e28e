#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace penumbra {

/// An output file that appears whole or not at all: what is written goes to a temporary file beside the destination;
/// commit() flushes it to the disk and renames it into place. Without commit() the temporary is removed and the
/// destination stays as it was.
///
/// Refuses to replace what is not a regular file (a folder, a device, a pipe). A symbolic link to a regular file is
/// followed. Whatever fails (no such folder, no permission, disk full) is a ResourceError with the path as the
/// user gave it and the system's reason.
///
/// For tests only: the environment variable PENUMBRA_TEST_DISK_QUOTA=<bytes> makes every file behave as if the disk
/// had room for only so many bytes (ENOSPC).
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// The destination, as it was given.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// An existing empty file in the destination's folder, for libraries that want a path to write to.
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }

  /// Appends. For callers that need no library; do not mix with writing to temporary() by path.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  void commit();

 private:
  [[noreturn]] void fail(int error_number) const;
  void remove_temporary() noexcept;

  std::filesystem::path path_;         ///< as the user gave it: for messages
  std::filesystem::path destination_;  ///< path_ with symbolic links resolved
  std::filesystem::path temporary_;    ///< empty once committed
  int descriptor_ = -1;
  std::uint64_t written_ = 0;
};

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace penumbra
