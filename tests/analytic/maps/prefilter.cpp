// SPDX-License-Identifier: Apache-2.0
// Tests the structures from which means over windows are read: summed areas, mip levels and N-buffers, against twins,
// bit by bit.

#include "maps/products/map_frame.hpp"
#include "maps/products/nearest_caster.hpp"
#include "maps/products/prefilter.hpp"
#include "selftest/map_checks.hpp"
#include "selftest/prefilter_checks.hpp"
#include "tests/analytic/maps/centre_maps.hpp"
#include "tests/unit/passed.hpp"

#include <array>
#include <numbers>
#include <random>

namespace penumbra::tests {
namespace {

class Prefilters : public MapsTest {};

TEST_F(Prefilters, SummedAreasAreExactModulo32BitsAtAnySize) {
  std::mt19937 random(1);
  for (const std::uint32_t size : {8U, 9U, 100U, 257U}) {
    std::vector<std::uint32_t> words(std::size_t{3} * size * size);
    for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random());  // most sums wrap around
    expect_passed(selftest::check_summed_areas(device(), words, size));
  }
}

// Eisemann et al. 2009, section 5.2.2.3: sums of many values lose precision in float32, so 32-bit integers (fixed
// point) are used beyond some size.
TEST(SummedAreaTables, OfFloatsLoseWhatIntegersKeep) {
  constexpr std::uint32_t kSide = 2048, kBits = 10, kBox = 4;  // 2048² digits of 10 bits: 2³²
  std::mt19937 random(2);
  std::vector<float> floats(std::size_t{kSide} * kSide), float_sums(floats.size());
  std::vector<std::uint32_t> digits(floats.size());
  for (std::size_t i = 0; i < floats.size(); ++i) {
    digits[i] = 512 + static_cast<std::uint32_t>(random() % 512);
    floats[i] = static_cast<float>(digits[i]) / static_cast<float>(1U << kBits);
  }
  for (std::uint32_t y = 0; y < kSide; ++y) {
    float row = 0;
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const std::size_t at = std::size_t{y} * kSide + x;
      row += floats[at];
      float_sums[at] = row + (y > 0 ? float_sums[at - kSide] : 0);
    }
  }
  const std::vector<std::uint32_t> sums = selftest::summed_areas(digits, kSide);
  double worst_float = 0;
  for (std::uint32_t k = 0; k < 2000; ++k) {
    const std::uint32_t x = 1 + static_cast<std::uint32_t>(random() % (kSide - kBox - 1)),
                        y = 1 + static_cast<std::uint32_t>(random() % (kSide - kBox - 1));
    const auto corner = [&](const auto& table, std::uint32_t i, std::uint32_t j) {
      return table[(std::size_t{y} + j - 1) * kSide + x + i - 1];
    };
    std::uint32_t truth = 0;
    for (std::uint32_t j = 0; j < kBox; ++j) {
      for (std::uint32_t i = 0; i < kBox; ++i) truth += digits[(std::size_t{y} + j) * kSide + x + i];
    }
    const std::uint32_t box =
        corner(sums, kBox, kBox) - corner(sums, 0, kBox) - corner(sums, kBox, 0) + corner(sums, 0, 0);
    EXPECT_EQ(box, truth);
    const float mean = (corner(float_sums, kBox, kBox) - corner(float_sums, 0, kBox) - corner(float_sums, kBox, 0) +
                        corner(float_sums, 0, 0)) /
                       (kBox * kBox);
    worst_float = std::max(worst_float, std::abs(static_cast<double>(mean) - truth / 1024.0 / (kBox * kBox)));
  }
  RecordProperty("worstFloatMean", std::to_string(worst_float));
  EXPECT_GT(worst_float, 1e-3);
}

/// A floor and a sphere under a square light; with `hemicube`, also a wall up to the light (the map has five faces).
scenes::Scene scene_of(bool hemicube) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2}).casts_shadow = false;  // leaves texels empty
  add_object(scene, "sphere", sphere({0.3, 1, 0.2}, 0.6, 8));
  if (hemicube) add_quad(scene, {2, 2, 0}, {0, 2, 0}, {0, 0, 2});
  scene.lights.push_back(ceiling_light(3, 0.5));
  scene.cameras.push_back(camera({0, 3, 8}, {0, 1, 0}));
  return scene;
}

