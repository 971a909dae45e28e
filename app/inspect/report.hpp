#pragma once

#include "app/inspect/examine.hpp"
#include "mesh/repair.hpp"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace penumbra::app {

/// One defect as `inspect` presents it.
struct DefectRow {
  const char* key;    ///< in JSON
  const char* label;  ///< in the table
  mesh::Defect mesh::Diagnosis::*counted;
};
/// All but self-intersections, which may not have been searched.
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

/// What `--repair` did to a file.
struct RepairReport {
  std::filesystem::path file;
  std::uint64_t triangles = 0;  ///< that were written
  std::vector<mesh::RepairStep> done;
  std::vector<std::string> left;
};

/// `inspect`'s JSON: "files" lists every file; a single one's entry, and its total's keys, stand at the top level too.
/// Of each defect the first `list_limit` places are listed.
nlohmann::ordered_json report_json(std::span<const FileReport> files, const std::optional<RepairReport>& repaired,
                                   std::size_t list_limit);

/// A FileReport, or what a repair did, as a table for the terminal.
std::string report_table(const FileReport& file, std::size_t list_limit);
std::string report_table(const RepairReport& repaired);

}  // namespace penumbra::app
