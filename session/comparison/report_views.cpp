// SPDX-License-Identifier: Apache-2.0
// Prepares packed numbers for the report.

#include "session/comparison/report_views.hpp"

#include "compare/report_data.hpp"
#include "session/whole_lights.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace penumbra::session {
namespace {

/// Light samples of a dome as seen from below, in the unit disk with equal areas for equal solid angles: `up` is in the
/// middle, straight down (for half a dome, the horizon) at the rim.
std::vector<glm::dvec2> seen_upward(const visibility::Light& light) {
  const std::array<glm::vec3, 3>& axes = light.dome->axes;
  std::vector<glm::dvec2> places;
  for (const glm::vec3& point : light.points) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(point));
    const glm::dvec2 around(glm::dot(d, glm::dvec3(axes[0])), glm::dot(d, glm::dvec3(axes[1])));
    const double height = std::clamp(glm::dot(d, glm::dvec3(axes[2])), -1.0, 1.0);
    const double radius = std::sqrt((1 - height) / (light.dome->half ? 1 : 2)), flat = glm::length(around);
    places.push_back(flat > 0 ? radius / flat * glm::dvec2(around.x, -around.y) : glm::dvec2(radius, 0));
  }
  return places;
}

}  // namespace

void PackedMasks::add(const TileResult& tile) {
  if (tile.masks.empty()) return;
  One& light = lights_[tile.light];
  if (!light.deflated) light.deflated.emplace();
  light.bytes += tile.masks.size_bytes();
  if (light.bytes <= kMostBytes) light.deflated->add(std::as_bytes(tile.masks));
}

std::vector<std::string> PackedMasks::finish() {
  std::vector<std::string> packed;
  for (One& light : lights_) {
    std::string& text = packed.emplace_back();
    if (!light.deflated || light.bytes > kMostBytes) continue;
    const std::vector<std::byte> bytes = light.deflated->finish();
    if (bytes.size() <= kMostPackedBytes) text = base64(bytes);
  }
  return packed;
}

std::vector<compare::ReportLight> report_lights(const Session& session, std::span<const visibility::Light> reference,
                                                bool same_samples) {
  std::vector<compare::ReportLight> lights;
  for (const WholeLight& whole : whole_lights(session.lights)) {
    const visibility::Light& light = session.lights[whole.first];
    compare::ReportLight& shown = lights.emplace_back();
    shown.name = light.name;
    const std::vector<visibility::PixelClass> classes = whole_classes(whole, session.classes);
    shown.packed_classes = compare::pack_bytes(std::as_bytes(std::span(classes)));
    if (whole.count > 1) continue;  // many samples of many shapes: not drawn
    if (light.dome) {
      shown.round = true;
      shown.samples = seen_upward(light);
      if (!same_samples) shown.reference_samples = seen_upward(reference[whole.first]);
      continue;
    }
    shown.round = is_round(light.kind);
    if (!is_circle(light.kind) && !is_polygon(light.kind)) {  // rectangle or ellipse: two lengths
      const visibility::LightFrame frame = visibility::light_frame(light);
      shown.aspect = glm::length(frame.u) / glm::length(frame.v);
    }
    shown.samples = light.coordinates;
    if (!same_samples) shown.reference_samples = reference[whole.first].coordinates;
  }
  return lights;
}

compare::ReportEntry report_entry(const Session& session, const visibility::MethodDescription& description,
                                  SeenByRun seen) {
  compare::ReportEntry entry;
  entry.description = description;
  if (!seen.beauty.empty()) {
    entry.packed_beauty = seen.reference_beauty.empty()
                              ? compare::pack_radiance(session.width, seen.beauty)
                              : compare::pack_radiance_over(seen.reference_beauty, seen.beauty);
  }
  const std::vector<WholeLight> wholes = whole_lights(session.lights);
  for (std::size_t light = 0; light < seen.run.visibility.size(); ++light) {
    compare::ReportLightView& view = entry.lights.emplace_back();
    view.packed_visibility = compare::pack_floats(seen.run.visibility[light]);
    if (wholes[light].count == 1) view.packed_masks = std::move(seen.masks[wholes[light].first]);
  }
  return entry;
}

}  // namespace penumbra::session
