// SPDX-License-Identifier: Apache-2.0
// Checks output files before long work.

#include "session/process/output_files.hpp"

#include "base/atomic_file.hpp"
#include "base/error.hpp"

#include <system_error>

#include <sys/stat.h>

namespace penumbra::session {

namespace {

FileIdentity identity_of(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) return {status.st_dev, status.st_ino, {}};
  // A file that does not exist yet is identified by its folder (which may have several paths) and its name.
  std::error_code error;
  std::filesystem::path target = std::filesystem::weakly_canonical(path, error);
  if (error || target.empty()) target = path.lexically_normal();
  const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
  if (::stat(folder.c_str(), &status) == 0) return {status.st_dev, status.st_ino, target.filename()};
  return {0, 0, target};  // the folder does not exist either
}

}  // namespace

void OutputFiles::add(const std::string& option, const std::filesystem::path& path) {
  if (path.empty()) return;
  if (path == "-")
    throw UsageError("{} -: expected the name of a file; stdout does not take it (./- is a file)", option);
  const auto [other, is_new] = numbers_.emplace(identity_of(path), files_.size());
  if (!is_new) {
    throw UsageError(
        "{} {} and {} {} are the same file, which two outputs cannot share; choose another name for one of them",
        files_[other->second].option, files_[other->second].path.string(), option, path.string());
  }
  files_.push_back({option, path});
}

void OutputFiles::refuse_inputs(std::span<const std::filesystem::path> inputs) const {
  // Computed again: folders may have been made since the outputs were named.
  std::map<FileIdentity, std::size_t> numbers;
  for (std::size_t i = 0; i < files_.size(); ++i) numbers.emplace(identity_of(files_[i].path), i);
  for (const std::filesystem::path& input : inputs) {
    const auto found = numbers.find(identity_of(input));
    if (found == numbers.end()) continue;
    const OutputFile& output = files_[found->second];
    throw UsageError("{} {}: this is an input ({}), which is never overwritten; choose another name", output.option,
                     output.path.string(), input.string());
  }
}

void OutputFiles::require_writable() const {
  for (const OutputFile& output : files_) const AtomicFile probe(output.path);  // makes, and removes, a file there
}

void OutputFolder::make(const std::filesystem::path& folder) {
  std::error_code error;
  for (std::filesystem::path missing = std::filesystem::absolute(folder).lexically_normal();
       std::filesystem::symlink_status(missing, error).type() == std::filesystem::file_type::not_found &&
       missing.has_relative_path();
       missing = missing.parent_path()) {
    made_.push_back(missing);
  }
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw ResourceError("cannot make the folder \"{}\": {}", folder.string(), error ? error.message() : "not a folder");
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;  // a folder that is not empty stays
  for (const std::filesystem::path& folder : made_) std::filesystem::remove(folder, ignored);
}

}  // namespace penumbra::session
