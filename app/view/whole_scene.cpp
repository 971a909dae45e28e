// SPDX-License-Identifier: Apache-2.0
// Scenes of the live view: with copies of instances where these fit into memory.

#include "app/view/whole_scene.hpp"

#include "base/error.hpp"
#include "session/pictures/request.hpp"
#include "session/session.hpp"

#include <fmt/format.h>

namespace penumbra::app {

WholeScene read_whole_scene(const session::RunOptions& options, session::InstanceUse use) {
  WholeScene read;
  read.use = use;
  read.scene = session::read_session_scene(
      options, {}, {.instances = &read.instances, .bytes_per_copy = session::bytes_per_copy({}, {})});
  if (read.instances.empty()) return read;
  const std::uint64_t triangles = scenes::triangle_count(read.scene, read.instances);
  const auto copy = [&] {
    return scenes::copied(read.scene, read.instances, session::bytes_per_copy({}, read.scene.lights));
  };
  if (use == session::InstanceUse::copies) return {copy(), {}, use};
  if (use == session::InstanceUse::automatic && triangles <= kMostCopies) {
    try {
      return {copy(), {}, use};
    } catch (const ResourceError&) {  // NOLINT(bugprone-empty-catch): continues without copies
    }
  }
  read.scene.warnings.push_back(fmt::format(
      "{} triangles with the {} instances of meshes, too many for copies: each picture finds the triangles that it "
      "needs; methods that need all triangles, and the 3D view, are not available (--instances copies makes them so)",
      triangles, read.instances.all.size()));
  return read;
}

void require_no_copies(const scenes::Scene& scene, const scenes::Instances& instances,
                       const session::MethodWish& wish) {
  if (instances.empty()) return;
  // Throws for methods that need more than the triangles between view samples and lights.
  static_cast<void>(session::needs_copies(scene, instances, session::parse_instances("shared", wish), wish, 1));
  const std::uint64_t triangles = scenes::triangle_count(scene, instances);
  if (triangles <= kMostCopies || session::counts_dome_samples(wish, scene.lights)) return;
  throw UsageError(
      "exact areas of a dome need all {} triangles of this scene; choose a number of light samples, or --instances "
      "copies",
      triangles);
}

}  // namespace penumbra::app
