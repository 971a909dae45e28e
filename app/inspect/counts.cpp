// SPDX-License-Identifier: Apache-2.0
// Counts of defects by keys of the JSON, tables and CSV.

#include "app/inspect/counts.hpp"

#include "base/csv.hpp"
#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "base/utf8.hpp"
#include "session/inspect/report.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace penumbra::app {
namespace {

using mesh::Diagnosis;

struct NumberRow {
  const char* key;  ///< in JSON
  std::uint64_t Diagnosis::*number;
};
constexpr std::array<NumberRow, 3> kNumbers = {{{"boundaryLoops", &Diagnosis::boundary_loops},
                                                {"verticesLost", &Diagnosis::vertices_lost},
                                                {"trianglesLost", &Diagnosis::triangles_lost}}};
constexpr const char* kIntersections = "selfIntersections";

std::vector<std::string_view> keys_of_counts() {
  std::vector<std::string_view> keys;
  for (const session::DefectRow& row : session::kDefects) keys.emplace_back(row.key);
  keys.emplace_back(kIntersections);
  for (const NumberRow& row : kNumbers) keys.emplace_back(row.key);
  return keys;
}

/// Returns the name without hyphens, underscores and capitals.
std::string letters_of(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (c != '-' && c != '_') text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return text;
}

std::string text_of(const std::optional<std::uint64_t>& count, const char* none) {
  return count ? fmt::format("{}", *count) : none;
}

std::optional<std::uint64_t> non_manifold(const Diagnosis& d) {
  return d.non_manifold_edges.count + d.non_manifold_vertices.count;
}

}  // namespace

std::optional<std::uint64_t> count_of(const Diagnosis& diagnosis, std::string_view key) {
  for (const session::DefectRow& row : session::kDefects) {
    if (key == row.key) return (diagnosis.*row.counted).count;
  }
  for (const NumberRow& row : kNumbers) {
    if (key == row.key) return diagnosis.*row.number;
  }
  return diagnosis.self_intersections ? std::optional(diagnosis.self_intersections->count) : std::nullopt;
}

FailOn::FailOn(std::string_view names, bool searches_intersections) {
  const std::vector<std::string_view> known = keys_of_counts();
  while (!names.empty()) {
    const std::string_view name = names.substr(0, names.find(','));
    names.remove_prefix(std::min(name.size() + 1, names.size()));
    const std::string wanted = letters_of(name);
    const auto found = std::ranges::find(known, wanted, letters_of);
    if (wanted == "open") {
      open_ = true;
    } else if (wanted == "nonmanifold") {
      keys_.insert(keys_.end(), {"nonManifoldEdges", "nonManifoldVertices"});
    } else if (found != known.end()) {
      keys_.push_back(*found);
    } else {
      std::vector<std::string> all = {"open", "non-manifold"};
      all.insert(all.end(), known.begin(), known.end());
      throw UsageError("--fail-on {}: there is no such count; the counts are {}{}", name, fmt::join(all, ", "),
                       did_you_mean(std::string(name), all));
    }
    if (!searches_intersections && !keys_.empty() && keys_.back() == kIntersections)
      throw UsageError("--fail-on {}: they are not counted with --no-self-intersections", name);
  }
}

std::string FailOn::found_in(const session::FileReport& file) const {
  if (!file.error.empty()) return "";
  std::vector<std::string> found;
  const Diagnosis& total = file.total.diagnosis;
  if (open_ && !total.closed) found.emplace_back("not closed");
  for (const std::string_view key : keys_) {
    if (const auto count = count_of(total, key); count && *count > 0)
      found.push_back(fmt::format("{} {}", *count, key));
  }
  return fmt::format("{}", fmt::join(found, ", "));
}

WorstVerdict worst_verdict(const session::ObjectReport& object) {
  WorstVerdict worst;
  for (const session::MethodVerdict& said : object.verdicts) {
    if (said.verdict.verdict > worst.verdict) worst = {said.verdict.verdict, 0};
    if (said.verdict.verdict == worst.verdict) ++worst.methods;
  }
  return worst;
}

std::string summary_header() {
  return fmt::format("{:>10} {:>7} {:>9} {:>12} {:>17} {:>10}  {:<16} {}\n", "triangles", "closed", "boundary",
                     "non-manifold", "self-intersecting", "degenerate", "worst-verdict", "file");
}

std::string summary_row(const session::FileReport& file) {
  if (!file.error.empty())
    return fmt::format("{:>10} {:>7} {:>9} {:>12} {:>17} {:>10}  {:<16} {}\n", "-", "-", "-", "-", "-", "-",
                       "unreadable", on_one_line(file.error));
  const Diagnosis& d = file.total.diagnosis;
  const WorstVerdict worst = worst_verdict(file.total);
  return fmt::format("{:>10} {:>7} {:>9} {:>12} {:>17} {:>10}  {:<16} {}\n", d.triangles,
                     d.closed_as_wound ? "yes"
                     : d.closed        ? "turned"
                                       : "no",
                     d.boundary_edges.count, text_of(non_manifold(d), "-"), text_of(count_of(d, kIntersections), "-"),
                     d.zero_area_triangles.count, fmt::format("{}:{}", name_of(worst.verdict), worst.methods),
                     on_one_line(file.file.string()));
}

std::string report_csv(std::span<const session::FileReport> files) {
  std::string text = "file,triangles,vertices,components,closed,closedAsWound";
  const std::vector<std::string_view> keys = keys_of_counts();
  for (const std::string_view key : keys) text += fmt::format(",{}", key);
  text += ",volume,worstVerdict,error\r\n";
  for (const session::FileReport& file : files) {
    text += csv_field(as_utf8(file.file.string()));
    if (!file.error.empty()) {
      text += std::string(keys.size() + 7, ',') + ',' + csv_field(as_utf8(file.error)) + "\r\n";
      continue;
    }
    const Diagnosis& d = file.total.diagnosis;
    text += fmt::format(",{},{},{},{},{}", d.triangles, d.vertices, d.components, d.closed, d.closed_as_wound);
    for (const std::string_view key : keys) text += fmt::format(",{}", text_of(count_of(d, key), ""));
    text += fmt::format(",{},{},\r\n", d.volume, name_of(worst_verdict(file.total).verdict));
  }
  return text;
}

}  // namespace penumbra::app
