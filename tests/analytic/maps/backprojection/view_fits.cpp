// SPDX-License-Identifier: Apache-2.0
// Tests backprojecting methods with maps fitted to a camera's view: the same bits where the camera sees everything;
// where it sees little, no caster that shades the view is lost, and errors are smaller.

#include "tests/analytic/maps/backprojection_scenes.hpp"

#include "base/error.hpp"
#include "reference/methods.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

struct Fitted {
  std::string name;
  Factory make;
  MethodOptions more;
};

class BackprojectedViews : public MapsTest {
 protected:
  static std::vector<Fitted> methods() {
    return {{"backproject", maps::make_backproject, {}},
            {"backproject, layers", maps::make_backproject, {{"layers", "2"}, {"depth", "midpoint"}}},
            {"backproject-peel", maps::make_backproject_peel, {{"samples", "0"}}},
            {"bitmask", maps::make_bitmask, {}},
            {"contour", maps::make_contour, {}},
            {"packet", maps::make_packet, {}},
            {"packet, sublights", maps::make_packet, {{"sublights", "2"}}},
            {"soft-shadow-map", maps::make_soft_shadow_map, {}},
            {"soft-shadow-map, passes", maps::make_soft_shadow_map, {{"passes", "2"}, {"form", "scatter"}}}};
  }
  /// A wide floor under a light at 5. A low plate is over its middle. A high one is outside the directions in which a
  /// camera at the middle sees the floor, but hides a part of the light from there.
  static scenes::Scene wide_floor(const glm::dvec3& eye, double fov) {
    scenes::Scene scene;
    add_quad(scene, {0, 0, 0}, {6, 0, 0}, {0, 0, -6}).casts_shadow = false;
    add_quad(scene, {0.2, 1.2, 0.1}, {0.5, 0, 0.1}, {0.1, 0, -0.4}).receives_shadow = false;
    add_quad(scene, {1.3, 3.5, 0}, {0.6, 0, 0}, {0, 0, -1.4}).receives_shadow = false;
    scene.lights.push_back(ceiling_light(5, 1));
    scene.cameras.push_back(camera(eye, {0, 0, 0}, fov));
    return scene;
  }
  static Stage far_away() { return Stage(wide_floor({0, 14, 22}, 60), 48, 40, light_samples(64)); }
  static Stage close() { return Stage(wide_floor({0, 1, 3}, 30), 48, 40, light_samples(64)); }

  static MethodOptions with(MethodOptions options, const MethodOptions& more) {
    for (const auto& [key, value] : more) options[key] = value;
    return options;
  }
  static double off(const Stage& stage, const Masks& found, const Masks& right) {
    return rmse(
        stage, [&](std::size_t i) { return is_on_floor(stage, i); },
        [&](std::size_t i) { return static_cast<double>(found.visibility[i] - right.visibility[i]); });
  }
  static bool is_on_floor(const Stage& stage, std::size_t i) {
    return stage.samples.triangle[i] >= 0 &&
           stage.floats.object[static_cast<std::size_t>(stage.samples.triangle[i])] == 0;
  }
};

TEST_F(BackprojectedViews, AViewOfAllReceiversIsTheSame) {
  const Stage stage = far_away();
  for (const auto& [name, make, more] : methods()) {
    const MethodOptions options = with(more, {{"size", "64"}});
    const Masks all = run(make, stage, options);
    const Masks seen = run(make, stage, with(options, {{"fit", "view"}, {"body", "frustum"}}));
    EXPECT_EQ(seen.visibility, all.visibility) << name;
    EXPECT_EQ(seen.words, all.words) << name;
    EXPECT_GT(std::ranges::count_if(all.visibility, [](float v) { return v < 0.9F; }), 20) << name;
  }
}

// The high plate is in the map, although no visible receiver is in its direction: without it errors would be larger.
TEST_F(BackprojectedViews, NothingThatShadesASmallPartOfAFloorIsLost) {
  const Stage stage = close();
  const Masks right = tests::run(*reference::make_exact({}), stage);
  for (const auto& [name, make, more] : methods()) {
    const double all = off(stage, run(make, stage, with(more, {{"size", "48"}})), right);
    const auto method = make(device(), with(more, {{"size", "48"}, {"fit", "view"}}));
    const Masks found = run(*method, stage);
    fmt::print("{}: RMSE {:.4f} of all receivers, {:.4f} of what is seen\n", name, all, off(stage, found, right));
    EXPECT_LT(off(stage, found, right), 0.9 * all) << name;
    EXPECT_EQ(run(*method, stage, 7).visibility, found.visibility) << name << ": tiles change nothing";
    const MethodOptions kept{{"size", "48"}, {"fit", "view"}, {"body", "frustum"}, {"snap", "on"}};
    EXPECT_LT(off(stage, run(make, stage, with(more, kept)), right), 1.1 * all) << name;
  }
}

// A method keeps nothing of its previous view.
TEST_F(BackprojectedViews, AnotherViewHasOtherMaps) {
  const Stage first = far_away(), second = close();
  for (const auto& [name, make, more] : methods()) {
    const MethodOptions options = with(more, {{"size", "64"}, {"fit", "view"}});
    const auto method = make(device(), options);
    run(*method, first);
    method->prepare_view(second.samples);
    std::vector<float> found(second.samples.size());
    const std::uint32_t rows = method->max_tile_rows();
    for (std::uint32_t row = 0; row < second.samples.height; row += rows) {
      const std::uint32_t count = std::min(rows, second.samples.height - row);
      method->evaluate({row, count});
      method->read_visibility(
          std::span(found).subspan(std::size_t{row} * second.samples.width, std::size_t{count} * second.samples.width));
    }
    EXPECT_EQ(found, run(make, second, options).visibility) << name;
  }
}

TEST_F(BackprojectedViews, PixelsThatAreLeftOutAreFilledIn) {
  const Stage stage = close();
  const MethodOptions options{{"size", "128"}, {"fit", "view"}, {"subsample", "2"}, {"subsampleBy", "grid"}};
  for (const Factory& make : {Factory(maps::make_contour), Factory(maps::make_backproject)}) {
    const Masks all = run(make, stage, {{"size", "128"}, {"fit", "view"}});
    EXPECT_LT(off(stage, run(make, stage, options), all), 0.02);
  }
}

TEST_F(BackprojectedViews, OtherFitsAreRefused) {
  for (const auto& [name, make, more] : methods()) {
    for (const char* fit : {"cascades", "tiles", "lispsm", "tsm", "psm", "logpsm", "faces"}) {
      EXPECT_THROW(make(device(), with(more, {{"fit", fit}})), UsageError) << name << ", " << fit;
    }
  }
}

}  // namespace
}  // namespace penumbra::tests
