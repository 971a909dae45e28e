#include "base/atomic_file.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace penumbra {
namespace {

constexpr std::uint64_t kNoQuota = std::numeric_limits<std::uint64_t>::max();

/// PENUMBRA_TEST_DISK_QUOTA, read at each use so that a test can set and unset it.
std::uint64_t disk_quota() {
  const char* text = std::getenv("PENUMBRA_TEST_DISK_QUOTA");
  if (text == nullptr) return kNoQuota;
  std::uint64_t quota = kNoQuota;
  std::from_chars(text, text + std::strlen(text), quota);
  return quota;
}

/// Where the file shall stand in the end: links are followed, so that the link survives and its target is replaced.
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

void refuse_what_is_no_regular_file(const std::filesystem::path& path, const std::filesystem::path& destination) {
  struct stat status {};
  if (::lstat(destination.c_str(), &status) != 0) return;  // not there (or not reachable: creating will say why)
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
  // The name is short and our own (a long file name may leave no room for a suffix), unique among processes and
  // threads, and keeps the extension for libraries that choose the format by it.
  static std::atomic<unsigned> serial{0};
  for (;;) {
    const std::string name =
        fmt::format(".penumbra-{}-{}.part{}", ::getpid(), serial++, destination_.extension().string());
    temporary_ = destination_.parent_path() / name;
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) return;
    if (errno != EEXIST) fail(errno);
  }
}

AtomicFile::~AtomicFile() {
  remove_temporary();
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  PENUMBRA_ASSERT(descriptor_ >= 0, "write after commit to {}", path_.string());
  const std::uint64_t quota = disk_quota();
  while (!bytes.empty()) {
    const std::uint64_t room = quota - std::min(quota, written_);
    if (room == 0) fail(ENOSPC);
    const ssize_t count = ::write(descriptor_, bytes.data(), std::min<std::uint64_t>(bytes.size(), room));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(errno);
    if (count == 0) fail(ENOSPC);
    bytes = bytes.subspan(static_cast<std::size_t>(count));  // a short write: the next try says why
    written_ += static_cast<std::uint64_t>(count);
  }
}

void AtomicFile::write(std::string_view text) {
  write(std::as_bytes(std::span(text)));
}

void AtomicFile::commit() {
  PENUMBRA_ASSERT(descriptor_ >= 0, "second commit of {}", path_.string());
  // A library may have replaced the temporary instead of filling it, so the file behind the name is what counts.
  struct stat status {};
  if (::stat(temporary_.c_str(), &status) != 0) fail(errno);
  if (static_cast<std::uint64_t>(status.st_size) > disk_quota()) fail(ENOSPC);
  const int by_name = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (by_name < 0) fail(errno);
  const int sync_error = ::fsync(by_name) == 0 ? 0 : errno;
  ::close(by_name);
  if (sync_error != 0 && sync_error != EINVAL) fail(sync_error);  // EINVAL: a file system without fsync
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail(errno);
  // Again, in case somebody put something else there meanwhile (rename itself refuses only folders).
  refuse_what_is_no_regular_file(path_, destination_);
  if (::rename(temporary_.c_str(), destination_.c_str()) != 0) fail(errno);
  temporary_.clear();
  // The rename itself reaches the disk with the folder. Best effort: the file is complete either way.
  const std::filesystem::path folder = destination_.has_parent_path() ? destination_.parent_path() : ".";
  if (const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); descriptor >= 0) {
    ::fsync(descriptor);
    ::close(descriptor);
  }
}

void AtomicFile::fail(int error_number) const {
  throw ResourceError("cannot write \"{}\": {}", path_.string(), std::generic_category().message(error_number));
}

void AtomicFile::remove_temporary() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
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
