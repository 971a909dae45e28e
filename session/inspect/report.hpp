// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/repair.hpp"
#include "session/inspect/examine.hpp"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace penumbra::session {

/// Defect as presented by `inspect`.
struct DefectRow {
  const char* key;    ///< in JSON
  const char* label;  ///< in the table
  mesh::Defect mesh::Diagnosis::*counted;
};
/// All defects but self-intersections, which may not have been searched.
inline constexpr std::array<DefectRow, 9> kDefects = {{
    {"boundaryEdges", "boundary edges", &mesh::Diagnosis::boundary_edges},
    {"nonManifoldEdges", "non-manifold edges", &mesh::Diagnosis::non_manifold_edges},
    {"nonManifoldVertices", "non-manifold vertices", &mesh::Diagnosis::non_manifold_vertices},
    {"inconsistentWindings", "inconsistent windings", &mesh::Diagnosis::inconsistent_windings},
    {"duplicateFaces", "duplicate faces", &mesh::Diagnosis::duplicate_faces},
    {"oppositeFaces", "opposite faces", &mesh::Diagnosis::opposite_faces},
    {"zeroAreaTriangles", "zero-area triangles", &mesh::Diagnosis::zero_area_triangles},
    {"needles", "needles", &mesh::Diagnosis::needles},
    {"tJunctions", "T-junctions", &mesh::Diagnosis::t_junctions},
}};

/// Result of `--repair` for a file.
struct RepairReport {
  std::filesystem::path file;
  std::uint64_t triangles = 0;  ///< number of written triangles
  std::vector<mesh::RepairStep> done;
  std::vector<std::string> left;
  mesh::Diagnosis written;  ///< of the written file, read again
};

/// Returns `inspect`'s JSON of one file: its entry, its total's keys also at the top level, and "files", a list of the
/// entry alone. For each defect the first `list_limit` locations are listed.
nlohmann::ordered_json report_json(const FileReport& file, const std::optional<RepairReport>& repaired,
                                   std::size_t list_limit);
/// Returns an array of the entries of several files.
nlohmann::ordered_json report_json(std::span<const FileReport> files, std::size_t list_limit);

/// Extent of a printed report.
struct TableOptions {
  std::size_t list_limit = 3;  ///< locations of each defect
  bool methods = false;        ///< each method's verdict with its reason; false: the number of methods for each verdict
};

/// Return a FileReport, or the result of a repair, as a table for the terminal.
std::string report_table(const FileReport& file, const TableOptions& options);
std::string report_table(const RepairReport& repaired);

}  // namespace penumbra::session
