// SPDX-License-Identifier: Apache-2.0
// Formats reports of `inspect` as tables.

#include "session/inspect/report.hpp"

#include "base/utf8.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace penumbra::session {
namespace {

constexpr std::size_t kLabelWidth = 22, kNumberWidth = 14, kLineWidth = 100;

/// 1234567 → "1,234,567".
std::string grouped(std::uint64_t number) {
  std::string text = fmt::format("{}", number);
  for (std::size_t i = text.size(); i > 3;) text.insert(i -= 3, ",");
  return text;
}

/// Returns the number as text, or "overflow": for coordinates near the end of double's range some results are infinite.
std::string figure(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "overflow";
}

std::string point_text(const glm::dvec3& p) {
  return fmt::format("({:.7g}, {:.7g}, {:.7g})", p.x, p.y, p.z);
}

/// Breaks a text at blanks into lines that begin at column `indent`.
std::string wrapped(std::string_view text, std::size_t indent) {
  std::string result;
  std::size_t column = indent;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    if (column > indent && column + 1 + end > kLineWidth) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      result += ' ';
      ++column;
    }
    result += text.substr(0, end);
    column += end;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

std::string row(std::string_view label, std::string_view value, std::string_view remark = {}) {
  std::string line = fmt::format("  {:<{}}{:>{}}", label, kLabelWidth, value, kNumberWidth);
  if (!remark.empty()) line += fmt::format("   {}", remark);
  return line + '\n';
}

std::string place_line(const mesh::DefectPlace& place, const ObjectReport& object) {
  std::string line = "      at";
  // for two triangles one corner is sufficient
  const std::size_t points = place.points.size() > 3 ? 1 : place.points.size();
  for (std::size_t i = 0; i < points; ++i) line += (i == 0 ? " " : " – ") + point_text(place.points[i]);
  line += place.triangles.size() == 1 ? ": triangle" : ": triangles";
  constexpr std::size_t kMost = 6;
  for (std::size_t i = 0; i < std::min(place.triangles.size(), kMost); ++i) {
    const std::uint32_t number = place.triangles[i];
    line += fmt::format(" {}", object.triangles.empty() ? number : object.triangles[number]);
  }
  return line + (place.triangles.size() > kMost ? " …\n" : "\n");
}

std::string defect_rows(std::string_view label, const mesh::Defect& defect, const ObjectReport& object,
                        std::size_t list_limit, std::string_view remark = {}) {
  std::string text = row(label, grouped(defect.count), remark);
  const std::size_t shown = std::min(defect.first.size(), list_limit);
  for (std::size_t i = 0; i < shown; ++i) text += place_line(defect.first[i], object);
  return text;
}

std::string watertight(const mesh::Diagnosis& d) {
  return d.closed_as_wound ? "yes" : d.closed ? "if turned" : "no";
}

std::string_view watertight_remark(const mesh::Diagnosis& d) {
  if (d.closed_as_wound) return "every point has an integer winding number: it is inside or outside";
  return d.closed ? "closed once neighbours' windings agree; as it is wound now it is not" : "";
}

std::string all_rows(const ObjectReport& object, std::size_t list_limit) {
  const mesh::Diagnosis& d = object.diagnosis;
  std::string text = row("triangles", grouped(d.triangles)) + row("vertices", grouped(d.vertices)) +
                     row("components", grouped(d.components)) + row("watertight", watertight(d), watertight_remark(d));
  for (const DefectRow& defect : kDefects) {
    const bool boundary = defect.counted == &mesh::Diagnosis::boundary_edges && d.boundary_loops > 0;
    text += defect_rows(defect.label, d.*defect.counted, object, list_limit,
                        boundary ? fmt::format("loops: {}", grouped(d.boundary_loops)) : "");
  }
  text += d.self_intersections
              ? defect_rows("self-intersections", *d.self_intersections, object, list_limit, "pairs of triangles")
              : row("self-intersections", "not searched");
  text += row("volume", figure(d.volume, 7), d.closed_as_wound ? "" : "signed; of an open mesh: no volume");
  text += row("bounds", "", fmt::format("{} … {}", point_text(d.lower), point_text(d.upper)));
  text += row("float spacing", figure(d.float_spacing, 3),
              fmt::format("largest coordinate {}, shortest edge {}", figure(d.largest_coordinate, 7),
                          figure(d.shortest_edge, 3)));
  if (d.vertices_lost + d.triangles_lost > 0) {
    text +=
        row("lost in float", grouped(d.vertices_lost),
            fmt::format("vertices become equal to others; {} triangles lose their area", grouped(d.triangles_lost)));
  }
  if (object.silhouettes) {
    text += row("silhouette edges", fmt::format("{:.0f}", object.silhouettes->mean),
                fmt::format("on average from 8 sides, at most {}; n^0.8 = {:.0f}", grouped(object.silhouettes->most),
                            std::pow(static_cast<double>(d.triangles), 0.8)));
  }
  return text;
}

/// Returns "12 boundary edges, 3 needles", or "nothing".
std::string what_is_wrong(const mesh::Diagnosis& d) {
  std::string text;
  const auto add = [&](std::uint64_t count, const char* label) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", grouped(count), label);
  };
  for (const DefectRow& defect : kDefects) add((d.*defect.counted).count, defect.label);
  if (d.self_intersections) add(d.self_intersections->count, "self-intersections");
  return text.empty() ? "nothing" : text;
}

