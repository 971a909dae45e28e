// SPDX-License-Identifier: Apache-2.0
// Compares the mask methods with the ray caster on broken meshes: every defect of the generator, random soups on a
// lattice, and the meshes of CGAL's demos, many of which are flawed.

#include "tests/agreement/differences.hpp"

#include "mesh/shapes/broken_meshes.hpp"
#include "mesh/import.hpp"

#include <filesystem>

namespace penumbra {
namespace {

using tests::Differences;

/// Expects that at most the share `allowed` of all pairs differs, and that the mask method is right about each
/// differing pair that is decided exactly.
void expect_agreement(const std::string& name, const Differences& found, double allowed = 2e-5) {
  EXPECT_GT(found.pairs_all, 0U) << name;
  EXPECT_LE(static_cast<double>(found.differing), allowed * static_cast<double>(found.pairs_all)) << name;
  EXPECT_EQ(found.mapped_right, found.judged) << name << ": " << found.first_wrong;
}

/// One device and one pair of methods for all cases of a test.
class Meshes : public tests::DeviceTest, public testing::WithParamInterface<tests::MaskMethod> {
 protected:
  void add(const std::string& name, const scenes::Scene& scene, std::uint32_t size,
           std::size_t most_judged = tests::kMostJudged) {
    const Differences found = methods_.on(scene, size, {}, most_judged);
    if (found.differing > 0) tests::print(name, found);
    expect_agreement(name, found);
    total_ += found;
  }
  void TearDown() override {
    tests::print("in total", total_);
    DeviceTest::TearDown();
  }

 private:
  tests::BothMethods methods_{device(), GetParam()};
  Differences total_;
};

class BrokenMeshes : public Meshes {};
class CgalMeshes : public Meshes {};

const auto kMethods = testing::ValuesIn(tests::kMaskMethods);
std::string name_of_method(const testing::TestParamInfo<tests::MaskMethod>& info) {
  return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(By, BrokenMeshes, kMethods, name_of_method);
INSTANTIATE_TEST_SUITE_P(By, CgalMeshes, kMethods, name_of_method);

scenes::Scene broken_scene(const std::vector<std::string>& defects, std::uint32_t size, double half_extent) {
  return tests::with_a_floor(mesh::make_broken_mesh({defects, size, {0, 1, 0}, half_extent}).soup);
}

TEST_P(BrokenMeshes, EveryDefectAlone) {
  for (const mesh::DefectName& defect : mesh::broken_defects()) {
    add(std::string(defect.name), broken_scene({std::string(defect.name)}, 2, 1), 48);
  }
}

TEST_P(BrokenMeshes, AllDefectsTogether) {
  std::vector<std::string> all;
  for (const mesh::DefectName& defect : mesh::broken_defects()) all.emplace_back(defect.name);
  for (const std::uint32_t size : {1u, 2u, 3u, 16u}) {
    add(fmt::format("all, size {}", size), broken_scene(all, size, 4), 128);
  }
}

TEST_P(BrokenMeshes, LatticeSoups) {
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    const mesh::TriangleSoup soup = mesh::make_lattice_soup({16 * seed, 1 + seed % 4, seed, {0, 1.5, 0}, 1});
    add(fmt::format("soup, seed {}", seed), tests::with_a_floor(soup), 64);
  }
}

scenes::Scene corpus_scene(const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(PENUMBRA_CGAL_CORPUS) / "meshes" / (name + ".off");
  return tests::with_a_floor(tests::fitted(mesh::import_mesh(file).soup));
}

TEST_P(CgalMeshes, ADozen) {
  for (const char* name : {"cow", "cube-shuffled", "degtri_sliding", "hole", "icosahedron", "mushroom", "negative",
                           "open_cube", "plane", "quads_to_stitch", "tetra_intersected_by_triangle", "tet-shuffled"}) {
    add(name, corpus_scene(name), 128);
  }
}

/// Open, self-intersecting, shuffled, degenerate meshes: every differing pair is decided exactly.
TEST_P(CgalMeshes, FlawedOnesFull) {
  for (const char* name : {"diplodocus", "cow", "cube-shuffled", "cube4-shuffled", "blobby-shuffled", "oblong-shuffled",
                           "tet-shuffled", "boeing", "mannequin-devil", "elephant-with-holes", "degtri_sliding",
                           "tetra_intersected_by_triangle", "mech-holes-shark"}) {
    add(name, corpus_scene(name), 128, std::numeric_limits<std::size_t>::max());
  }
}

TEST_P(CgalMeshes, EveryOneFull) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(PENUMBRA_CGAL_CORPUS "/meshes")) {
    if (entry.path().extension() == ".off") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names.size(), 138U) << "in " << PENUMBRA_CGAL_CORPUS << "; Debian's package libcgal-demo has them";
  for (const std::string& name : names) add(name, corpus_scene(name), 128);
}

}  // namespace
}  // namespace penumbra
