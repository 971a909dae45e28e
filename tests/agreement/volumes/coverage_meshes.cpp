// SPDX-License-Identifier: Apache-2.0
// Computes V by summing over the silhouettes seen from the receiver, for broken and for real meshes, and compares it
// with the sum over single triangles and with the exact union.

#include "mesh/shapes/broken_meshes.hpp"
#include "mesh/diagnosis/diagnosis.hpp"
#include "mesh/import.hpp"
#include "tests/unit/coverage_stage.hpp"
#include "visibility/pair_truth.hpp"
#include "volumes/wedges/coverage_validation.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>

namespace penumbra::volumes {
namespace {

const std::filesystem::path kMeshes = std::filesystem::path(PENUMBRA_CGAL_CORPUS) / "meshes";

/// Returns the mesh, scaled to at most 1 from the origin, over a floor and under one light: a rectangle (`lamp` 0), a
/// disk (1) or a polygon (2).
scenes::Scene scene_of(const mesh::TriangleSoup& soup, int lamp) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, -1.125, 0}, {4, 0, 0}, {0, 0, 4}));
  tests::add_object(scene, "mesh", tests::corners_of(soup));
  scene.lights.push_back(tests::rectangle_light({0.25, 4, 0.5}, {0.75, 0.125, 0}, {0, 0.25, 0.75}));
  if (lamp == 1) scene.lights[0].shape = scenes::Disk{{0.25, 4, 0.5}, {0.125, -1, 0}, 0.75};
  if (lamp == 2) scene.lights[0].shape = scenes::Polygon{{{-1, 4, -1}, {1, 4, -0.5}, {1.25, 4, 0.5}, {0, 4, 1}}};
  return scene;
}

mesh::TriangleSoup fitted(mesh::TriangleSoup soup) {
  glm::dvec3 lower = soup.positions.front(), upper = lower;
  for (const glm::dvec3& at : soup.positions) {
    lower = glm::min(lower, at);
    upper = glm::max(upper, at);
  }
  const glm::dvec3 extent = upper - lower;
  const double size = std::max({extent.x, extent.y, extent.z});
  for (glm::dvec3& at : soup.positions) at = (at - (lower + upper) / 2.0) * (2 / size);
  return soup;
}

bool is_judged(const visibility::SceneFloats& floats, const visibility::Light& light, const LitPoint& point) {
  if (!visibility::in_front_of_light(light, point.p)) return false;
  return std::ranges::all_of(light.outline, [&](const glm::vec3& corner) {
    return visibility::above_horizon(floats.corners(point.carrier), point.facing, corner);
  });
}

/// Returns points on triangles of the floor and of the mesh, on the side from which the whole light is visible.
std::vector<LitPoint> points_on(const visibility::SceneFloats& floats, const visibility::Light& light, int count,
                                std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::uint32_t> any(0, static_cast<std::uint32_t>(floats.triangles.size()) - 1);
  std::uniform_int_distribution<int> share(0, 16);
  std::vector<LitPoint> points;
  for (int tries = 0; tries < 16 * count && static_cast<int>(points.size()) < count; ++tries) {
    LitPoint point;
    point.carrier = tries % 2 == 0 ? static_cast<std::uint32_t>(tries / 2 % 2) : any(random);
    if (floats.plane[point.carrier] == visibility::SceneFloats::kNoPlane) continue;
    const auto [a, b, c] = floats.corners(point.carrier);
    const float s = static_cast<float>(share(random)) / 16, t = (1 - s) * static_cast<float>(share(random)) / 16;
    const float near = tries % 2 == 0 ? 0.375F : 1;  // on the floor, only the part below the mesh
    point.p = near * (a + s * (b - a) + t * (c - a));
    if (tries % 2 == 0) point.p.y = a.y;
    for (const int facing : {1, -1}) {
      point.facing = static_cast<std::int8_t>(facing);
      if (!is_judged(floats, light, point)) continue;
      points.push_back(point);
      break;
    }
  }
  return points;
}

struct Tally {
  int points = 0, partly = 0, single = 0;
  double worst = 0, largest_difference = 0;
};

void check(const std::string& name, const mesh::TriangleSoup& soup, int count, Tally& tally) {
  for (int lamp = 0; lamp < 3; ++lamp) {
    const tests::CoverageStage stage(scene_of(soup, lamp));
    ValidationReport report;
    const auto points = check_coverage(stage.soft, stage.light, points_on(stage.floats, stage.light, count, 5), report);
    for (const CoveragePoint& point : points) {
      const double hidden = 1 - stage.area.visibility({point.sample.p, point.sample.carrier, point.sample.facing});
      check_union(point, hidden, lamp == 1 ? 1e-7 : 0, report);
      ++tally.points;
      tally.partly += hidden > 0.001 && hidden < 0.999 ? 1 : 0;
      tally.single += point.is_single_layer() && hidden > 0.001 && hidden < 0.999 ? 1 : 0;
      tally.worst = std::max(tally.worst, std::abs(point.receiver - point.layers));
      tally.largest_difference = std::max(tally.largest_difference, std::abs(point.center - point.receiver));
    }
    if (!report.violations.empty()) {
      const Violation& first = report.violations.front();
      ADD_FAILURE() << name << ", lamp " << lamp << ": " << report.violations.size() << " violations; " << first.what
                    << fmt::format("; at ({}, {}, {})", first.point.x, first.point.y, first.point.z);
    }
  }
}

void print(const Tally& tally) {
  fmt::print(
      "{} samples, {} partly lit, {} of them with a single layer; {:.1e} off at most; silhouettes from the centre "
      "differ by up to {:.4f}\n",
      tally.points, tally.partly, tally.single, tally.worst, tally.largest_difference);
}

TEST(CoverageMeshes, BrokenOnes) {
  Tally tally;
  std::vector<std::string> all;
  for (const mesh::DefectName& defect : mesh::broken_defects()) {
    all.emplace_back(defect.name);
    check(all.back(), mesh::make_broken_mesh({{all.back()}, 2}).soup, 12, tally);
  }
  check("all", mesh::make_broken_mesh({all, 1}).soup, 40, tally);
  print(tally);
  EXPECT_GT(tally.partly, 100);
  EXPECT_GT(tally.single, 20);
}

TEST(CoverageMeshes, LatticeSoups) {
  Tally tally;
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    check(fmt::format("soup {}", seed), mesh::make_lattice_soup({8 + 4 * (seed % 5), 4, seed}), 16, tally);
  }
  print(tally);
  EXPECT_GT(tally.partly, 100);
}

TEST(CoverageMeshes, ClosedOnesOfTheCorpusFull) {
  Tally tally;
  int meshes = 0;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(kMeshes)) {
    if (entry.path().extension() == ".off") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  ASSERT_FALSE(files.empty()) << "install the package libcgal-demo (packages.txt)";
  for (const auto& file : files) {
    mesh::ImportedMesh imported;
    try {
      imported = mesh::import_mesh(file);
    } catch (const std::exception& error) {
      continue;  // the importer's tests check such files
    }
    const mesh::MeshView view{imported.soup.positions, imported.soup.triangles};
    if (!mesh::diagnose(view, {.search_intersections = false}).closed) continue;
    check(file.filename().string(), fitted(std::move(imported.soup)), 16, tally);
    ++meshes;
  }
  fmt::print("{} closed meshes: ", meshes);
  print(tally);
  EXPECT_GT(meshes, 50);
}

}  // namespace
}  // namespace penumbra::volumes
