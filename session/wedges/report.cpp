// SPDX-License-Identifier: Apache-2.0
// Writes the results of `wedges` as JSON and as text.

#include "session/wedges/report.hpp"

#include "base/atomic_file.hpp"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>

namespace penumbra::session {
namespace {

using nlohmann::ordered_json;
using volumes::Violation;
using volumes::Wedge;
using volumes::WedgeOutcome;

constexpr std::size_t kShown = 10;  // number of violations printed one by one

ordered_json array_of(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

ordered_json array_of(const volumes::Plane& plane) {
  return {plane.a, plane.b, plane.c, plane.d};  // values that are not finite become null
}

ordered_json light_json(const WedgesResult& result) {
  ordered_json corners = ordered_json::array();
  for (const glm::dvec3& corner : result.hull.corners) corners.push_back(array_of(corner));
  return {{"name", result.light.name},
          {"kind", visibility::name_of(result.light.kind)},
          {"center", array_of(result.hull.center)},
          {"corners", corners},
          {"slack", result.hull.slack}};
}

std::array<std::size_t, 4> counts_of(std::span<const Wedge> wedges) {
  std::array<std::size_t, 4> counts{};
  for (const Wedge& wedge : wedges) ++counts[static_cast<std::size_t>(wedge.outcome)];
  return counts;
}

ordered_json wedge_json(const Wedge& wedge) {
  ordered_json entry{{"edge", {array_of(wedge.a), array_of(wedge.b)}}, {"outcome", name_of(wedge.outcome)}};
  if (wedge.parent) entry["parent"] = *wedge.parent;
  entry["planes"] = ordered_json::array();
  for (const volumes::Plane& plane : wedge.planes) entry["planes"].push_back(array_of(plane));
  return entry;
}

ordered_json violation_json(const Violation& violation, std::span<const Wedge> wedges) {
  ordered_json entry;
  entry["wedge"] = violation.wedge ? ordered_json(*violation.wedge) : ordered_json();
  entry["invariant"] = name_of(violation.invariant);
  entry["plane"] =
      violation.wedge && violation.plane ? array_of(wedges[*violation.wedge].planes[*violation.plane]) : ordered_json();
  entry["point"] = array_of(violation.point);
  entry["distance"] = violation.distance;
  entry["what"] = violation.what;
  return entry;
}

ordered_json tightness_json(const volumes::Tightness& tightness) {
  ordered_json entry;
  const auto quantile = [&](double share) {
    const auto value = volumes::quantile(tightness.ratios, share);
    return value ? ordered_json(*value) : ordered_json();
  };
  entry["crossSections"] = tightness.ratios.size();
  entry["min"] = quantile(0);
  entry["median"] = quantile(0.5);
  entry["p99"] = quantile(0.99);
  entry["max"] = quantile(1);
  entry["unbounded"] = tightness.unbounded;
  entry["notMeasured"] = tightness.not_measured;
  return entry;
}

/// Figures of the samples that were checked.
struct CoverageFigures {
  std::uint64_t samples = 0, touching = 0, single = 0;
  double worst_layers = 0, worst_union = 0;  ///< the latter over single layers
  double center_mean = 0, center_max = 0;    ///< |blocked by the centre's silhouettes − the receiver's|
};

CoverageFigures figures_of(const CoverageOutcome& coverage) {
  CoverageFigures figures;
  for (std::size_t i = 0; i < coverage.points.size(); ++i) {
    const volumes::CoveragePoint& point = coverage.points[i];
    if (point.touches_light) {
      ++figures.touching;
      continue;
    }
    ++figures.samples;
    figures.worst_layers = std::max(figures.worst_layers, std::abs(point.receiver - point.layers));
    if (point.is_single_layer()) {
      ++figures.single;
      if (!coverage.hidden.empty()) {
        figures.worst_union = std::max(figures.worst_union, std::abs(point.receiver - coverage.hidden[i]));
      }
    }
    figures.center_mean += std::abs(point.center - point.receiver);
    figures.center_max = std::max(figures.center_max, std::abs(point.center - point.receiver));
  }
  if (figures.samples > 0) figures.center_mean /= static_cast<double>(figures.samples);
  return figures;
}

ordered_json coverage_json(const CoverageOutcome& coverage) {
  const CoverageFigures figures = figures_of(coverage);
  ordered_json entry{{"samples", figures.samples},
                     {"touchingLight", figures.touching},
                     {"textured", coverage.textured},
                     {"singleLayer", figures.single},
                     {"maxAgainstTriangles", figures.worst_layers}};
  entry["maxAgainstExact"] = coverage.hidden.empty() ? ordered_json() : ordered_json(figures.worst_union);
  entry["centreDifference"] = {{"mean", figures.center_mean}, {"max", figures.center_max}};
  return entry;
}

void print_coverage(const CoverageOutcome& coverage) {
  const CoverageFigures figures = figures_of(coverage);
  if (figures.touching > 0) {
    fmt::print("coverage: not checked at {} view samples, where a caster touches the light\n", figures.touching);
    return;
  }
  if (coverage.textured) fmt::print("coverage is weighted by the light's texture\n");
  fmt::print("coverage at {} view samples: the receiver's silhouettes are {:.1e} from the triangles at most\n",
             figures.samples, figures.worst_layers);
  if (figures.single > 0 && !coverage.hidden.empty()) {
    fmt::print("{} of them have a single layer: {:.1e} from the exact area at most\n", figures.single,
               figures.worst_union);
  }
  fmt::print("centre silhouettes differ by {:.4f} in the mean, {:.4f} at most\n", figures.center_mean,
             figures.center_max);
}

std::string text_of(const glm::dvec3& v) {
  return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

void print_violation(const Violation& violation, std::span<const Wedge> wedges) {
  std::string text = fmt::format("{}: {}", name_of(violation.invariant), violation.what);
  if (violation.wedge) {
    const Wedge& wedge = wedges[*violation.wedge];
    text = fmt::format("wedge {}, edge {} {}: {}", *violation.wedge, text_of(wedge.a), text_of(wedge.b), text);
    if (violation.plane) {
      const volumes::Plane& plane = wedge.planes[*violation.plane];
      text += fmt::format("; plane {} ({}, {}, {}, {})", *violation.plane, plane.a, plane.b, plane.c, plane.d);
    }
  }
  fmt::print("{}; point {}; by {}\n", text, text_of(violation.point), violation.distance);
}

void print_tightness(const volumes::Tightness& tightness) {
  if (tightness.ratios.empty()) return;
  const auto quantile = [&](double share) { return *volumes::quantile(tightness.ratios, share); };
  fmt::print(
      "cross-section / penumbra's: min {:.4f}, median {:.4f}, p99 {:.4f}, max {:.4f} of {}; {} unbounded, {} without "
      "area\n",
      quantile(0), quantile(0.5), quantile(0.99), quantile(1), tightness.ratios.size(), tightness.unbounded,
      tightness.not_measured);
}

void print_validation(const volumes::ValidationReport& report, std::span<const Wedge> wedges) {
  for (std::size_t i = 0; i < volumes::kInvariants; ++i) {
    const auto invariant = static_cast<volumes::Invariant>(i);
    const auto failed = std::ranges::count(report.violations, invariant, &Violation::invariant);
    fmt::print("{:<14} {:>10} checks, {} violations\n", name_of(invariant), report.checks[i], failed);
  }
  fmt::print("{} planes proved as crops; {} wedges touch the scene's box only\n", report.cropped_planes, report.flat);
  for (std::size_t i = 0; i < std::min(kShown, report.violations.size()); ++i) {
    print_violation(report.violations[i], wedges);
  }
  if (report.violations.size() > kShown) fmt::print("… and {} more\n", report.violations.size() - kShown);
}

}  // namespace

std::string wedges_json(const WedgesResult& result) {
  // The list may be long: each entry is converted to text before the next is made.
  fmt::memory_buffer text;
  const auto put = [&](const std::string& piece) { text.append(piece.data(), piece.data() + piece.size()); };
  const ordered_json head{{"light", light_json(result)}, {"origin", array_of(result.origin)}};
  const std::string opening = head.dump();
  put(opening.substr(0, opening.size() - 1));
  put(fmt::format(",\"construction\":\"{}\",\"from\":\"{}\",\n\"wedges\":[", result.construction, result.from));
  for (std::size_t i = 0; i < result.wedges.size(); ++i) {
    put((i == 0 ? "\n" : ",\n") + wedge_json(result.wedges[i]).dump());
  }
  put("],\n\"violations\":[");
  if (result.validation != nullptr) {
    for (std::size_t i = 0; i < result.validation->violations.size(); ++i) {
      put((i == 0 ? "\n" : ",\n") + violation_json(result.validation->violations[i], result.wedges).dump());
    }
  }
  const auto [wedges, split, everywhere, empty] = counts_of(result.wedges);
  put(fmt::format("],\n\"counts\":{{\"wedge\":{},\"split\":{},\"everywhere\":{},\"empty\":{}}}", wedges, split,
                  everywhere, empty));
  if (result.validation != nullptr) {
    ordered_json checks;
    for (std::size_t i = 0; i < volumes::kInvariants; ++i) {
      checks[name_of(static_cast<volumes::Invariant>(i))] = result.validation->checks[i];
    }
    put(",\n\"checks\":" + checks.dump());
  }
  if (result.tightness != nullptr) put(",\n\"tightness\":" + tightness_json(*result.tightness).dump());
  if (result.coverage != nullptr) put(",\n\"coverage\":" + coverage_json(*result.coverage).dump());
  if (result.explanation != nullptr) put(",\n\"explain\":" + explain_json(*result.explanation, result.svg).dump());
  put("}\n");
  return fmt::to_string(text);
}

void print_wedges(const WedgesResult& result) {
  const auto [wedges, split, everywhere, empty] = counts_of(result.wedges);
  std::size_t planes = 0;
  for (const Wedge& wedge : result.wedges) planes += wedge.planes.size();
  const auto roots = std::ranges::count_if(result.wedges, [](const Wedge& wedge) { return !wedge.parent; });
  fmt::print("light {}: {}, {} corners, slack {:g}\n", result.light.name, visibility::name_of(result.light.kind),
             result.hull.corners.size(), result.hull.slack);
  fmt::print("{}, from {}: {} edges; {} wedges, {:.2f} planes each; {} split, {} everywhere, {} empty\n",
             result.construction, result.from, roots, wedges,
             wedges == 0 ? 0.0 : static_cast<double>(planes) / static_cast<double>(wedges), split, everywhere, empty);
  if (result.tightness != nullptr) print_tightness(*result.tightness);
  if (result.explanation != nullptr) print_explanation(*result.explanation, result.svg);
  if (result.coverage != nullptr) print_coverage(*result.coverage);
  if (result.validation != nullptr) print_validation(*result.validation, result.wedges);
}

}  // namespace penumbra::session
