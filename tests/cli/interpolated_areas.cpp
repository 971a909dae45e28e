// SPDX-License-Identifier: Apache-2.0
// Tests areas at several view samples per pixel, most of which are interpolated: against known functions, and pictures
// against those with every view sample evaluated.
#include "tests/cli/program.hpp"

#include "base/exr.hpp"
#include "session/pictures/interpolated_areas.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace penumbra::tests {
namespace {

using testing::HasSubstr;
using visibility::ViewSamples;

/// A method whose V is a function of p and whose form factor is half of V; it counts the view samples that it
/// evaluates.
class Function final : public visibility::Method {
 public:
  explicit Function(std::function<double(const glm::vec3&)> function) : function_(std::move(function)) {
    description_.output = visibility::Output::radiance;
  }
  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& /*scene*/) override {}
  void prepare_light(const visibility::Light& /*light*/) override {}
  void prepare_view(const ViewSamples& samples) override { samples_ = &samples; }
  [[nodiscard]] std::uint32_t max_tile_rows() const override { return 5; }
  void evaluate(const visibility::Tile& tile) override {
    shares_.clear();
    for (std::size_t i = 0; i < std::size_t{tile.row_count} * samples_->width; ++i) {
      const std::size_t at = std::size_t{tile.first_row} * samples_->width + i;
      const bool shown = samples_->triangle[at] != ViewSamples::kBackground;
      asked_ += shown ? 1 : 0;
      shares_.push_back(shown ? static_cast<float>(function_(samples_->p[at])) : 1.0f);
    }
  }
  void read_visibility(std::span<float> visibility) override { std::ranges::copy(shares_, visibility.begin()); }
  void read_form_factors(std::span<glm::dvec3> form_factors) override {
    for (std::size_t i = 0; i < form_factors.size(); ++i) form_factors[i] = glm::dvec3(double{shares_[i]} / 2);
  }

  [[nodiscard]] std::size_t asked() const { return asked_; }

 private:
  std::function<double(const glm::vec3&)> function_;
  visibility::MethodDescription description_;
  const ViewSamples* samples_ = nullptr;
  std::vector<float> shares_;
  std::size_t asked_ = 0;
};

/// Two surfaces that face the viewer: the left one at height 0, the right one, from a column on, lower by `gap` pixels.
/// p is in pixels.
class InterpolatedAreas : public testing::Test {
 protected:
  static constexpr std::uint32_t kSide = 4, kWidth = 8 * kSide, kHeight = 6 * kSide;
  static constexpr double kTolerance = session::kPixelTolerance;

  InterpolatedAreas() {
    scene_.object = {0, 1};
    scene_.plane = {0, 1};
    samples_.width = kWidth;
    samples_.height = kHeight;
    set_gap(kWidth, 0);
  }
  void set_gap(std::uint32_t column, float gap) {
    samples_.triangle.clear();
    samples_.p.clear();
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        samples_.triangle.push_back(x < column ? 0 : 1);
        samples_.p.emplace_back(static_cast<float>(x) / kSide, static_cast<float>(y) / kSide, x < column ? 0 : -gap);
      }
    }
    const std::size_t size = samples_.p.size();
    samples_.n.assign(size, glm::vec3(0, 0, 1));
    samples_.depth.assign(size, 1);
    samples_.facing.assign(size, 1);
  }
  /// Returns the largest difference from the function; the counter and `asked_` are those of this call.
  double largest_error(const std::function<double(const glm::vec3&)>& function) {
    Function method(function);
    session::InterpolatedAreas areas(method, scene_, kSide, kTolerance);
    areas.prepare_light({});
    areas.prepare_view(samples_);
    double error = 0;
    std::vector<float> shares;
    std::vector<glm::dvec3> factors;
    const std::uint32_t rows = 3 * kSide;  // more than one tile
    for (std::uint32_t row = 0; row < kHeight; row += rows) {
      areas.evaluate({row, rows});
      shares.resize(std::size_t{rows} * kWidth);
      factors.resize(shares.size());
      areas.read_visibility(shares);
      areas.read_form_factors(factors);
      for (std::size_t i = 0; i < shares.size(); ++i) {
        const std::size_t at = std::size_t{row} * kWidth + i;
        const bool shown = samples_.triangle[at] != ViewSamples::kBackground;
        const double truth = shown ? double{static_cast<float>(function(samples_.p[at]))} : 1;
        error = std::max(error, std::abs(double{shares[i]} - truth));
        EXPECT_NEAR(factors[i].x, shown ? double{shares[i]} / 2 : 0, 1e-6) << at;
      }
    }
    asked_ = method.asked();
    interpolated_ = areas.counters().at("viewSamplesInterpolated");
    return error;
  }

  /// Numbers of view samples: all; those in the middles of pixels; those between them, in cells with four corners.
  static constexpr std::size_t kAll = std::size_t{kWidth} * kHeight, kCorners = kAll / (kSide * kSide),
                               kBetween = std::size_t{kWidth - kSide} * (kHeight - kSide) * 15 / 16,
                               kLeast = kAll - kBetween;  ///< those that must be evaluated

  visibility::SceneFloats scene_;
  ViewSamples samples_;
  std::size_t asked_ = 0, interpolated_ = 0;
};

