// SPDX-License-Identifier: Apache-2.0
// Output files that appear whole or not at all: nameless files (O_TMPFILE) linked in place, or locked, uniquely named
// part files.

#include "base/atomic_file.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace penumbra {
namespace {

constexpr std::uint64_t kNoQuota = std::numeric_limits<std::uint64_t>::max();

/// Returns the limit of PENUMBRA_TEST_DISK_QUOTA, read at each use so that a test can set and unset the variable.
std::uint64_t disk_quota() {
  const char* text = std::getenv("PENUMBRA_TEST_DISK_QUOTA");
  if (text == nullptr) return kNoQuota;
  std::uint64_t quota = kNoQuota;
  std::from_chars(text, text + std::strlen(text), quota);
  return quota;
}

/// Returns the folder that contains `file`, as a path that can be opened.
std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

/// Part files that have a name. The mutex is held while a file changes its name.
struct NamedParts {
  std::mutex mutex;
  std::set<std::filesystem::path> paths;
};

/// Never destroyed: a signal may come while the process ends.
NamedParts& named_parts() {
  static NamedParts& parts = *std::make_unique<NamedParts>().release();
  return parts;
}

/// Returns the prefix of part file names on this machine, constant until the next reboot. An equal prefix means the
/// same kernel, on which the lock of the process that made the part is visible.
const std::string& part_prefix() {
  static const std::string prefix = [] {
    std::ifstream stream("/proc/sys/kernel/random/boot_id");
    std::string boot;
    stream >> boot;
    return fmt::format(".penumbra-{}-", boot.substr(0, boot.find('-')));
  }();
  return prefix;
}

/// Removes a part file that no process has locked any more.
void remove_if_orphaned(const std::filesystem::path& part) {
  const int descriptor = ::open(part.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return;
  struct stat status {};
  if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) {
    ::unlink(part.c_str());  // an owner that locks too late sees that its file is gone, and creates another
  }
  ::close(descriptor);
}

/// Removes part files that killed processes left in a folder; runs once for each folder and process.
void remove_orphans(const std::filesystem::path& folder) {
  static std::mutex mutex;
  static std::set<std::filesystem::path> done;
  std::error_code error;
  const std::filesystem::path name = std::filesystem::canonical(folder, error);
  const std::lock_guard lock(mutex);
  if (error || !done.insert(name).second) return;
  const std::string& prefix = part_prefix();
  if (prefix == ".penumbra--") return;  // without /proc the owner of a part file cannot be determined
  std::filesystem::directory_iterator entries(name, error);
  for (; !error && entries != std::filesystem::directory_iterator(); entries.increment(error)) {
    const std::string file = entries->path().filename().string();
    if (file.starts_with(prefix) && file.find(".part") != std::string::npos) remove_if_orphaned(entries->path());
  }
}

/// Returns the final path of the file: follows symbolic links, so that a link survives and its target is replaced.
std::filesystem::path resolve_destination(const std::filesystem::path& path) {
  if (path.empty() || !path.has_filename()) {
    throw ResourceError("cannot write \"{}\": it names a folder; give the name of a file", path.string());
  }
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  std::filesystem::path target = std::filesystem::canonical(path, error);
  if (error) throw ResourceError("cannot write \"{}\": a symbolic link that leads nowhere", path.string());
  return target;
}

/// Returns a name that this process has not used yet: short (a long file name may leave no room for a suffix), with the
/// destination's extension to help users who find a part file.
std::filesystem::path next_part(const std::filesystem::path& destination) {
  static std::atomic<unsigned> serial{0};
  return destination.parent_path() /
         fmt::format("{}{}-{}.part{}", part_prefix(), ::getpid(), serial++, destination.extension().string());
}

std::string path_of_descriptor(int descriptor) {
  return fmt::format("/proc/self/fd/{}", descriptor);
}

void refuse_what_is_no_regular_file(const std::filesystem::path& path, const std::filesystem::path& destination) {
  struct stat status {};
  // A file that does not exist, or cannot be reached: creating it reports why.
  if (::lstat(destination.c_str(), &status) != 0) return;
  if (S_ISREG(status.st_mode)) return;
  const char* kind = S_ISDIR(status.st_mode)                                ? "a folder"
                     : S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode)   ? "a device"
                     : S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode) ? "a pipe or socket"
                                                                            : "not a regular file";
  throw ResourceError("cannot write \"{}\": it is {}; only a regular file is ever replaced", path.string(), kind);
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)), destination_(resolve_destination(path_)) {
  refuse_what_is_no_regular_file(path_, destination_);
  remove_orphans(folder_of(destination_));
  if (!open_nameless()) open_named();
}

