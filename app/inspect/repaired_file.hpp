// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/repair.hpp"
#include "session/inspect/report.hpp"
#include "session/process/progress.hpp"

#include <filesystem>

namespace penumbra::app {

/// Throws UsageError for an ending that repaired_file cannot write.
void require_mesh_ending(const std::filesystem::path& file);

/// Repairs a soup, writes it as .ply, .off (double precision, vertices shared as in the repaired soup), .obj, .stl or
/// .glb (single precision), and reads and diagnoses the written file, so that the report describes the file: where
/// sheets only touch, the repair gives each its own vertices, and a reader that joins vertices by position, including
/// Penumbra's, joins them again.
session::RepairReport repaired_file(const std::filesystem::path& file, const mesh::TriangleSoup& soup,
                                    const mesh::RepairOptions& repair, const mesh::DiagnosisOptions& diagnosis,
                                    session::Progress& progress);

}  // namespace penumbra::app
