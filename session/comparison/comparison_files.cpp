// SPDX-License-Identifier: Apache-2.0
// Names and removes the files of a comparison.

#include "session/comparison/comparison_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <system_error>

namespace penumbra::session {

std::string file_stem(std::string label) {
  constexpr std::size_t kLongest = 200, kKept = 180;  // a whole name has at most 255 bytes, also a temporary one
  std::ranges::replace(label, ':', ',');
  if (label.size() <= kLongest) return label;
  std::uint64_t digest = 0xcbf29ce484222325;  // FNV-1a, the same on every machine
  for (const char c : label) digest = (digest ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return fmt::format("{}-{:016x}", label.substr(0, kKept), digest);
}

void ComparisonFiles::claim(const std::filesystem::path& scene, std::span<const MethodEntry> entries,
                            const std::filesystem::path& stats) {
  folder_.make(out_);
  outputs_.add("-o", out_ / "metrics.json");
  outputs_.add("-o", out_ / "metrics.csv");
  outputs_.add("-o", out_ / "report.html");
  outputs_.add("--stats", stats);
  for (const std::filesystem::path& file : files_of("reference")) outputs_.add("-o", file);
  for (const MethodEntry& entry : entries) {
    for (const std::filesystem::path& file : files_of(entry.label)) outputs_.add("-o", file);
    outputs_.add("-o", of(entry.label, "-error.png"));
  }
  outputs_.refuse_inputs({&scene, 1});
  outputs_.require_writable();
}

std::vector<std::string> ComparisonFiles::remove(const std::string& label) const {
  std::vector<std::string> left;
  std::vector<std::filesystem::path> files = files_of(label);
  files.push_back(of(label, "-error.png"));
  for (const std::filesystem::path& file : files) {
    std::error_code error;
    const auto status = std::filesystem::symlink_status(file, error);
    if (!std::filesystem::exists(status)) continue;
    if (!std::filesystem::is_regular_file(status)) {
      left.push_back(
          fmt::format("{} was left by an earlier run and is not a regular file: it is not removed", file.string()));
      continue;
    }
    std::filesystem::remove(file, error);
    if (error) {
      left.push_back(
          fmt::format("{} was left by an earlier run and cannot be removed: {}", file.string(), error.message()));
    }
  }
  return left;
}

std::vector<std::filesystem::path> ComparisonFiles::files_of(const std::string& label) const {
  std::vector<std::filesystem::path> files = {of(label, ".exr")};
  if (wanted_.png) files.push_back(of(label, ".png"));
  if (wanted_.bits) files.push_back(of(label, ".bits"));
  return files;
}

}  // namespace penumbra::session