std::string object_rows(const FileReport& file) {
  std::size_t width = std::string_view("object").size();
  for (const ObjectReport& object : file.objects) width = std::max(width, object.name.size());
  width = std::min<std::size_t>(width, 40);
  std::string text =
      fmt::format("  {:<{}}  {:>12}  {:<10}  what is wrong\n", "object", width, "triangles", "watertight");
  for (const ObjectReport& object : file.objects) {
    text += fmt::format("  {:<{}}  {:>12}  {:<10}  {}\n", object.name, width, grouped(object.diagnosis.triangles),
                        watertight(object.diagnosis), wrapped(what_is_wrong(object.diagnosis), width + 30));
  }
  return text + "  all together:\n";
}

/// Returns "7 exact, 31 approximate".
std::string verdict_counts(const std::vector<MethodVerdict>& verdicts) {
  using visibility::Verdict;
  std::string text;
  for (const Verdict verdict : {Verdict::exact, Verdict::conservative, Verdict::approximate, Verdict::refused}) {
    const auto count =
        std::ranges::count_if(verdicts, [&](const MethodVerdict& said) { return said.verdict.verdict == verdict; });
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name_of(verdict));
  }
  return text;
}

std::string method_rows(const std::vector<MethodVerdict>& verdicts) {
  std::string text = "  each method's verdict on it\n";
  std::size_t width = 0;
  for (const MethodVerdict& said : verdicts) width = std::max(width, said.method.size());
  for (const MethodVerdict& said : verdicts) {
    text += fmt::format("    {:<{}}  {:<12}  {}\n", said.method, width, name_of(said.verdict.verdict),
                        wrapped(said.verdict.reason, width + 20));
  }
  return text;
}

}  // namespace

std::string report_table(const FileReport& file, const TableOptions& options) {
  std::string text = fmt::format("{}\n", on_one_line(file.file.string()));
  for (const std::string& note : file.notes) text += fmt::format("  note: {}\n", wrapped(note, 8));
  if (file.scene) text += facts_table(*file.scene);
  if (file.objects.size() > 1) text += object_rows(file);
  text += all_rows(file.total, options.list_limit);
  if (options.methods) return text + method_rows(file.total.verdicts);
  return text + fmt::format("  {:<{}}{}   --methods says why\n", "methods", kLabelWidth + 2,
                            verdict_counts(file.total.verdicts));
}

std::string report_table(const RepairReport& repaired) {
  std::string text =
      fmt::format("{}: {} triangles\n", on_one_line(repaired.file.string()), grouped(repaired.triangles));
  for (const mesh::RepairStep& step : repaired.done) text += fmt::format("  done: {}\n", wrapped(step.what, 8));
  if (repaired.done.empty()) text += "  done: nothing needed repair\n";
  for (const std::string& what : repaired.left) text += fmt::format("  left: {}\n", wrapped(what, 8));
  return text + fmt::format("  read again: watertight {}; what is wrong: {}\n", watertight(repaired.written),
                            wrapped(what_is_wrong(repaired.written), 14));
}

}  // namespace penumbra::session
