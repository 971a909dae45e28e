// SPDX-License-Identifier: Apache-2.0
// Repairs a mesh, writes it, reads the written file, and diagnoses the mesh that was read: a format that joins vertices
// by position can undo a repair, and the report must say so.

#include "app/inspect/repaired_file.hpp"

#include "base/error.hpp"
#include "base/scratch_folder.hpp"
#include "mesh/soup_files.hpp"
#include "mesh/soup_ply.hpp"
#include "scenes/formats/writer.hpp"
#include "session/process/interrupt.hpp"

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
    scenes::write_scene(session::scene_of(soup, file.stem().string()), file);
  }
}

/// Writes the soup under the name of `file` to a temporary folder next to it, and returns the mesh that is read from
/// there. `file` itself is not written.
session::InspectedMesh read_again(const std::filesystem::path& file, const mesh::TriangleSoup& soup) {
  const session::UnwindsAfterSignals unwinds;
  const std::filesystem::path parent = file.has_parent_path() ? file.parent_path() : ".";
  const ScratchFolder folder(parent);
  const std::filesystem::path written = folder.path() / file.filename();
  write_mesh(written, soup);
  try {
    return session::read_inspected(written, false);
  } catch (const InputError& error) {
    std::string said = error.what();
    if (const std::size_t at = said.find(written.string()); at != std::string::npos)
      said.erase(at, written.string().size() + (said.substr(at + written.string().size()).starts_with(": ") ? 2 : 0));
    throw InputError("{}: not written, since reading it back fails: {}", file.string(), said);
  }
}

}  // namespace

void require_mesh_ending(const std::filesystem::path& file) {
  if (std::ranges::find(kWrittenEndings, file.extension()) == kWrittenEndings.end())
    throw UsageError("{}: expected a name that ends in .ply, .obj, .stl, .off or .glb", file.string());
}

session::RepairReport repaired_file(const std::filesystem::path& file, const mesh::TriangleSoup& soup,
                                    const mesh::RepairOptions& repair, const mesh::DiagnosisOptions& diagnosis,
                                    session::Progress& progress) {
  mesh::Repaired repaired = mesh::repair(soup, repair);
  session::RepairReport report{
      file, repaired.soup.triangles.size(), std::move(repaired.done), std::move(repaired.left), {}};
  if (repaired.soup.triangles.empty())
    throw InputError("{}: not written, since nothing is left of the mesh: none of its triangles has an area",
                     file.string());
  report.written = session::examine(file, read_again(file, repaired.soup), diagnosis, progress).total.diagnosis;
  write_mesh(file, repaired.soup);
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