TEST_F(Prefilters, TablesAreSumsOfTheValuesDigits) {
  for (const bool hemicube : {false, true}) {
    const Stage stage(scene_of(hemicube), 4, 4, light_samples(1));
    ASSERT_EQ(CentreMaps(device(), stage, 8).fitted.faces, hemicube ? 5U : 1U);
    for (const std::uint32_t size : {32U, 51U}) {
      expect_passed(selftest::check_prefilter_tables(device(), stage, size));
    }
  }
}

// Mip levels and N-buffers, from their finest level up, must have the same sums of four in the same order as the twin.
TEST_F(Prefilters, LevelsAreMeansOfTheLevelBefore) {
  for (const bool hemicube : {false, true}) {
    const Stage stage(scene_of(hemicube), 4, 4, light_samples(1));
    for (const maps::PrefilterKind kind : {maps::PrefilterKind::pyramid, maps::PrefilterKind::windows}) {
      for (const std::uint32_t size : {8U, 32U, 51U}) {
        expect_passed(selftest::check_prefilter_levels(device(), stage, size, kind));
      }
    }
  }
}

TEST_F(Prefilters, ASizeThatNoBufferHoldsIsRefusedAndTheLargestThatFitsIsNamed) {
  const std::uint64_t most = device().limits().max_storage_buffer_range;
  maps::PrefilterOptions options{.kind = maps::PrefilterKind::table,
                                 .functions = std::vector<maps::PrefilterFunction>(300)};
  std::uint32_t size = 16;
  while (size < 16384 && maps::prefilter_layout(options, size, 1, most)) size *= 2;
  ASSERT_FALSE(maps::prefilter_layout(options, size, 1, most));
  const Stage stage(scene_of(false), 4, 4, light_samples(1));
  maps::NearestCaster nearest(device());
  maps::MapFrame frame(device());
  maps::Prefilter product(device(), options, {.nearest = &nearest, .frame = &frame});
  const CentreMaps maps(device(), stage, 16);
  maps::MapSet set = maps.set(stage);
  set.size = size;
  try {
    render::Commands commands(device());
    product.record(commands, set);
    ADD_FAILURE() << size << " is too large";
  } catch (const ResourceError& error) {
    const std::string message = error.what();
    const auto named = static_cast<std::uint32_t>(std::stoul(message.substr(message.rfind("size=") + 5)));
    EXPECT_TRUE(maps::prefilter_layout(options, named, 1, most)) << message;
    EXPECT_FALSE(maps::prefilter_layout(options, named + 1, 1, most)) << message;
  }
}

// A default size becomes the largest multiple of 64 that the buffers hold: no smaller than needed, the default itself
// where it fits, and 64 where nothing fits.
TEST(PrefilterSizes, AreReducedToWhatBuffersHold) {
  const maps::PrefilterOptions series{.kind = maps::PrefilterKind::windows,
                                      .functions = std::vector<maps::PrefilterFunction>(65)};
  for (const std::uint32_t faces : {1U, 4U}) {
    for (const std::uint64_t bytes : {std::uint64_t{1} << 24, std::uint64_t{1} << 27, std::uint64_t{1} << 31}) {
      const std::uint32_t size = maps::size_that_fits(series, 1024, faces, bytes);
      EXPECT_TRUE(maps::prefilter_layout(series, size, faces, bytes)) << size;
      EXPECT_TRUE(size == 1024 || !maps::prefilter_layout(series, size + 64, faces, bytes)) << size;
      EXPECT_EQ(size % 64, 0U);
    }
  }
  EXPECT_EQ(maps::size_that_fits(series, 1000, 1, std::uint64_t{1} << 33), 1000U);
  EXPECT_EQ(maps::size_that_fits(series, 1024, 1, 1024), 64U);
}

