// SPDX-License-Identifier: Apache-2.0
// Opens input files so that symbolic links cannot lead out of a folder, and so that devices and pipes are refused.

#include "mesh/input_file.hpp"

#include "base/file_error.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <string_view>
#include <vector>

namespace penumbra::mesh {
namespace {

constexpr int kReadFlags = O_RDONLY | O_CLOEXEC | O_NONBLOCK;  // nonblocking, since opening a named pipe without a
                                                               // writer would block
constexpr int kFolderFlags = O_PATH | O_DIRECTORY | O_CLOEXEC;

void require_content(int descriptor, const std::string& shown) {
  if (!require_regular(descriptor, shown)) throw InputError("{}: the file is empty (0 bytes)", shown);
}

/// Resolves a name from a folder, one component at a time, never leaving the folder.
class Walk {
 public:
  Walk(int folder, const std::string& name) : folder_(folder) {
    struct stat here {
    }, root{};
    at_root_ = ::fstat(folder, &here) == 0 && ::stat("/", &root) == 0 && here.st_dev == root.st_dev &&
               here.st_ino == root.st_ino;
    push(name);
  }

  OpenedBeneath open(int flags) {
    while (error_ == 0 && !waiting_.empty()) {
      const std::string name = std::move(waiting_.back());
      waiting_.pop_back();
      if (name == "..") {
        up();
      } else if (enter(name)) {
        return finish(::openat(current(), name.c_str(), flags | O_NOFOLLOW | O_CLOEXEC), name);
      }
    }
    if (error_ != 0) return failed(error_);
    return finish(::openat(current(), ".", flags | O_CLOEXEC), "");
  }

 private:
  static OpenedBeneath failed(int error) { return {Descriptor(), "", error}; }

  [[nodiscard]] int current() const { return entered_.empty() ? folder_ : entered_.back().get(); }

  /// Queues the components of `path`, to be resolved next.
  void push(const std::string& path) {
    if (path.empty()) error_ = ENOENT;
    if (path.starts_with('/')) {
      if (!at_root_) error_ = EXDEV;
      entered_.clear();
      names_.clear();
    }
    std::vector<std::string> parts;
    for (std::size_t at = 0; at < path.size();) {
      const std::size_t end = std::min(path.find('/', at), path.size());
      const std::string part = path.substr(at, end - at);
      if (!part.empty() && part != ".") parts.push_back(part);
      at = end + 1;
    }
    waiting_.insert(waiting_.end(), parts.rbegin(), parts.rend());
  }

  void up() {
    if (entered_.empty()) {
      if (!at_root_) error_ = EXDEV;  // the root is its own parent
      return;
    }
    entered_.pop_back();
    names_.pop_back();
  }

  /// Enters the folder `name`, or queues the target of a link. Returns true for anything else, which ends the walk.
  bool enter(const std::string& name) {
    Descriptor entry(::openat(current(), name.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC));
    struct stat info {};
    if (!entry.is_open() || ::fstat(entry.get(), &info) != 0) {
      error_ = errno;
      return false;
    }
    if (S_ISLNK(info.st_mode)) {
      constexpr int kMostLinks = 40;  // the kernel's limit
      std::array<char, PATH_MAX> target{};
      const ssize_t length = ::readlinkat(entry.get(), "", target.data(), target.size());
      if (length < 0 || ++links_ > kMostLinks) {
        error_ = length < 0 ? errno : ELOOP;
      } else {
        push(std::string(target.data(), static_cast<std::size_t>(length)));
      }
      return false;
    }
    if (S_ISDIR(info.st_mode)) {
      entered_.push_back(std::move(entry));
      names_.push_back(name);
      return false;
    }
    if (!waiting_.empty()) error_ = ENOTDIR;
    return error_ == 0;
  }

  [[nodiscard]] OpenedBeneath finish(int descriptor, const std::string& name) const {
    if (descriptor < 0) return failed(errno);
    std::string path;
    for (const std::string& part : names_) path += part + "/";
    return {Descriptor(descriptor), path + name, 0};
  }

  int folder_;
  bool at_root_ = false;
  std::vector<Descriptor> entered_;  ///< folders entered so far, and their names
  std::vector<std::string> names_;
  std::vector<std::string> waiting_;  ///< remaining components; the next one is last
  int links_ = 0, error_ = 0;
};

}  // namespace

bool require_regular(int descriptor, const std::string& shown) {
  struct stat info {};
  if (::fstat(descriptor, &info) != 0) throw_file_error(errno, shown);
  if (S_ISDIR(info.st_mode)) throw InputError("{}: it is a folder, not a file", shown);
  if (!S_ISREG(info.st_mode)) throw InputError("{}: it is not a regular file", shown);
  return info.st_size > 0;
}

InputFile open_input(const std::filesystem::path& file) {
  const std::string shown = file.string();
  // Inspected before it is opened: opening a device may have side effects.
  const Descriptor named(::open(file.c_str(), O_PATH | O_CLOEXEC));
  if (!named.is_open()) throw_file_error(errno, shown);
  require_regular(named.get(), shown);
  InputFile input{file, Descriptor(::open(file.c_str(), kReadFlags)), {}};
  if (!input.content.is_open()) throw_file_error(errno, shown);
  require_content(input.content.get(), shown);
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  input.folder = Descriptor(::open(folder.c_str(), kFolderFlags));
  if (!input.folder.is_open()) throw_file_error(errno, folder.string());
  return input;
}

OpenedBeneath open_beneath(int folder, const std::string& name, int flags) {
  return Walk(folder, name).open(flags);
}

InputBeneath open_input_beneath(int folder, const std::string& name, const std::filesystem::path& shown) {
  // require_regular refuses everything but files; NONBLOCK and NOCTTY prevent side effects of opening.
  OpenedBeneath file = open_beneath(folder, name, kReadFlags | O_NOCTTY);
  if (file.error != 0) return {{}, "", file.error};
  require_content(file.descriptor.get(), shown.string());
  const std::string parent = std::filesystem::path(name).parent_path().string();
  OpenedBeneath home = open_beneath(folder, parent.empty() ? "." : parent, kFolderFlags);
  if (home.error != 0) return {{}, "", home.error};
  return {{shown, std::move(file.descriptor), std::move(home.descriptor)}, std::move(file.path), 0};
}

std::string read_content(int descriptor, const std::string& shown) {
  struct stat info {};
  if (::fstat(descriptor, &info) != 0) throw_file_error(errno, shown);
  std::string content(static_cast<std::size_t>(info.st_size), '\0');
  std::size_t at = 0;
  while (at < content.size()) {
    const ssize_t count = ::pread(descriptor, content.data() + at, content.size() - at, static_cast<off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_file_error(errno, shown);
    if (count == 0) throw InputError("{}: only {} of {} bytes could be read", shown, at, content.size());
    at += static_cast<std::size_t>(count);
  }
  return content;
}

}  // namespace penumbra::mesh
