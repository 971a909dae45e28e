// SPDX-License-Identifier: Apache-2.0
// Variants of hard-volume that cost less: V is the default's at every pixel, and they save what their papers say.

#include "tests/agreement/lattice.hpp"
#include "tests/agreement/volumes/soft_stage.hpp"

#include "mesh/shapes/broken_meshes.hpp"
#include "volumes/raster/receiver_cells.hpp"
#include "volumes/soft/methods.hpp"

#include <random>

namespace penumbra::volumes {
namespace {

using tests::SoftStage;

constexpr std::array kVariants{"zp+", "cc", "split", "hierarchical", "tiles"};

class HardVolumeVariants : public tests::DeviceTest {
 protected:
  struct Answer {
    std::vector<float> visibility;
    std::map<std::string, std::uint64_t> counters;
  };
  /// Methods are kept: making their passes costs more than a small picture.
  static Answer run(const SoftStage& stage, const std::string& variant, std::uint32_t rows = 0) {
    std::unique_ptr<visibility::Method>& method = methods_[variant];
    if (!method) method = make_hard_volume(device(), {{"variant", variant}});
    Answer answer{stage.run(*method, rows), {}};
    answer.counters = method->counters();
    return answer;
  }
  static void TearDownTestSuite() {
    methods_.clear();
    DeviceTest::TearDownTestSuite();
  }

  /// Runs all variants, and returns their answers.
  static std::map<std::string, Answer> expect_same(const std::string& name, const SoftStage& stage) {
    std::map<std::string, Answer> answers{{"z-fail", run(stage, "z-fail")}};
    for (const char* variant : kVariants) {
      Answer answer = run(stage, variant);
      std::size_t differing = 0, first = 0;
      for (std::size_t i = 0; i < answer.visibility.size(); ++i) {
        if (answer.visibility[i] == answers["z-fail"].visibility[i]) continue;
        if (differing++ == 0) first = i;
      }
      EXPECT_EQ(differing, 0U) << name << ", " << variant << ", first pixel " << first;
      answers[variant] = std::move(answer);
    }
    return answers;
  }

  static void expect_same_of(const char* name, std::uint32_t width, std::uint32_t height) {
    const auto answers = expect_same(name, SoftStage(tests::shipped_scene(name), device(), width, height));
    for (const auto& [variant, answer] : answers) {
      fmt::print("{} {}: {} fragments, {} updates, {} pixels on the host\n", name, variant,
                 answer.counters.at("fragments"), answer.counters.at("countUpdates"),
                 answer.counters.at("pixelsCountedOnHost"));
    }
    EXPECT_EQ(answers.at("zp+").counters.at("countedFromEye"), 1U) << name;
  }

