// SPDX-License-Identifier: Apache-2.0
// Notices that files on disk changed, by time and size. A change is reported once two checks in a row agree, so that
// no file is read while another program is still writing it.

#include "app/view/file_watch.hpp"

#include <system_error>
#include <utility>

namespace penumbra::app {

FileWatch::FileWatch(std::vector<std::filesystem::path> files) : files_(std::move(files)) {
  known_ = last_ = look();
}

FileWatch::Looks FileWatch::look() const {
  Looks looks;
  for (const std::filesystem::path& file : files_) {
    std::error_code gone;
    Look& one = looks[file];  // empty for a file that does not exist
    one.time = std::filesystem::last_write_time(file, gone);
    one.size = gone ? 0 : std::filesystem::file_size(file, gone);
  }
  return looks;
}

bool FileWatch::changed() {
  Looks now = look();
  const bool settled = now == last_;
  last_ = std::move(now);
  if (!settled || last_ == known_) return false;
  known_ = last_;
  return true;
}

void FileWatch::look_at(std::vector<std::filesystem::path> files) {
  if (files == files_) return;
  files_ = std::move(files);
  last_ = look();
  Looks known;
  for (const auto& [file, seen] : last_) {
    const auto before = known_.find(file);
    known[file] = before == known_.end() ? seen : before->second;
  }
  known_ = std::move(known);
}

}  // namespace penumbra::app