TEST_F(InterpolatedAreas, AreALinearFunctionItself) {
  EXPECT_LT(largest_error([](const glm::vec3& p) { return 0.1 + 0.05 * double{p.x} + 0.06 * double{p.y}; }), 1e-6);
  EXPECT_EQ(asked_, kLeast);
  EXPECT_EQ(interpolated_, kBetween);
  EXPECT_GT(asked_, kCorners) << "and those at the picture's border";
}

TEST_F(InterpolatedAreas, LookAtEachViewSampleNearAStep) {
  EXPECT_EQ(largest_error([](const glm::vec3& p) { return p.x < 3.3f ? 1 : 0; }), 0);
  EXPECT_GT(asked_, kLeast);
  EXPECT_LT(asked_, kAll * 8 / 10);
}

/// For c x² the second difference D is 2c, and bilinear interpolation is off by at most a quarter of c.
TEST_F(InterpolatedAreas, ErrByNoMoreThanTheTolerance) {
  const auto parabola = [](double c) {
    return [c](const glm::vec3& p) { return 0.5 + c * (double{p.x} - 4) * (double{p.x} - 4) / 16; };
  };
  const double c = 15.9 * 4 * kTolerance;  // 2c / 16 · 1/8 is just below the tolerance
  const double below = largest_error(parabola(c));
  EXPECT_LE(below, kTolerance);
  EXPECT_GT(below, kTolerance / 2) << "in a cell's middle";
  EXPECT_GT(interpolated_, kAll / 2);
  EXPECT_EQ(largest_error(parabola(c * 1.05)), 0) << "just above it";
  EXPECT_EQ(asked_, kAll);
}

/// A shadow may begin between two pixels at a contact of two surfaces, such as a wall on a floor.
TEST_F(InterpolatedAreas, AreContinuedToTheEdgeOfASurfaceUnlessAnotherIsNear) {
  constexpr std::uint32_t kColumn = 3 * kSide + 1;
  const auto both = [](const glm::vec3& p) { return p.z == 0 ? 0.2 + 0.1 * double{p.x} : 0.9 - 0.1 * double{p.x}; };
  set_gap(kColumn, 100);
  EXPECT_LT(largest_error(both), 1e-6);
  EXPECT_EQ(asked_, kLeast);
  set_gap(kColumn, 0.5);
  EXPECT_LT(largest_error(both), 1e-6);
  EXPECT_GT(asked_, kLeast + std::size_t{kHeight} * 2);
  // A shadow that contains no corner.
  const auto contact = [&](const glm::vec3& p) { return p.z == 0 && p.x > (kColumn - 1.5f) / kSide ? 0.0 : both(p); };
  EXPECT_LT(largest_error(contact), 1e-6);
}

TEST_F(InterpolatedAreas, AreOneWhereThereIsNothing) {
  set_gap(3 * kSide + 1, 100);
  for (std::int32_t& triangle : samples_.triangle) triangle = triangle == 1 ? ViewSamples::kBackground : 0;
  EXPECT_LT(largest_error([](const glm::vec3& p) { return 0.2 + 0.1 * double{p.x}; }), 1e-6);
}

using InterpolatedPictures = ProgramTest;

/// Scenes with contacts, thin penumbrae and smooth meshes, at 16 view samples per pixel, are compared with pictures
/// whose every view sample is evaluated. The error of a pixel is a mean of errors, whose estimates are at most the
/// tolerance: measured, the mean is a quarter of it, and a kink between corners costs a pixel 0.03.
TEST_F(InterpolatedPictures, DifferLittleFromThoseWhoseEveryViewSampleIsEvaluated) {
  for (const char* scene : {"contact", "room"}) {
    SCOPED_TRACE(scene);
    const std::string file = std::string(PENUMBRA_SCENES) + "/" + scene + ".json";
    const auto picture = [&](const char* tolerance) {
      const Outcome outcome = run({"render", file, "-o", path("a.exr"), "--size", "96x72", "--pixel-samples", "16",
                                   "--pixel-tolerance", tolerance, "--stats", path("a.json")});
      EXPECT_EQ(outcome.code, 0) << outcome.err;
      return read_exr(path("a.exr"));
    };
    const ExrFile all = picture("0");
    EXPECT_THAT(read("a.json"), testing::Not(HasSubstr("viewSamplesInterpolated")));
    const ExrFile few = picture("0.002");
    const auto counters = nlohmann::json::parse(read("a.json")).at("counters");
    EXPECT_GT(counters.at("viewSamplesInterpolated"), 96 * 72 * 16 / 4);
    const std::vector<float>&a = all.floats.at("V"), &b = few.floats.at("V");
    double square = 0, most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double error = std::abs(double{a[i]} - double{b[i]});
      square += error * error;
      most = std::max(most, error);
    }
    EXPECT_LT(std::sqrt(square / static_cast<double>(a.size())), session::kPixelTolerance / 4);
    EXPECT_LT(most, 0.03);
  }
}

TEST_F(InterpolatedPictures, RefuseWhatIsNoTolerance) {
  const std::string scene = std::string(PENUMBRA_SCENES) + "/contact.json";
  for (const char* wrong : {"-1", "1.5", "nan", "much"}) {
    const Outcome outcome =
        run({"render", scene, "-o", path("a.exr"), "--pixel-samples", "4", "--pixel-tolerance", wrong});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("--pixel-tolerance " + std::string(wrong)));
  }
  EXPECT_THAT(run({"render", scene, "-o", path("a.exr"), "--pixel-tolerance", "0.1"}).err,
              HasSubstr("--pixel-samples"));
}

}  // namespace
}  // namespace penumbra::tests
