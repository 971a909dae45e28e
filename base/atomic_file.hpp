#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace penumbra {

/// An output file that appears whole or not at all: what is written goes to a file without a name in the destination's
/// folder, which commit() flushes to the disk and gives its name. Without commit() the destination stays as it was, and
/// nothing is left, however the process ends.
///
/// Where the file system has no files without names, or where the new file has to replace an old one, the file is for a
/// while, or for a moment, called ".penumbra-BOOT-PID-N.part". Its owner holds a lock (flock) on it: one without an
/// owner was left by a process that was killed, and the first AtomicFile of a process in a folder removes those. BOOT
/// stands for the running kernel, so that files of other machines in a shared folder, whose locks might not be seen
/// here, are left alone.
///
/// Refuses to replace what is not a regular file (a folder, a device, a pipe). A symbolic link to a regular file is
/// followed. Whatever fails (no such folder, no permission, disk full) is a ResourceError with the path as the
/// user gave it and the system's reason.
///
/// For tests only, environment variables: PENUMBRA_TEST_DISK_QUOTA=<bytes> makes every file behave as if the disk had
/// room for only so many bytes (ENOSPC); PENUMBRA_TEST_NAMED_PARTS=1 as if no file could be without a name.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// The destination, as it was given.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Appends.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Writes from byte `offset` of the file on, over what is there; what is skipped beyond the end becomes zeros.
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);
  /// Bytes from the beginning to the end of what was written.
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Flushes what was written to the disk: after it commit() only gives the name. For several files that shall all
  /// appear or none: write and settle each, then commit each.
  void settle();
  void commit();

 private:
  [[noreturn]] void fail(int error_number) const;
  bool open_nameless();
  void open_named();
  void give_name();
  void remove_temporary() noexcept;

  std::filesystem::path path_;         ///< as the user gave it: for messages
  std::filesystem::path destination_;  ///< path_ with symbolic links resolved
  std::filesystem::path temporary_;    ///< empty while the file has no name, and once committed
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  bool settled_ = false;
};

/// Removes the temporary files of every AtomicFile of this process. None gets its name any more, and whoever asks for
/// that waits for ever: for a process that ends without unwinding.
void remove_unfinished_files();

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace penumbra
