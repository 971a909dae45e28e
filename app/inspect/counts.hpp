#pragma once

#include "app/inspect/examine.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::app {

/// The defects that `--fail-on` names: counts of the JSON by their keys, and `open`.
class FailOn {
 public:
  FailOn() = default;
  /// "boundaryEdges,nonManifoldEdges,open": keys of the JSON, `open` (not closed), `non-manifold` (edges and vertices).
  /// Capitals and hyphens make no difference. Throws UsageError for other names, and for `selfIntersections` where they
  /// are not searched.
  FailOn(std::string_view names, bool searches_intersections);

  /// The defects of that list that a file has, in words: "not closed, 3 boundaryEdges". Empty: nothing.
  [[nodiscard]] std::string found_in(const FileReport& file) const;

 private:
  std::vector<std::string_view> keys_;
  bool open_ = false;
};

/// The count of a key of the JSON; empty where it was not searched.
std::optional<std::uint64_t> count_of(const mesh::Diagnosis& diagnosis, std::string_view key);

/// The worst that a method says of a mesh, and how many methods say it.
struct WorstVerdict {
  visibility::Verdict verdict = visibility::Verdict::exact;
  std::size_t methods = 0;
};
WorstVerdict worst_verdict(const ObjectReport& object);

/// The table of several files: its first line, and a row of a file. Columns have fixed widths and no blanks in them;
/// the file's name is the last one.
std::string summary_header();
std::string summary_row(const FileReport& file);

/// All files as CSV (RFC 4180): a row a file, with the keys of the JSON as names of columns.
std::string report_csv(std::span<const FileReport> files);

}  // namespace penumbra::app
