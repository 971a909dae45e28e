// SPDX-License-Identifier: Apache-2.0
// Tests that methods that take too long are left out of a comparison, unless they are named.
#include "app/process/terminal_progress.hpp"
#include "scenes/formats/reader.hpp"
#include "session/comparison/comparison.hpp"
#include "session/machine.hpp"
#include "session/options.hpp"
#include "session/runner.hpp"
#include "session/session.hpp"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <limits>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

namespace penumbra::tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// A method that takes two milliseconds per row, and `each_tile` milliseconds per tile, like one that draws its maps
/// again for each.
class Slow final : public visibility::Method {
 public:
  explicit Slow(std::uint32_t each_tile = 0, std::uint32_t each_row = 2) : each_tile_(each_tile), each_row_(each_row) {
    description_.name = "slow";
    description_.output = visibility::Output::scalar;
    description_.lights = {visibility::LightKind::rectangle};
  }
  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& /*scene*/) override {}
  void prepare_light(const visibility::Light& /*light*/) override {}
  void prepare_view(const visibility::ViewSamples& /*samples*/) override {}
  [[nodiscard]] std::uint32_t max_tile_rows() const override { return 4096; }
  void evaluate(const visibility::Tile& tile) override {
    tiles.push_back(tile.row_count);
    const auto begin = std::chrono::steady_clock::now();
    std::this_thread::sleep_for(std::chrono::milliseconds(each_tile_ + each_row_ * tile.row_count));
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  void read_visibility(std::span<float> visibility) override { std::ranges::fill(visibility, 0.5F); }

  std::vector<std::uint32_t> tiles;
  std::vector<double> seconds;  // of each tile

 private:
  visibility::MethodDescription description_;
  std::uint32_t each_tile_, each_row_;
};

class Warnings final : public session::Progress {
 public:
  void begin(std::string /*stage*/, std::uint64_t /*steps*/) override {}
  void advance(std::uint64_t /*steps*/) override {}
  void clear() override {}
  void say(Level /*level*/, const std::string& message) override { said.push_back(message); }
  std::vector<std::string> said;
};

class SlowMethods : public ProgramTest {
 protected:
  [[nodiscard]] session::RunOptions options() const {
    session::RunOptions run;
    run.scene = tiny_scene();
    return run;
  }
  /// Opens the tiny scene with this many pixels, such as "8x50".
  [[nodiscard]] session::Session open(const std::string& size) {
    session::RunOptions run = options();
    run.size = size;
    return session::open_session(run, std::nullopt, machine_, 0, progress_, 0);
  }

  const render::Machine machine_ = session::make_machine("cpu");
  app::TerminalProgress progress_{false};
};

// 200 rows take 0.4 s or more. The limit is a tenth of that: the run ends between tiles, which have 4, 8, 16 … rows,
// and reports how long all would take.
TEST_F(SlowMethods, EndBetweenTiles) {
  const session::Session session = open("8x200");
  const auto none = [](const session::TileResult&) {};
  Slow slow;
  session::RunPlan plan{.lights = session.lights, .discard_first = true, .most_seconds = 0.04};
  try {
    session::run_method(slow, session, plan, none, progress_);
    ADD_FAILURE() << "the run was not stopped at the limit";
  } catch (const session::TakesTooLong& found) {
    EXPECT_GT(found.seconds, plan.most_seconds);
  }
  ASSERT_FALSE(slow.tiles.empty());
  EXPECT_EQ(slow.tiles.front(), 4U);
  for (std::size_t i = 1; i < slow.tiles.size(); ++i) EXPECT_LE(slow.tiles[i], 2 * slow.tiles[i - 1]);
  EXPECT_LE(std::reduce(slow.tiles.begin(), slow.tiles.end()), 100U) << "beyond the limit there is one tile at most";
  // With enough time, the timed run is in one piece.
  Slow patient;
  plan.most_seconds = 1e6;
  EXPECT_EQ(session::run_method(patient, session, plan, none, progress_).times.runs, 1U);
  EXPECT_THAT(patient.tiles, testing::ElementsAre(4U, 8U, 16U, 32U, 64U, 76U, 200U));
  // Without a discarded first run there is no limit.
  Slow first;
  plan.most_seconds = 0;
  plan.discard_first = false;
  EXPECT_NO_THROW(session::run_method(first, session, plan, none, progress_));
}

// Fifty rows take 0.1 s or more: after the first run, which is always made, a second one does not fit into 0.15 s.
TEST_F(SlowMethods, RunAsOftenAsFits) {
  const session::Session session = open("8x50");
  session::RunPlan plan{.lights = session.lights, .runs = 5, .run_seconds = 0.15};
  const auto none = [](const session::TileResult&) {};
  Slow slow;
  EXPECT_EQ(session::run_method(slow, session, plan, none, progress_).times.runs, 1U);
  plan.run_seconds = std::numeric_limits<double>::infinity();
  EXPECT_EQ(session::run_method(slow, session, plan, none, progress_).times.runs, 5U);
}

// Sixty-four tiles of 80 ms would take 5 s, but one tile takes 80 ms, below the limit, so the method is kept. Its
// warm-up time is not that of the first run's six tiles.
TEST_F(SlowMethods, AreNotThoseWhoseTilesCostMuch) {
  const session::Session session = open("8x200");
  Slow slow(80, 0);
  const session::RunPlan plan{.lights = session.lights, .discard_first = true, .most_seconds = 0.2};
  const auto none = [](const session::TileResult&) {};
  const session::MethodRun done = session::run_method(slow, session, plan, none, progress_);
  EXPECT_LE(slow.tiles.size(), 10U);
  // The last tile is the timed run.
  const double first = std::reduce(slow.seconds.begin(), slow.seconds.end() - 1), timed = slow.seconds.back();
  EXPECT_LT(done.times.warmup.value(), 0.5 * (first - timed)) << "this is what the additional tiles took";
}

// Slow methods of a group are left out by name, and the others' results keep their places; a named method is kept.
TEST_F(SlowMethods, AreLeftOutOfGroupsByName) {
  session::ComparisonOptions comparison;
  comparison.methods = session::parse_methods("raytrace,geometry");
  comparison.writes = false;
  comparison.reference_samples = "16";
  comparison.runs = 1;
  comparison.most_seconds = 0;
  session::RunOptions run = options();
  run.light_samples = "16";
  Warnings warnings;
  const compare::Metrics metrics = session::compare_methods(scenes::read_scene(run.scene), run, comparison, warnings);
  ASSERT_EQ(metrics.methods.size(), 1U);
  EXPECT_EQ(metrics.methods.front().entry, "raytrace");
  ASSERT_FALSE(metrics.left_out.empty());
  EXPECT_EQ(metrics.left_out.front().limit, 0);
  EXPECT_THAT(compare::to_json(metrics).at("leftOut").dump(), HasSubstr("edge-scatter"));
  EXPECT_TRUE(metrics.methods.front().error.has_value());
  EXPECT_THAT(warnings.said, Contains(AllOf(HasSubstr("edge-scatter is left out"), HasSubstr("--methods"))));
  EXPECT_THAT(warnings.said, Not(Contains(HasSubstr("raytrace is left out"))));
}

}  // namespace
}  // namespace penumbra::tests
