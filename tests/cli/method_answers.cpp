// SPDX-License-Identifier: Apache-2.0
// Tests that the host refuses a method's V outside of [0, 1], and form factors that are negative or no numbers, before
// a file is written.
#include "app/process/terminal_progress.hpp"
#include "base/error.hpp"
#include "session/machine.hpp"
#include "session/runner.hpp"
#include "session/session.hpp"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace penumbra::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Gives V = 0.5 everywhere, except for one value at one view sample.
class OneWrong final : public visibility::Method {
 public:
  OneWrong(float wrong, visibility::Output output, const glm::dvec3& form_factor)
      : wrong_(wrong), form_factor_(form_factor) {
    description_.name = "one-wrong";
    description_.output = output;
    description_.lights = {visibility::LightKind::rectangle};
  }
  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& /*scene*/) override {}
  void prepare_light(const visibility::Light& /*light*/) override {}
  void prepare_view(const visibility::ViewSamples& samples) override { width_ = samples.width; }
  [[nodiscard]] std::uint32_t max_tile_rows() const override { return 4096; }
  void evaluate(const visibility::Tile& tile) override { first_row_ = tile.first_row; }
  void read_visibility(std::span<float> visibility) override {
    std::ranges::fill(visibility, 0.5F);
    if (first_row_ <= kRow) visibility[(kRow - first_row_) * width_ + kColumn] = wrong_;
  }
  void read_form_factors(std::span<glm::dvec3> form_factors) override { std::ranges::fill(form_factors, form_factor_); }
  void need(std::uint64_t bytes_per_triangle) { description_.bytes_per_triangle = bytes_per_triangle; }
  static constexpr std::uint32_t kRow = 25, kColumn = 24;  // of the tiny scene: the floor

 private:
  visibility::MethodDescription description_;
  float wrong_;
  glm::dvec3 form_factor_;
  std::uint32_t width_ = 0, first_row_ = 0;
};

class MethodAnswers : public ProgramTest {
 protected:
  static constexpr glm::dvec3 kQuarter{0.25};
  void run_with(float wrong, visibility::Output output, const glm::dvec3& form_factor = kQuarter) const {
    run_method(OneWrong(wrong, output, form_factor));
  }
  void run_method(OneWrong method) const {
    RunOptions options;
    options.scene = tiny_scene();
    const render::Machine machine = session::make_machine("cpu");
    app::TerminalProgress progress(false);
    const session::Session session = session::open_session(options, std::nullopt, machine, 0, progress, 0);
    session::run_method(
        method, session, {.lights = session.lights}, [](const session::TileResult&) {}, progress);
  }
  using RunOptions = session::RunOptions;
};

TEST_F(MethodAnswers, AMeshBeyondTheMemoryIsRefusedBeforeTheMethodRuns) {
  OneWrong method(-1, visibility::Output::scalar, kQuarter);
  method.need(std::uint64_t{1} << 50);  // a pebibyte
  EXPECT_THAT([&] { run_method(method); },
              ThrowsMessage<ResourceError>(AllOf(HasSubstr("one-wrong on "), HasSubstr(" triangles"))));
}

TEST_F(MethodAnswers, MustBeSharesOfALight) {
  using visibility::Output;
  for (const float wrong :
       {std::numeric_limits<float>::quiet_NaN(), -0.001F, 1.001F, std::numeric_limits<float>::infinity()}) {
    EXPECT_THAT([&] { run_with(wrong, Output::scalar); },
                ThrowsMessage<ResourceError>(AllOf(HasSubstr("one-wrong"), HasSubstr("pixel (24, 25)"))))
        << wrong;
  }
  EXPECT_NO_THROW(run_with(1.0F, Output::scalar));
  EXPECT_NO_THROW(run_with(0.0F, Output::radiance));
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(
      [&] {
        run_with(0.5F, Output::radiance, {0, none, 0});
      },
      ThrowsMessage<ResourceError>(HasSubstr("form factor")));
  EXPECT_THROW(run_with(0.5F, Output::radiance, {-0.01, 0, 0}), ResourceError);
}

}  // namespace
}  // namespace penumbra::tests
