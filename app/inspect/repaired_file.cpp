// SPDX-License-Identifier: Apache-2.0
#include "app/inspect/repaired_file.hpp"

#include "base/error.hpp"
#include "mesh/soup_files.hpp"
#include "mesh/soup_ply.hpp"
#include "scenes/formats/writer.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace penumbra::app {
namespace {

constexpr std::array kWrittenEndings = {".ply", ".obj", ".stl", ".off", ".glb"};

void write_mesh(const std::filesystem::path& file, const mesh::TriangleSoup& soup) {
  const std::filesystem::path ending = file.extension();
  if (ending == ".ply") {
    mesh::write_ply(file, {soup.positions, soup.triangles, {}, {}});
  } else if (ending == ".stl") {
    mesh::write_stl(file, soup);
  } else if (ending == ".off") {
    mesh::write_off(file, soup);
  } else {
    scenes::write_scene(scene_of(soup, file.stem().string()), file);
  }
}

}  // namespace

void require_mesh_ending(const std::filesystem::path& file) {
  if (std::ranges::find(kWrittenEndings, file.extension()) == kWrittenEndings.end())
    throw UsageError("{}: expected a name that ends in .ply, .obj, .stl, .off or .glb", file.string());
}

RepairReport repaired_file(const std::filesystem::path& file, const mesh::TriangleSoup& soup,
                           const mesh::RepairOptions& repair, const mesh::DiagnosisOptions& diagnosis,
                           Progress& progress) {
  mesh::Repaired repaired = mesh::repair(soup, repair);
  RepairReport report{file, repaired.soup.triangles.size(), std::move(repaired.done), std::move(repaired.left), {}};
  write_mesh(file, repaired.soup);
  if (repaired.soup.triangles.empty()) return report;  // a file without triangles is not a mesh for any reader
  report.written = examine(file, read_inspected(file, false), diagnosis, progress).total.diagnosis;
  const std::uint64_t edges = report.written.non_manifold_edges.count,
                      vertices = report.written.non_manifold_vertices.count;
  if (edges + vertices > 0)
    report.left.push_back(fmt::format(
        "{} edges and {} vertices are shared by sheets that only touch there: each sheet has vertices of its "
        "own, at the same positions, so the surface is manifold by indices, and not for programs that join "
        "vertices by position, as this one does when it reads the file",
        edges, vertices));
  return report;
}

}  // namespace penumbra::app
