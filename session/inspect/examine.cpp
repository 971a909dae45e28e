// SPDX-License-Identifier: Apache-2.0
// Reads meshes and scenes and diagnoses their objects.

#include "session/inspect/examine.hpp"

#include "base/assert.hpp"
#include "mesh/import.hpp"
#include "mesh/silhouettes.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/formats/reader.hpp"
#include "session/methods.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace penumbra::session {
namespace {

constexpr std::uint32_t kUnusedPosition = std::numeric_limits<std::uint32_t>::max();
/// Memory for each triangle, in addition to the scene: measured on a sphere of a million triangles, and rounded down.
constexpr std::uint64_t kBytesPerTriangle = 200;

InspectedMesh read_scene(const std::filesystem::path& file, bool allow_outside, const std::function<void()>* step) {
  scenes::Scene scene = scenes::read_scene(
      file, {.allow_outside = allow_outside, .needs_light = false, .bytes_per_copy = kBytesPerTriangle, .step = step});
  InspectedMesh mesh;
  mesh.scene = facts_of(scene);
  mesh.soup = std::move(scene.soup);
  for (const scenes::Object& object : scene.objects) mesh.objects.push_back(object.name);
  mesh.notes = std::move(scene.warnings);
  mesh.sources = std::move(scene.sources);
  for (const scenes::AreaLight& light : scene.lights) {
    for (const scenes::LightKind kind : scenes::kinds_of(light.shape).list()) mesh.lights.push_back({light.name, kind});
  }
  return mesh;
}

std::optional<SilhouetteCounts> count_silhouettes(const mesh::MeshView& mesh, const mesh::Diagnosis& diagnosis,
                                                  double weld) {
  const glm::dvec3 extent = diagnosis.upper - diagnosis.lower;
  const glm::dvec3 center = diagnosis.lower + 0.5 * extent;
  const double reach = std::hypot(extent.x, extent.y, extent.z) / std::sqrt(3.0);
  const mesh::EdgeGraph graph = mesh::build_edge_graph(mesh, weld);
  SilhouetteCounts counts;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::dvec3 toward(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const glm::dvec3 p = center + reach * toward;
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return std::nullopt;
    const std::uint64_t count = mesh::silhouette_edges(mesh, graph, p).size();
    counts.mean += static_cast<double>(count) / 8;
    counts.most = std::max(counts.most, count);
  }
  return counts;
}

std::vector<MethodVerdict> verdicts_on(const mesh::Diagnosis& diagnosis, const InspectedMesh& mesh) {
  std::vector<MethodVerdict> verdicts;
  for (const visibility::MethodDescription* method : all_methods()) {
    PENUMBRA_ASSERT(method->verdict_on != nullptr, "method {} has no verdict on meshes", method->name);
    visibility::MeshVerdict verdict = method->verdict_on(diagnosis);
    if (diagnosis.largest_coordinate > scenes::kLargestCoordinate) {
      verdict = {visibility::Verdict::refused,
                 fmt::format("scenes hold coordinates up to {:g}; scale it down", scenes::kLargestCoordinate)};
    }
    const std::string through = !mesh.scene ? "" : method->draws_holes ? mesh.scene->dimmer : mesh.scene->filter;
    if (!through.empty() && method->output != visibility::Output::mask) {
      verdict = {visibility::Verdict::refused,
                 fmt::format("light passes through \"{}\", which needs a decision for each light sample", through)};
    }
    for (const InspectedMesh::Light& light : mesh.lights) {
      if (method->lights.contains(light.kind)) continue;
      verdict = {visibility::Verdict::refused,
                 fmt::format("it does not support the scene's light \"{}\", a {}", light.name, name_of(light.kind))};
      break;
    }
    verdicts.push_back({method->name, std::move(verdict)});
  }
  return verdicts;
}

ObjectReport examine_part(std::string name, const mesh::TriangleSoup& soup, const InspectedMesh& mesh,
                          mesh::DiagnosisOptions options, Progress& progress) {
  constexpr std::uint64_t kSteps = 1000;
  progress.begin(fmt::format("{}: looking for defects", name), kSteps);
  std::uint64_t done = 0;
  options.progress = [&](double share) {
    const auto reached = static_cast<std::uint64_t>(share * kSteps);
    if (reached > done) progress.advance(reached - std::exchange(done, reached));
  };
  const mesh::MeshView view{soup.positions, soup.triangles};
  ObjectReport report;
  report.name = std::move(name);
  report.diagnosis = mesh::diagnose(view, options);
  report.silhouettes = count_silhouettes(view, report.diagnosis, options.weld);
  report.verdicts = verdicts_on(report.diagnosis, mesh);
  return report;
}

}  // namespace

