// SPDX-License-Identifier: Apache-2.0
// Tests that pictures with several view samples per pixel are the same bits whether evaluated in bands of rows or at
// once.
#include "engines/vectors/scan_conversion.hpp"
#include "session/machine.hpp"
#include "session/options.hpp"
#include "session/pictures/frame_render.hpp"
#include "session/process/progress.hpp"
#include "session/session.hpp"
#include "visibility/view_samples.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::tests {
namespace {

class Silence final : public session::Progress {
 public:
  using Progress::advance;
  void begin(std::string /*stage*/, std::uint64_t /*steps*/) override {}
  void advance(std::uint64_t /*steps*/) override {}
  void clear() override {}
  void say(Level /*level*/, const std::string& /*message*/) override {}
};

session::RunOptions options_of(const std::string& scene) {
  session::RunOptions run;
  run.scene = std::string(PENUMBRA_SCENES) + "/" + scene;
  run.size = "40x70";
  return run;
}

struct Rendered {
  session::RenderedFrame picture;
  std::uint64_t left_out = 0;  // compare::LightCutoff::pairs
};

Rendered rendered(const session::RunOptions& run, session::Frame frame, std::uint64_t band_samples) {
  const render::Machine machine = session::make_machine("");
  const session::MethodWish wish;
  Silence silence;
  session::FrameRenderer renderer(run, wish, machine, silence);
  frame.band_samples = band_samples;
  renderer.render(session::read_session_scene(run, std::nullopt), frame, {}, 0);
  const compare::Stats stats = renderer.stats();
  return {renderer.take(), stats.light_cutoff ? stats.light_cutoff->pairs : 0};
}

void expect_same_in_bands(const session::RunOptions& run, const session::Frame& frame) {
  const auto [whole, left_out_of_whole] = rendered(run, frame, std::numeric_limits<std::uint64_t>::max());
  // A row of pixels has 40 times 16 view samples; room for 20 rows gives four bands of 17 or 18 rows.
  const auto [bands, left_out_of_bands] = rendered(run, frame, 40 * 16 * 20);
  EXPECT_EQ(bands.alpha, whole.alpha);
  EXPECT_EQ(bands.visibility, whole.visibility);
  EXPECT_EQ(bands.beauty, whole.beauty);
  EXPECT_EQ(bands.sum, whole.sum);
  EXPECT_EQ(left_out_of_bands, left_out_of_whole);
  EXPECT_EQ(frame.light_cutoff > 0, left_out_of_whole > 0);
  ASSERT_FALSE(whole.visibility.empty());
  const auto between = std::ranges::count_if(whole.visibility.front(), [](float v) { return v > 0 && v < 1; });
  EXPECT_GT(between, 100);
}

TEST(MeanBands, AreTheWholePicture) {
  for (const double tolerance : {session::kPixelTolerance, 0.0}) {
    for (const session::PixelFilter& filter :
         {session::PixelFilter{}, session::PixelFilter{session::PixelFilter::Kind::blackman_harris, 1.5}}) {
      session::Frame frame;
      frame.pixel_side = 4;
      frame.filter = filter;
      frame.pixel_tolerance = tolerance;
      expect_same_in_bands(options_of("room.json"), frame);
    }
  }
}

TEST(MeanBands, AreTheWholePictureUnderAWideFilter) {
  session::Frame frame;
  frame.pixel_side = 4;
  frame.filter = {session::PixelFilter::Kind::blackman_harris, 6};
  expect_same_in_bands(options_of("room.json"), frame);
}

TEST(MeanBands, AreTheWholePictureWithoutFaintLights) {
  for (const double tolerance : {session::kPixelTolerance, 0.0}) {
    session::Frame frame;
    frame.pixel_side = 4;
    frame.pixel_tolerance = tolerance;
    frame.light_cutoff = 0.25;
    expect_same_in_bands(options_of("room.json"), frame);
  }
}

TEST(MeanBands, AreTheWholePictureOfMoments) {
  const session::RunOptions run = options_of("contact.json");
  session::Frame frame;
  frame.pixel_side = 4;
  for (int i = 0; i < 2; ++i) {
    frame.moments.emplace_back([run, i] {
      session::PictureScene read{session::read_session_scene(run, std::nullopt)};
      for (scenes::Camera& camera : read.scene.cameras) camera.eye.x += 0.01 * i;
      return read;
    });
  }
  expect_same_in_bands(run, frame);
}

/// Some rows of a camera's picture have the view samples that the whole picture has there.
TEST(MeanBands, RowsOfACameraAreThoseOfItsPicture) {
  const scenes::Scene scene = session::read_session_scene(options_of("bunny.json"), std::nullopt);
  const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
  const auto whole_camera = visibility::make_camera(scene.cameras.front(), floats.origin, 90, 67);
  const visibility::ViewSamples whole = vectors::scan_view_samples(floats, whole_camera);
  for (const auto& [first, rows] : {std::pair{0u, 20u}, {20u, 31u}, {51u, 16u}}) {
    visibility::PinholeCamera camera = whole_camera;
    camera.first_row = first;
    camera.rows_of_picture = whole_camera.height;
    camera.height = rows;
    const visibility::ViewSamples some = vectors::scan_view_samples(floats, camera);
    ASSERT_EQ(some.size(), std::size_t{90} * rows);
    const std::ptrdiff_t skipped = std::ptrdiff_t{90} * first;
    const auto same = [&](const auto& values, const auto& all) {
      return std::equal(values.begin(), values.end(), all.begin() + skipped);
    };
    EXPECT_TRUE(same(some.triangle, whole.triangle));
    EXPECT_TRUE(same(some.p, whole.p));
    EXPECT_TRUE(same(some.n, whole.n));
    EXPECT_TRUE(same(some.depth, whole.depth));
    EXPECT_TRUE(same(some.facing, whole.facing));
  }
}

}  // namespace
}  // namespace penumbra::tests