/// Returns false if the file system or the machine does not support nameless files.
bool AtomicFile::open_nameless() {
  if (std::getenv("PENUMBRA_TEST_NAMED_PARTS") != nullptr) return false;
  descriptor_ = ::open(folder_of(destination_).c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
  if (descriptor_ < 0) return false;  // any other reason is reported by open_named()
  const bool can_be_named = ::access(path_of_descriptor(descriptor_).c_str(), F_OK) == 0;
  if (!can_be_named) ::close(std::exchange(descriptor_, -1));
  // The lock is taken before the file gets a name, so that no other process mistakes the file for an orphan.
  if (can_be_named) ::flock(descriptor_, LOCK_EX);
  return can_be_named;
}

void AtomicFile::open_named() {
  for (;;) {
    temporary_ = next_part(destination_);
    {
      const std::lock_guard lock(named_parts().mutex);
      descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ >= 0) named_parts().paths.insert(temporary_);
    }
    if (descriptor_ < 0 && errno == EEXIST) continue;
    if (descriptor_ < 0) fail(errno);
    ::flock(descriptor_, LOCK_EX);  // on a file system without locks no process gets a lock, and orphans stay
    struct stat status {};
    if (::fstat(descriptor_, &status) == 0 && status.st_nlink > 0) return;
    remove_temporary();  // another process removed the file as an orphan before it was locked
  }
}

AtomicFile::~AtomicFile() {
  remove_temporary();
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  write_at(size_, bytes);
}

void AtomicFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  PENUMBRA_ASSERT(descriptor_ >= 0, "write after commit to {}", path_.string());
  settled_ = false;
  const std::uint64_t quota = disk_quota();
  while (!bytes.empty()) {
    const std::uint64_t room = quota - std::min(quota, offset);
    if (room == 0) fail(ENOSPC);
    const ssize_t count =
        ::pwrite(descriptor_, bytes.data(), std::min<std::uint64_t>(bytes.size(), room), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(errno);
    if (count == 0) fail(ENOSPC);
    bytes = bytes.subspan(static_cast<std::size_t>(count));  // a short write: the next call reports the reason
    offset += static_cast<std::uint64_t>(count);
    size_ = std::max(size_, offset);
  }
}

void AtomicFile::write(std::string_view text) {
  write(std::as_bytes(std::span(text)));
}

void AtomicFile::settle() {
  PENUMBRA_ASSERT(descriptor_ >= 0, "settle after commit of {}", path_.string());
  if (::fsync(descriptor_) != 0 && errno != EINVAL) fail(errno);  // EINVAL: a file system without fsync
  settled_ = true;
}

void AtomicFile::commit() {
  PENUMBRA_ASSERT(descriptor_ >= 0, "second commit of {}", path_.string());
  if (!settled_) settle();
  // Checked again: another process may have put something else there since (rename itself refuses only folders).
  refuse_what_is_no_regular_file(path_, destination_);
  give_name();
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail(errno);
  // Makes the rename itself reach the disk, by flushing the folder. Best effort: the file is complete in any case.
  if (const int descriptor = ::open(folder_of(destination_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      descriptor >= 0) {
    ::fsync(descriptor);
    ::close(descriptor);
  }
}

/// A hard link never replaces a file: where the destination exists, the file first gets a part name, which is then
/// renamed.
void AtomicFile::give_name() {
  NamedParts& parts = named_parts();
  const std::lock_guard lock(parts.mutex);
  if (temporary_.empty()) {
    const std::string nameless = path_of_descriptor(descriptor_);
    const auto link = [&](const std::filesystem::path& name) {
      return ::linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
    };
    if (link(destination_)) return;
    if (errno != EEXIST) fail(errno);
    for (std::filesystem::path part = next_part(destination_);; part = next_part(destination_)) {
      if (link(part)) {
        temporary_ = part;
        parts.paths.insert(part);
        break;
      }
      if (errno != EEXIST) fail(errno);
    }
  }
  if (::rename(temporary_.c_str(), destination_.c_str()) != 0) fail(errno);
  parts.paths.erase(temporary_);
  temporary_.clear();
}

void AtomicFile::fail(int error_number) const {
  throw ResourceError("cannot write \"{}\": {}", path_.string(), std::generic_category().message(error_number));
}

void AtomicFile::remove_temporary() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (temporary_.empty()) return;
  const std::lock_guard lock(named_parts().mutex);
  ::unlink(temporary_.c_str());
  named_parts().paths.erase(temporary_);
  temporary_.clear();
}

void remove_unfinished_files() {
  NamedParts& parts = named_parts();
  parts.mutex.lock();  // never unlocked
  for (const std::filesystem::path& part : parts.paths) ::unlink(part.c_str());
}

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

void write_file_atomically(const std::filesystem::path& path, std::string_view text) {
  write_file_atomically(path, std::as_bytes(std::span(text)));
}

}  // namespace penumbra