// The box of a disk, an ellipse or a polygon has the light's second moments; a rectangle's box is the rectangle itself.
TEST(LightBox, HasTheLightsOwnMoments) {
  scenes::Scene scene = scene_of(false);
  struct Shape {
    decltype(scenes::AreaLight::shape) shape;
    glm::dvec2 half;
  };
  // A right triangle with legs of 2 along the axes: the variance of x is 2²/18.
  for (const Shape& one :
       {Shape{scenes::Rectangle{{0, 3, 0}, {0.7, 0, 0}, {0, 0, 0.2}}, {0.7, 0.2}},
        Shape{scenes::Disk{{0, 3, 0}, {0, -1, 0}, 0.5}, glm::dvec2(std::sqrt(0.75) * 0.5)},
        Shape{scenes::Ellipse{{0, 3, 0}, {0.4, 0, 0}, {0.3, 0, 0.2}}, std::sqrt(0.75) * glm::dvec2(0.5, 0.2)},
        Shape{scenes::Polygon{{{0, 3, 0}, {2, 3, 0}, {0, 3, 2}}}, glm::dvec2(std::sqrt(3 * 4.0 / 18))}}) {
    scene.lights.front().shape = one.shape;
    const Stage stage(scene, 4, 4, light_samples(1));
    const glm::dvec2 half = maps::half_box(stage.light, maps::light_basis(stage.light));
    EXPECT_NEAR(half.x, one.half.x, 1e-6);
    EXPECT_NEAR(half.y, one.half.y, 1e-6);
  }
}

// Occluders are searched for between the light's bounds: if these were too wide, occluders would hide light that is not
// there; if too narrow, some would be missed. Points of the sampled outline are inside it by at most 1 - cos(pi / 4096)
// of its width.
TEST(LightBounds, HoldTheLightAndNoMore) {
  scenes::Scene scene = scene_of(false);
  for (const decltype(scenes::AreaLight::shape)& shape :
       {decltype(scenes::AreaLight::shape)(scenes::Rectangle{{0, 3, 0}, {0.7, 0, 0}, {0.1, 0, 0.2}}),
        {scenes::Disk{{0, 3, 0}, {0, -1, 0}, 0.5}},
        {scenes::Disk{{0, 3, 0}, {0.3, -1, 0.2}, 0.5}},
        {scenes::Ellipse{{0, 3, 0}, {0.4, 0, 0}, {0.3, 0, 0.2}}},
        {scenes::Polygon{{{0, 3, 0}, {2, 3, 0}, {1.5, 3, 1}, {0, 3, 2}}}}}) {
    scene.lights.front().shape = shape;
    const Stage stage(scene, 4, 4, light_samples(1));
    const maps::LightBasis basis = maps::light_basis(stage.light);
    std::vector<glm::dvec3> outline;
    if (stage.light.kind == visibility::LightKind::disk || stage.light.kind == visibility::LightKind::ellipse) {
      const visibility::LightFrame frame = visibility::light_frame(stage.light);
      for (int i = 0; i < 4096; ++i) {
        const double angle = 2 * std::numbers::pi * i / 4096;
        outline.push_back(frame.center + std::cos(angle) * frame.u + std::sin(angle) * frame.v);
      }
    } else {
      outline.assign(stage.light.outline.begin(), stage.light.outline.end());
    }
    glm::dvec2 lower(1e30), upper(-1e30);
    for (const glm::dvec3& point : outline) {
      const glm::dvec3 relative = point - basis.center;
      const glm::dvec2 at(glm::dot(relative, basis.u), glm::dot(relative, basis.v));
      lower = glm::min(lower, at);
      upper = glm::max(upper, at);
    }
    const maps::LightBounds bounds = maps::light_bounds(stage.light, basis);
    for (const int axis : {0, 1}) {
      EXPECT_NEAR(bounds.lower[axis], lower[axis], 1e-6);
      EXPECT_NEAR(bounds.upper[axis], upper[axis], 1e-6);
    }
  }
}

}  // namespace
}  // namespace penumbra::tests