 private:
  static inline std::map<std::string, std::unique_ptr<visibility::Method>> methods_;
};

TEST_F(HardVolumeVariants, HideWhatTheDefaultHides) {
  for (const char* name : {"broken", "contact", "fusion"}) expect_same_of(name, 40, 30);
}

TEST_F(HardVolumeVariants, HideWhatTheDefaultHidesFull) {
  for (const char* name : {"broken", "bunny", "contact", "fusion", "large-penumbra", "room", "self-shadow", "thin"}) {
    expect_same_of(name, 160, 120);
  }
}

/// Soups in which nothing is closed, with triangles that lie on one another and in planes of the light, the eye and the
/// receivers.
TEST_F(HardVolumeVariants, HideTheSameOfOpenSoups) {
  for (const char* defect : {"hole", "flipped-patch", "duplicate-face"}) {
    const scenes::Scene scene = tests::with_a_floor(mesh::make_broken_mesh({{defect}, 2, {0, 1, 0}, 1}).soup);
    expect_same(defect, SoftStage(scene, device(), 48, 36));
  }
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    tests::LatticeSoup soup(seed, 2);
    visibility::SampleRequest request;
    const scenes::Scene scene = tests::lattice_scene(soup, request);
    expect_same(fmt::format("soup {}", seed), SoftStage(scene, device(), 33, 25));
  }
}

TEST_F(HardVolumeVariants, HideTheSameInTiles) {
  const SoftStage stage(tests::shipped_scene("fusion"), device(), 48, 36);
  const Answer whole = run(stage, "z-fail");
  for (const char* variant : kVariants) {
    EXPECT_EQ(run(stage, variant, 7).visibility, whole.visibility) << variant;
  }
}

/// The camera is in two shadows, where z-pass alone is wrong.
TEST_F(HardVolumeVariants, HideTheSameFromWithinShadows) {
  scenes::Scene scene = tests::floor_and_light(0.5);
  tests::add_object(scene, "board", tests::quad({0, 2, 0}, {0.8, 0, 0}, {0, 0, -0.8}));
  tests::add_object(scene, "other", tests::quad({0.2, 1.5, 0}, {0.8, 0, 0}, {0, 0, -0.8}));
  scene.cameras[0] = tests::camera({0.2, 0.5, 0.1}, {0.5, 0, 0}, 100);
  const SoftStage stage(scene, device(), 48, 36);
  const auto answers = expect_same("in two shadows", stage);
  EXPECT_NE(run(stage, "z-pass").visibility, answers.at("z-fail").visibility);
  // The eye is inside both boards' volumes, and rays beyond p end inside the floor's volume.
  EXPECT_EQ(answers.at("split").counters.at("togglingVolumes"), 0U);
}

/// A board that another board hides completely from the light has no volume; a third board has a volume, which ends at
/// the floor.
TEST_F(HardVolumeVariants, CullCastersInShadow) {
  scenes::Scene scene = tests::floor_and_light(0.5);
  tests::add_object(scene, "upper", tests::quad({0, 2, 0}, {1, 0, 0}, {0, 0, -1}));
  tests::add_object(scene, "hidden", tests::quad({0, 1, 0}, {0.5, 0, 0}, {0, 0, -0.5}));
  tests::add_object(scene, "beside", tests::quad({-1.6, 1, 0}, {0.3, 0, 0}, {0, 0, -0.3}));
  const auto answers = expect_same("boards", SoftStage(scene, device(), 64, 48));
  const auto& cc = answers.at("cc").counters;
  EXPECT_EQ(cc.at("volumes"), 4U);
  EXPECT_EQ(cc.at("culledVolumes"), 2U);  // the hidden board's and, as nothing is below it, the floor's
  EXPECT_EQ(cc.at("clampedVolumes"), 2U);
  EXPECT_EQ(cc.at("silhouetteEdges"), 8U * cc.at("stretches") / 2);
  // If only view samples decide, the hidden board still hides something: the floor below it.
  EXPECT_EQ(answers.at("hierarchical").counters.at("culledVolumes"), 2U);  // the floor's two triangles
}

/// A board's shadow on a floor is a square, here of half-width 5/3. Tiles whose view samples are all on one of the two
/// surfaces are decided as a whole, except where their box meets the square's outline.
TEST_F(HardVolumeVariants, DecideWholeTiles) {
  scenes::Scene scene = tests::floor_and_light(0.5);
  tests::add_object(scene, "board", tests::quad({0, 2, 0}, {1, 0, 0}, {0, 0, -1}));
  const SoftStage stage(scene, device(), 200, 152);
  const auto answers = expect_same("a board", stage);
  const double half = 5.0 / 3;
  std::uint64_t tiles = 0, whole = 0, drawn = 0;
  for (std::uint32_t y = 0; y < 152; y += 8) {
    for (std::uint32_t x = 0; x < 200; x += 8) {
      glm::dvec3 lower(1e30), upper(-1e30);
      std::uint64_t pixels = 0;
      for (std::size_t i = 0; i < 64; ++i) {
        const std::size_t pixel = (y + i / 8) * 200 + x + i % 8;
        if (stage.samples.triangle[pixel] == visibility::ViewSamples::kBackground) continue;
        const glm::dvec3 p = glm::dvec3(stage.samples.p[pixel]) + stage.floats.origin;
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
        ++pixels;
      }
      if (pixels == 0) continue;
      ++tiles;
      const bool on_board = lower.y > 1, on_floor = upper.y < 1;
      const bool reaches = std::max({lower.x, -upper.x, lower.z, -upper.z}) <= half;
      const bool within = std::min({lower.x, -upper.x, lower.z, -upper.z}) > -half;
      const bool is_whole = on_board || (on_floor && (!reaches || within));
      whole += is_whole ? 1 : 0;
      drawn += is_whole ? 1 : pixels;
    }
  }
  const auto& counters = answers.at("tiles").counters;
  EXPECT_EQ(counters.at("tiles"), tiles);
  EXPECT_EQ(counters.at("wholeTiles"), whole);
  EXPECT_EQ(counters.at("pixelsDrawn"), drawn);
  EXPECT_GT(2 * whole, tiles);
  EXPECT_LT(counters.at("countUpdates"), answers.at("z-fail").counters.at("countUpdates"));
}

/// Tests the papers' promises in sums over scenes: fewer changes of counts between the eye and p than beyond p, or on
/// the better side of p; fewer fragments if volumes are culled and clamped.
TEST_F(HardVolumeVariants, FillLess) {
  std::map<std::string, std::uint64_t> fragments, updates;
  for (const char* name : {"fusion", "room"}) {
    const SoftStage stage(tests::shipped_scene(name), device(), 40, 30);
    for (const char* variant : {"z-fail", "zp+", "cc", "split", "hierarchical"}) {
      const auto counters = run(stage, variant).counters;
      fragments[variant] += counters.at("fragments");
      updates[variant] += counters.at("countUpdates");
    }
  }
  for (const auto& [variant, sum] : fragments) {
    fmt::print("{}: {} fragments, {} updates\n", variant, sum, updates[variant]);
  }
  EXPECT_LT(updates["split"], updates["z-fail"]);
  EXPECT_LT(updates["zp+"], updates["z-fail"]);
  EXPECT_LT(fragments["cc"], fragments["z-fail"]);
  EXPECT_LT(fragments["hierarchical"], fragments["z-fail"]);
}

/// The contents of cells are conservative: directions to points of a triangle are in its block, at depths within those
/// of its plane.
TEST_F(HardVolumeVariants, CellsAreConservative) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-2, 2), share(0, 1);
  std::size_t points = 0;
  for (int i = 0; i < 2000; ++i) {
    std::array<glm::dvec3, 3> corners;
    for (glm::dvec3& corner : corners) corner = {place(random), place(random), place(random)};
    const std::vector<CellBlock> blocks = blocks_of(corners);
    const PlaneDepths plane(corners);
    for (int k = 0; k < 20; ++k) {
      const double s = share(random), t = share(random) * (1 - s);
      const glm::dvec3 x = corners[0] + s * (corners[1] - corners[0]) + t * (corners[2] - corners[0]);
      const glm::dvec3 size = glm::abs(x);
      const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
      const auto face = static_cast<std::uint32_t>(2 * axis + (x[axis] < 0 ? 1 : 0));
      const auto cell = [&](double along) {
        return std::min(ReceiverCells::kSide - 1,
                        static_cast<std::uint32_t>(0.5 * (along / size[axis] + 1) * ReceiverCells::kSide));
      };
      const std::uint32_t column = cell(x[(axis + 1) % 3]), row = cell(x[(axis + 2) % 3]);
      const auto block = std::ranges::find(blocks, face, &CellBlock::face);
      ASSERT_NE(block, blocks.end());
      EXPECT_TRUE(column >= block->first[0] && column <= block->last[0] && row >= block->first[1] &&
                  row <= block->last[1]);
      const PlaneDepths::Range range = plane.in(*block, column, row);
      EXPECT_LE(range.least, size[axis] * (1 + 1e-9));
      EXPECT_GE(range.most, size[axis] * (1 - 1e-9));
      ++points;
    }
  }
  EXPECT_EQ(points, 40000U);
}

}  // namespace
}  // namespace penumbra::volumes
