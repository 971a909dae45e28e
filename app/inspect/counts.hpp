// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/inspect/examine.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::app {

/// Defects named by `--fail-on`: counts of the JSON by their keys, and `open`.
class FailOn {
 public:
  FailOn() = default;
  /// Parses "boundaryEdges,nonManifoldEdges,open": keys of the JSON, `open` (not closed), `non-manifold` (edges and
  /// vertices). Capitals and hyphens are ignored. Throws UsageError for other names, and for `selfIntersections` if
  /// they are not searched.
  FailOn(std::string_view names, bool searches_intersections);

  /// Returns the listed defects found in a file, in words: "not closed, 3 boundaryEdges". Empty: none.
  [[nodiscard]] std::string found_in(const session::FileReport& file) const;

 private:
  std::vector<std::string_view> keys_;
  bool open_ = false;
};

/// Returns the count of a key of the JSON; nullopt if not searched.
std::optional<std::uint64_t> count_of(const mesh::Diagnosis& diagnosis, std::string_view key);

/// Worst verdict of a method on a mesh, and the number of methods with this verdict.
struct WorstVerdict {
  visibility::Verdict verdict = visibility::Verdict::exact;
  std::size_t methods = 0;
};
WorstVerdict worst_verdict(const session::ObjectReport& object);

/// Return the table of several files: its first line, and the row of a file. Columns have fixed widths and contain no
/// blanks; the file's name is last.
std::string summary_header();
std::string summary_row(const session::FileReport& file);

/// Returns all files as CSV (RFC 4180): one row for each file, with the keys of the JSON as names of columns.
std::string report_csv(std::span<const session::FileReport> files);

}  // namespace penumbra::app
