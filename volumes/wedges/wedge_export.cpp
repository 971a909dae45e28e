// SPDX-License-Identifier: Apache-2.0
// Writes wedges, light and violations as a mesh file for viewing.

#include "volumes/wedges/wedge_export.hpp"

#include "scenes/formats/parts_writer.hpp"
#include "volumes/wedges/wedge_body.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <set>

namespace penumbra::volumes {
namespace {

using scenes::Part;

constexpr std::size_t kMostNames = 1000;  // number of names of wedges; if there are more wedges, several share a name
const glm::dvec4 kSound{0.25, 0.5, 0.9, 0.35}, kWrong{0.9, 0.15, 0.1, 0.5};
const glm::dvec4 kEdge{0.05, 0.05, 0.05, 1}, kLight{1, 0.85, 0.3, 1}, kPoint{1, 0, 0.8, 1};

void add_body(Part& part, const WedgeBody& body) {
  const auto first = static_cast<std::uint32_t>(part.positions.size());
  part.positions.insert(part.positions.end(), body.corners.begin(), body.corners.end());
  for (const auto& [a, b, c] : body.triangles) part.triangles.push_back({first + a, first + b, first + c});
}

void add_edge(Part& part, const Wedge& wedge) {
  const auto first = static_cast<std::uint32_t>(part.positions.size());
  part.positions.insert(part.positions.end(), {wedge.a, wedge.b});
  part.lines.push_back({first, first + 1});
}

Part octahedron(std::string name, const glm::dvec3& center, double radius) {
  Part part{std::move(name), kPoint, {}, {}, {}};
  for (const double direction : {-radius, radius}) {
    for (const glm::dvec3& axis :
         {glm::dvec3(direction, 0, 0), glm::dvec3(0, direction, 0), glm::dvec3(0, 0, direction)}) {
      part.positions.push_back(center + axis);
    }
  }
  part.triangles = {{3, 4, 5}, {4, 0, 5}, {0, 1, 5}, {1, 3, 5}, {4, 3, 2}, {0, 4, 2}, {1, 0, 2}, {3, 1, 2}};
  return part;
}

/// Adds both parts of the wedges first … last: their bodies and their edges.
void add_wedges(std::vector<Part>& parts, const WedgesToExport& what, const std::set<std::uint32_t>& wrong,
                std::uint32_t first, std::uint32_t last) {
  const std::string numbers = first == last ? fmt::format(" {}", first) : fmt::format("s {} to {}", first, last);
  Part sound{"wedge" + numbers, kSound, {}, {}, {}}, bad{"wrong wedge" + numbers, kWrong, {}, {}, {}},
      edges{"edge" + numbers, kEdge, {}, {}, {}};
  for (std::uint32_t i = first; i <= last; ++i) {
    const Wedge& wedge = what.wedges[i];
    add_edge(edges, wedge);
    add_body(wrong.contains(i) ? bad : sound, wedge_body(wedge, what.box));
  }
  for (Part* part : {&sound, &bad, &edges}) parts.push_back(std::move(*part));
}

}  // namespace

void export_wedges(const std::filesystem::path& file, const WedgesToExport& what) {
  std::vector<Part> parts{{"light", kLight, what.light.corners, hull_triangles(what.light), {}}};
  std::set<std::uint32_t> wrong;
  for (const Violation& violation : what.violations) {
    if (violation.wedge) wrong.insert(*violation.wedge);
  }
  const std::size_t together = (what.wedges.size() + kMostNames - 1) / kMostNames;
  for (std::size_t i = 0; i < what.wedges.size(); i += together) {
    const std::size_t last = std::min(i + together, what.wedges.size()) - 1;
    add_wedges(parts, what, wrong, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(last));
  }
  const double radius = glm::length(what.box.upper - what.box.lower) / 200;
  for (std::size_t i = 0; i < std::min(what.violations.size(), kMostNames); ++i) {
    const Violation& violation = what.violations[i];
    const std::string of = violation.wedge ? fmt::format(" of wedge {}", *violation.wedge) : std::string();
    parts.push_back(octahedron(fmt::format("violation {}{}", i, of), violation.point, radius));
  }
  scenes::write_parts(file, parts, what.origin);
}

}  // namespace penumbra::volumes
