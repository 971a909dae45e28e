// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace penumbra {

/// An output file that appears whole or not at all: bytes are written to a nameless file in the destination's folder,
/// which commit() flushes to the disk and names. Without commit() the destination stays unchanged, and no file is left,
/// however the process ends.
///
/// Where the file system does not support nameless files, or where the new file has to replace an old one, the file
/// temporarily has the name ".penumbra-BOOT-PID-N.part". Its owner holds a lock (flock) on this file: a part file
/// without an owner was left by a killed process, and is removed by the first AtomicFile of a process in that folder.
/// BOOT identifies the running kernel, so that part files of other machines in a shared folder, whose locks might not
/// be visible here, are left alone.
///
/// Refuses to replace anything but a regular file (a folder, a device, a pipe). A symbolic link to a regular file is
/// followed. Every failure (no such folder, no permission, disk full) is a ResourceError with the path as the user gave
/// it and the system's reason.
///
/// Environment variables, for tests only: PENUMBRA_TEST_DISK_QUOTA=<bytes> makes every file behave as if the disk had
/// room for that many bytes (ENOSPC); PENUMBRA_TEST_NAMED_PARTS=1 as if the file system did not support nameless files.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// Returns the destination, as the caller gave it.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Appends bytes to the file.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Writes from byte `offset` of the file on, replacing existing bytes; a gap beyond the end becomes zeros.
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);
  /// Returns the number of bytes from the beginning to the end of the written part.
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Flushes the written bytes to the disk, after which commit() only names the file. For several files that must all
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

/// Removes the temporary files of every AtomicFile of this process. None of these files can be committed any more: a
/// thread that calls commit() blocks forever. For a process that ends without unwinding.
void remove_unfinished_files();

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace penumbra
