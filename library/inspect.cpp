#include "app/inspect/examine.hpp"
#include "app/inspect/report.hpp"
#include "base/error.hpp"
#include "library/library_progress.hpp"
#include "library/scene_state.hpp"

#include <penumbra/inspect.hpp>

#include <nlohmann/json.hpp>

#include <cmath>

namespace penumbra {
namespace {

std::string json_of(const std::filesystem::path& file, const app::InspectedMesh& mesh, const InspectOptions& options) {
  if (!(options.weld >= 0 && std::isfinite(options.weld)))
    throw UsageError("weld {}: expected a distance, 0 or more", options.weld);
  mesh::DiagnosisOptions diagnosis;
  diagnosis.weld = options.weld;
  diagnosis.search_intersections = options.self_intersections;
  diagnosis.list_limit = options.list_limit;
  const RendererOptions silent;
  LibraryProgress progress(silent);
  const app::FileReport report = app::examine(file, mesh, diagnosis, progress);
  return app::report_json({&report, 1}, std::nullopt, options.list_limit)
      .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

std::string inspect_json(const std::filesystem::path& file, const InspectOptions& options) {
  return json_of(file, app::read_inspected(file, false), options);
}

std::string inspect_json(std::span<const Vector> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
                         const InspectOptions& options) {
  Scene scene;
  scene.add_mesh("mesh", positions, triangles);
  app::InspectedMesh mesh;
  mesh.soup = scene.state().scene.soup;
  mesh.objects = {"mesh"};
  return json_of("mesh", mesh, options);
}

}  // namespace penumbra
