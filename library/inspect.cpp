// SPDX-License-Identifier: Apache-2.0
// Examines a mesh, from a file or in memory, as the command `inspect` does, and returns its report as JSON.

#include "base/error.hpp"
#include "library/as_error.hpp"
#include "library/library_progress.hpp"
#include "library/mesh_arrays.hpp"
#include "session/inspect/examine.hpp"
#include "session/inspect/report.hpp"

#include <penumbra/inspect.hpp>

#include <nlohmann/json.hpp>

#include <cmath>
#include <functional>

namespace penumbra {
namespace {

/// Examines the mesh that `read` returns. `read` gets a function to be called while it waits.
template <typename Read>
std::string json_of(const std::filesystem::path& file, const Read& read, const InspectOptions& options,
                    const RendererOptions& host) {
  if (!(options.weld >= 0 && std::isfinite(options.weld)))
    throw UsageError("weld {}: expected a distance, 0 or more", options.weld);
  mesh::DiagnosisOptions diagnosis;
  diagnosis.weld = options.weld;
  diagnosis.search_intersections = options.self_intersections;
  diagnosis.list_limit = options.list_limit;
  LibraryProgress progress(host);
  const std::function<void()> step = [&] { progress.begin("reading", 1); };
  try {
    const session::InspectedMesh mesh = read(step);
    const session::FileReport report = session::examine(file, mesh, diagnosis, progress);
    progress.rethrow();
    return session::report_json(report, std::nullopt, options.list_limit)
        .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  } catch (...) {
    progress.rethrow();
    throw_as_error();
  }
}

}  // namespace

std::string inspect_json(const std::filesystem::path& file, const InspectOptions& options,
                         const RendererOptions& host) {
  return json_of(
      file, [&](const std::function<void()>& step) { return session::read_inspected(file, false, &step); }, options,
      host);
}

std::string inspect_json(std::span<const Vector> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
                         const InspectOptions& options, const RendererOptions& host) {
  const auto read = [&](const std::function<void()>& /*step*/) {
    session::InspectedMesh mesh;
    mesh.soup = soup_of(positions, triangles, "mesh");
    mesh.objects = {"mesh"};
    return mesh;
  };
  return json_of("mesh", read, options, host);
}

}  // namespace penumbra
