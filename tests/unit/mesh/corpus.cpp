// SPDX-License-Identifier: Apache-2.0
// Tests the half-edge view and repair on the meshes of Debian's libcgal-demo, good and bad: no face is lost without
// being listed, OpenMesh refuses none, silhouette loops are the signed multiplicities, and repair keeps its promises.
// The label `quick` has some small flawed meshes, `full` all.

#include "mesh/half_edge_view.hpp"
#include "mesh/import.hpp"
#include "mesh/repair.hpp"
#include "mesh/silhouettes.hpp"
#include "tests/unit/mesh/soups.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace penumbra::mesh {
namespace {

using test::view;

const std::filesystem::path kMeshes = std::filesystem::path(PENUMBRA_CGAL_CORPUS) / "meshes";

std::vector<std::filesystem::path> all_meshes() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(kMeshes)) {
    if (entry.path().extension() == ".off") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::vector<std::filesystem::path> small_flawed_meshes() {
  std::vector<std::filesystem::path> files;
  for (const char* name : {"blobby-shuffled", "cube-shuffled", "degtri_sliding", "elephant-with-holes", "elk", "hole",
                           "mask_cone", "pig", "quads_to_stitch", "tetra_intersected_by_triangle"}) {
    files.push_back(kMeshes / (std::string(name) + ".off"));
  }
  return files;
}

void check_half_edges(const TriangleSoup& soup) {
  const EdgeGraph graph = build_edge_graph(view(soup));
  const HalfEdgeView surface(view(soup), graph);
  EXPECT_EQ(surface.triangle_of_face().size() + surface.listed().size(), soup.triangles.size());
  EXPECT_EQ(std::ranges::count(surface.listed(), NotHeld::refused, &ListedFace::why), 0);
  const glm::dvec3 p = soup.positions[soup.triangles[0][0]] + glm::dvec3(0.1, 0.7, 0.2);
  std::vector<Side> sides = facings(view(soup), graph, p);
  std::vector<int> runs(graph.edges.size(), 0);
  for (const Side side : {Side::front, Side::back}) {
    for (const SurfaceLoop& loop : surface.silhouette_loops(sides, side)) {
      for (std::size_t i = 0; i < loop.edges.size(); ++i) {
        const bool forward = surface.point_of_vertex()[loop.vertices[i]] == graph.edges[loop.edges[i]].a;
        runs[loop.edges[i]] += forward == (side == Side::front) ? 1 : -1;
      }
    }
  }
  for (const ListedFace& face : surface.listed()) sides[face.triangle] = Side::on;
  std::size_t wrong = 0;
  for (std::uint32_t edge = 0; edge < graph.edges.size(); ++edge) {
    wrong += signed_multiplicity(graph, edge, sides) != runs[edge] ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0u);
}

/// Expects that by indices no directed edge occurs twice. Returns the number of open edges.
std::size_t open_edges(const TriangleSoup& soup) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> directed;
  for (const Triangle& t : soup.triangles) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(directed.insert({t[i], t[(i + 1) % 3]}).second);
  }
  return static_cast<std::size_t>(std::ranges::count_if(directed, [&](const auto& edge) {
    return !directed.contains({edge.second, edge.first});
  }));
}

struct Total {
  int files = 0, untouched = 0, without_rest = 0;
};

#ifdef PENUMBRA_WITH_CGAL_GPL
constexpr bool kCanRepair = true;
#else
constexpr bool kCanRepair = false;
#endif

void check_repair(const TriangleSoup& soup, const std::string& name, Total& total) {
  const RepairOptions options{.fill_holes_up_to = 30, .resolve_self_intersections = true};
  const auto start = std::chrono::steady_clock::now();
  const Repaired repaired = repair(soup, options);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ++total.files;
  total.untouched += repaired.done.empty() ? 1 : 0;
  total.without_rest += repaired.left.empty() ? 1 : 0;
  std::string text;
  for (const RepairStep& step : repaired.done) text += "\n    " + step.what;
  for (const std::string& what : repaired.left) text += "\n    left: " + what;
  if (!text.empty()) fmt::print("{}: {} triangles, {:.2f} s{}\n", name, soup.triangles.size(), seconds, text);
  if (!repaired.done.empty()) {  // a mesh without anything to repair stays as it is, whatever its indices
    const std::size_t open = open_edges(repaired.soup);
    EXPECT_EQ(open > 0, text.find("edges are open") != std::string::npos) << open << text;
  }
  const Repaired again = repair(repaired.soup, options);
  EXPECT_TRUE(again.done.empty()) << again.done[0].what;
  EXPECT_EQ(again.soup.triangles, repaired.soup.triangles);
}

void check_all(const std::vector<std::filesystem::path>& files) {
  ASSERT_FALSE(files.empty()) << "install the package libcgal-demo (packages.txt)";
  Total total;
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename().string());
    ASSERT_TRUE(std::filesystem::exists(file)) << "install the package libcgal-demo (packages.txt)";
    ImportedMesh mesh;
    try {
      mesh = import_mesh(file);
    } catch (const std::exception& error) {
      fmt::print("{}: not read: {}\n", file.filename().string(), error.what());  // the importer's tests judge that
      continue;
    }
    check_half_edges(mesh.soup);
    if (kCanRepair) check_repair(mesh.soup, file.filename().string(), total);
  }
  fmt::print("{} meshes repaired: {} had nothing to repair, {} have nothing left\n", total.files, total.untouched,
             total.without_rest);
  if (kCanRepair) {
    EXPECT_GE(total.files, static_cast<int>(files.size()) * 9 / 10);
  }
}

TEST(MeshCorpus, SmallFlawedMeshes) {
  check_all(small_flawed_meshes());
}

TEST(MeshCorpusFull, AllMeshes) {
  check_all(all_meshes());
}

}  // namespace
}  // namespace penumbra::mesh