ObjectParts::ObjectParts(const mesh::TriangleSoup& soup, std::size_t objects)
    : soup_(soup), triangles_(objects), new_index_(soup.positions.size(), kUnusedPosition) {
  for (std::uint32_t i = 0; i < soup.triangles.size(); ++i) triangles_[soup.object[i]].push_back(i);
}

mesh::TriangleSoup ObjectParts::soup_of(std::size_t object) {
  mesh::TriangleSoup part;
  std::vector<std::uint32_t> touched;
  for (const std::uint32_t number : triangles_[object]) {
    mesh::Triangle triangle = soup_.triangles[number];
    for (std::uint32_t& corner : triangle) {
      std::uint32_t& index = new_index_[corner];
      if (index == kUnusedPosition) {
        index = static_cast<std::uint32_t>(part.positions.size());
        part.positions.push_back(soup_.positions[corner]);
        touched.push_back(corner);
      }
      corner = index;
    }
    part.triangles.push_back(triangle);
  }
  for (const std::uint32_t corner : touched) new_index_[corner] = kUnusedPosition;  // reset for the next object
  return part;
}

InspectedMesh read_inspected(const std::filesystem::path& file, bool allow_outside, const std::function<void()>* step) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  InspectedMesh mesh;
  if (extension == ".json" || extension == ".gltf" || extension == ".glb") {
    mesh = read_scene(file, allow_outside, step);
  } else {
    mesh::ImportedMesh imported = mesh::import_mesh(file, {.step = step});
    mesh.soup = std::move(imported.soup);
    mesh.notes = std::move(imported.notes);
    mesh.objects = {file.filename().string()};
  }
  mesh.sources.push_back(file);
  return mesh;
}

scenes::Scene scene_of(const mesh::TriangleSoup& soup, const std::string& name) {
  scenes::Scene scene;
  scene.name = name;
  scene.soup.positions = soup.positions;
  scene.soup.triangles = soup.triangles;
  scene.soup.object.assign(soup.triangles.size(), 0);
  scene.soup.source_face.assign(soup.triangles.size(), 0);
  scene.objects.resize(1);
  scene.objects.front().name = name;
  return scene;
}

FileReport examine(const std::filesystem::path& file, const InspectedMesh& mesh, const mesh::DiagnosisOptions& options,
                   Progress& progress) {
  FileReport report;
  report.file = file;
  report.notes = mesh.notes;
  report.scene = mesh.scene;
  report.source_face = mesh.soup.source_face;
  report.total = examine_part(file.filename().string(), mesh.soup, mesh, options, progress);
  if (mesh.objects.size() == 1) {  // the total equals this object
    report.objects.push_back(report.total);
    report.objects.front().name = mesh.objects.front();
  } else {
    ObjectParts parts(mesh.soup, mesh.objects.size());
    for (std::size_t object = 0; object < mesh.objects.size(); ++object) {
      report.objects.push_back(examine_part(mesh.objects[object], parts.soup_of(object), mesh, options, progress));
      report.objects.back().triangles = parts.triangles_of(object);
    }
  }
  progress.clear();
  return report;
}

}  // namespace penumbra::session
