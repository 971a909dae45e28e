// SPDX-License-Identifier: Apache-2.0
// The JSON of `inspect`: counts and places of each defect, in the numbers of the scene and of the file.

#include "session/inspect/report.hpp"

#include "base/utf8.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::session {
namespace {

using nlohmann::ordered_json;

ordered_json vector_json(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// Returns the locations of a defect with the triangles' indices in this file, and the file's faces from which they
/// came.
ordered_json places_json(const mesh::Defect& defect, const FileReport& file, const ObjectReport& object,
                         std::size_t list_limit) {
  auto places = ordered_json::array();
  for (std::size_t i = 0; i < std::min(defect.first.size(), list_limit); ++i) {
    auto points = ordered_json::array(), triangles = ordered_json::array(), faces = ordered_json::array();
    for (const glm::dvec3& point : defect.first[i].points) points.push_back(vector_json(point));
    for (const std::uint32_t triangle : defect.first[i].triangles) {
      const std::uint32_t number = object.triangles.empty() ? triangle : object.triangles[triangle];
      triangles.push_back(number);
      faces.push_back(file.source_face[number]);
    }
    places.push_back({{"points", points}, {"triangles", triangles}, {"faces", faces}});
  }
  return places;
}

ordered_json object_json(const FileReport& file, const ObjectReport& object, std::size_t list_limit) {
  const mesh::Diagnosis& d = object.diagnosis;
  ordered_json json = {{"triangles", d.triangles},           {"vertices", d.vertices},
                       {"components", d.components},         {"closed", d.closed},
                       {"closedAsWound", d.closed_as_wound}, {"boundaryLoops", d.boundary_loops}};
  ordered_json lists;
  for (const DefectRow& row : kDefects) {
    json[row.key] = (d.*row.counted).count;
    lists[row.key] = places_json(d.*row.counted, file, object, list_limit);
  }
  json["selfIntersections"] = nullptr;
  lists["selfIntersections"] = nullptr;
  if (d.self_intersections) {
    json["selfIntersections"] = d.self_intersections->count;
    lists["selfIntersections"] = places_json(*d.self_intersections, file, object, list_limit);
  }
  json["volume"] = d.volume;
  json["bounds"] = {vector_json(d.lower), vector_json(d.upper)};
  json["largestCoordinate"] = d.largest_coordinate;
  json["floatSpacing"] = d.float_spacing;
  json["shortestEdge"] = d.shortest_edge;
  json["verticesLost"] = d.vertices_lost;
  json["trianglesLost"] = d.triangles_lost;
  json["silhouette"] = nullptr;
  if (object.silhouettes) {
    json["silhouette"] = {{"meanEdges", object.silhouettes->mean},
                          {"mostEdges", object.silhouettes->most},
                          {"trianglesToThe0.8", std::pow(static_cast<double>(d.triangles), 0.8)}};
  }
  for (const MethodVerdict& said : object.verdicts) {
    json["verdicts"][said.method] = name_of(said.verdict.verdict);
    json["reasons"][said.method] = said.verdict.reason;
  }
  json["lists"] = lists;
  return json;
}

ordered_json file_json(const FileReport& file, std::size_t list_limit) {
  if (!file.error.empty()) return {{"file", as_utf8(file.file.string())}, {"error", as_utf8(file.error)}};
  auto objects = ordered_json::array();
  for (const ObjectReport& object : file.objects) {
    ordered_json json = {{"name", object.name}};
    json.update(object_json(file, object, list_limit));
    objects.push_back(std::move(json));
  }
  ordered_json json = {{"file", as_utf8(file.file.string())},
                       {"notes", file.notes},
                       {"objects", objects},
                       {"total", object_json(file, file.total, list_limit)}};
  if (file.scene) json["scene"] = facts_json(*file.scene);
  return json;
}

ordered_json repair_json(const RepairReport& repaired) {
  auto done = ordered_json::array();
  for (const mesh::RepairStep& step : repaired.done) done.push_back({{"what", step.what}, {"count", step.count}});
  ordered_json counts = {{"closed", repaired.written.closed}, {"closedAsWound", repaired.written.closed_as_wound}};
  for (const DefectRow& row : kDefects) counts[row.key] = (repaired.written.*row.counted).count;
  counts["selfIntersections"] = nullptr;
  if (repaired.written.self_intersections) counts["selfIntersections"] = repaired.written.self_intersections->count;
  return {{"file", as_utf8(repaired.file.string())},
          {"triangles", repaired.triangles},
          {"done", done},
          {"left", repaired.left},
          {"readAgain", counts}};
}

}  // namespace

ordered_json report_json(const FileReport& file, const std::optional<RepairReport>& repaired, std::size_t list_limit) {
  ordered_json json = file_json(file, list_limit);
  auto all = ordered_json::array({json});
  if (json.contains("total")) json.update(ordered_json(json["total"]));
  if (repaired) json["repair"] = repair_json(*repaired);
  json["files"] = std::move(all);
  return json;
}

ordered_json report_json(std::span<const FileReport> files, std::size_t list_limit) {
  auto all = ordered_json::array();
  for (const FileReport& file : files) all.push_back(file_json(file, list_limit));
  return all;
}

}  // namespace penumbra::session
