// SPDX-License-Identifier: Apache-2.0
// Wedges of the meshes of Debian's libcgal-demo under every kind of light: unrepaired, in scene floats.

#include "mesh/diagnosis/diagnosis.hpp"
#include "mesh/import.hpp"
#include "tests/property/volumes/wedge_cases.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace penumbra::volumes {
namespace {

const std::filesystem::path kCorpus = std::filesystem::path(PENUMBRA_CGAL_CORPUS) / "meshes";

visibility::SceneFloats floats_of(mesh::TriangleSoup soup) {
  scenes::Scene scene;
  scene.soup = std::move(soup);
  scene.soup.object.assign(scene.soup.triangles.size(), 0);
  scene.objects.push_back({"mesh", glm::dvec3(0.8), true, true, {}});
  return visibility::make_scene_floats(scene);
}

/// Checks wedges from the centre of each light, and from anywhere on its rectangle.
std::uint64_t check(const std::filesystem::path& file, bool closed_only) {
  mesh::ImportedMesh imported;
  try {
    imported = mesh::import_mesh(file);
  } catch (const std::exception& error) {
    return 0;  // the importer's tests check such files
  }
  const mesh::MeshView view{imported.soup.positions, imported.soup.triangles};
  if (closed_only && !mesh::diagnose(view, {.search_intersections = false}).closed) return 0;
  const visibility::SceneFloats floats = floats_of(std::move(imported.soup));
  const double size = glm::length(glm::dvec3(floats.upper - floats.lower));
  if (!(size > 0)) return 0;
  std::uint64_t wedges = 0;
  for (const visibility::Light& light : test::lights_at(size * glm::dvec3(0.1, 1.2, 0.05), size / 8)) {
    const Casters casters = casters_of(floats, light);
    const std::string name = fmt::format("{} under {}", file.filename().string(), light.name);
    const LightHull hull = light_hull(light);
    for (const Construction construction : {Construction::original, Construction::tight}) {
      for (const SilhouettesFrom from : {SilhouettesFrom::center, SilhouettesFrom::anywhere}) {
        if (from == SilhouettesFrom::anywhere && light.kind != visibility::LightKind::rectangle) continue;
        const test::Validated result = test::validated(casters, hull, construction, from);
        wedges += result.wedges.size();
        if (result.report.violations.empty()) continue;
        ADD_FAILURE() << name << ": " << result.report.violations.size() << " violations; "
                      << test::text_of(result.report.violations[0]);
      }
    }
  }
  return wedges;
}

TEST(WedgeCorpus, SmallMeshes) {
  std::uint64_t wedges = 0;
  for (const char* name : {"cube", "tetrahedron", "sphere", "degtri_sliding", "cube-shuffled"}) {
    ASSERT_TRUE(std::filesystem::exists(kCorpus / (std::string(name) + ".off"))) << name << ": install libcgal-demo";
    wedges += check(kCorpus / (std::string(name) + ".off"), false);
  }
  EXPECT_GT(wedges, 100U);
}

TEST(WedgeCorpus, AllClosedMeshesFull) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(kCorpus)) {
    if (entry.path().extension() == ".off") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  ASSERT_FALSE(files.empty()) << "install the package libcgal-demo (packages.txt)";
  std::uint64_t wedges = 0, meshes = 0;
  for (const auto& file : files) {
    const std::uint64_t some = check(file, true);
    if (some == 0) continue;
    wedges += some;
    ++meshes;
    fmt::print("{}: {} wedges\n", file.filename().string(), some);
    std::fflush(stdout);  // progress, as this takes long
  }
  fmt::print("{} closed meshes, {} wedges\n", meshes, wedges);
  EXPECT_GT(meshes, 50U);
}

}  // namespace
}  // namespace penumbra::volumes
