// SPDX-License-Identifier: Apache-2.0
// Contours against their closed form, in kernels and sub-lights.

#include "base/error.hpp"
#include "maps/host/map_fit.hpp"
#include "tests/agreement/differences.hpp"
#include "tests/analytic/maps/backprojection/contour_scenes.hpp"

#include <numbers>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

class MapsContour : public ContourTest {};

/// What contours hide under the parallel square: the texels whose centres it holds, with the corners cut off midway to
/// the next texels' centres, projected onto the light.
class OctagonTwin {
 public:
  /// `level`: blocks of 2^level texels a side are one, which shades if any of them does.
  OctagonTwin(const Stage& stage, std::uint32_t size, std::uint32_t level = 0) : stage_(&stage) {
    const maps::LightBasis basis = maps::light_basis(stage.light);
    const maps::LightBounds bounds = maps::light_bounds(stage.light, basis);
    const glm::vec3 centre(basis.center);
    const auto fitted = maps::fit_views(stage.floats, stage.light, basis, std::span(&centre, 1),
                                        {.size = size, .reach = glm::max(-bounds.lower, bounds.upper)});
    const maps::gpu::SideView& side = fitted.views.front().side[0];
    basis_ = basis;
    glm::dvec2 lower(1e30), upper(-1e30);
    for (std::size_t i = 6; i < 12; ++i) {  // the occluder's corners follow the floor's six
      const glm::dvec3 corner = basis.local(stage.floats.positions[i]);
      lower = glm::min(lower, glm::dvec2(corner) / corner.z);
      upper = glm::max(upper, glm::dvec2(corner) / corner.z);
      height_ = corner.z;
    }
    texel_ = (glm::dvec2(side.upper) - glm::dvec2(side.lower)) / static_cast<double>(size);
    // First and last texels whose centres it holds, or their blocks, and half a texel beyond: the contour.
    const double block = 1U << level;
    glm::dvec2 first = glm::ceil((lower - glm::dvec2(side.lower)) / texel_ - 0.5);
    glm::dvec2 last = glm::floor((upper - glm::dvec2(side.lower)) / texel_ - 0.5);
    first = glm::floor(first / block) - 0.5;
    last = glm::floor(last / block) + 0.5;
    texel_ *= block;
    const glm::dvec2 a = glm::dvec2(side.lower) + (first + 0.5) * texel_,
                     b = glm::dvec2(side.lower) + (last + 0.5) * texel_;
    const glm::dvec2 half = 0.5 * texel_;
    outline_ = {{a.x + half.x, a.y}, {b.x - half.x, a.y}, {b.x, a.y + half.y}, {b.x, b.y - half.y},
                {b.x - half.x, b.y}, {a.x + half.x, b.y}, {a.x, b.y - half.y}, {a.x, a.y + half.y}};
    if (stage.light.kind == visibility::LightKind::disk) {
      constexpr int kSides = 4096;  // circumscribed and inscribed differ in area by 2 (π / 4096)² = 1.2e-6
      for (int i = 0; i < kSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSides;
        light_.emplace_back(stage.light.radius * std::cos(angle), stage.light.radius * std::sin(angle));
      }
    } else if (stage.light.kind == visibility::LightKind::ellipse) {
      const auto [u, v] = maps::light_axes(stage.light, basis);
      for (int i = 0; i < 4096; ++i) {
        const double angle = 2 * std::numbers::pi * i / 4096;
        light_.push_back(std::cos(angle) * u + std::sin(angle) * v);
      }
    } else {
      for (const glm::vec3& corner : stage.light.outline) light_.emplace_back(basis.local(corner));
    }
  }
  [[nodiscard]] double visibility(std::size_t pixel) const {
    const glm::dvec3 p = basis_.local(stage_->samples.p[pixel]);
    std::vector<glm::dvec2> seen = light_;
    const double f = height_ * p.z / (p.z - height_);
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const glm::dvec2 a = (outline_[i] - glm::dvec2(p) / p.z) * f;
      const glm::dvec2 b = (outline_[(i + 1) % outline_.size()] - glm::dvec2(p) / p.z) * f;
      std::vector<glm::dvec2> inside;
      for (std::size_t k = 0; k < seen.size(); ++k) {
        const glm::dvec2 &s = seen[k], &t = seen[(k + 1) % seen.size()];
        const double left_s = cross(b - a, s - a), left_t = cross(b - a, t - a);
        if (left_s >= 0) inside.push_back(s);
        if ((left_s >= 0) != (left_t >= 0)) inside.push_back(s + (t - s) * (left_s / (left_s - left_t)));
      }
      seen = std::move(inside);
    }
    return 1 - area(seen) / area(light_);
  }

 private:
  static double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }
  static double area(const std::vector<glm::dvec2>& polygon) {
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    return std::abs(twice) / 2;
  }
  const Stage* stage_;
  maps::LightBasis basis_;
  double height_ = 0;
  glm::dvec2 texel_{0};
  std::vector<glm::dvec2> outline_, light_;
};

// An occluder of n × m texels is n · m − ½ texels large: each of its four corners is cut off by an eighth. Areas are
// rounded to 2⁻²² of the light for each of the edges, tangents to 2⁻²⁴ of the window's 1.6, which are 1e-6 of the
// light's width there; and a disk's swept angle, for which drivers may take 4,096 units in the last place, to 2.4e-4 at
// worst. What this driver takes is seen where about half of the light is hidden, and is no more where an edge grazes
// it: there a disk of another size shows, which edges through its middle hardly know of.
TEST_F(MapsContour, IsTheOctagonOfTheTexelsThatShade) {
  for (const int shape : {0, 1, 2, 3, 4}) {
    for (const std::uint32_t size : {33U, 96U}) {
      const Stage stage(under_shape(shape), 40, 40, light_samples(1));
      const ParallelSquare square(stage);
      const OctagonTwin twin(stage, size);
      const Masks found = run(maps::make_contour, stage, {{"size", std::to_string(size)}});
      double halved = 0, others = 0;
      std::size_t partly = 0, grazed = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        if (!square.on_floor(i)) continue;
        const double expected = twin.visibility(i);
        const bool half = expected > 0.25 && expected < 0.75;
        partly += expected > 0.01 && expected < 0.99 ? 1 : 0;
        grazed += (expected > 1e-5 && expected < 0.01) || (expected > 0.99 && expected < 1 - 1e-5) ? 1 : 0;
        double& largest = half ? halved : others;
        largest = std::max(largest, std::abs(static_cast<double>(found.visibility[i]) - expected));
      }
      EXPECT_GT(partly, 100U);
      EXPECT_GT(grazed, 3U);
      EXPECT_LT(std::max(halved, others), shape == 1 || shape == 4 ? 5e-4 : 4e-5)
          << "shape " << shape << ", size " << size;
      EXPECT_LT(others, 2 * halved + 4e-5) << "shape " << shape << ", size " << size;
      RecordProperty(fmt::format("shape {} size {}", shape, size), fmt::format("{:.2g}, {:.2g}", halved, others));
    }
  }
}

// A coarse level is a map of blocks at their nearest depths (Guennebaud et al. 2007).
TEST_F(MapsContour, ALevelIsTheOctagonOfItsBlocks) {
  const Stage stage(parallel_square(), 32, 32, light_samples(1));
  const ParallelSquare square(stage);
  for (const std::uint32_t level : {1U, 2U}) {
    const OctagonTwin twin(stage, 101, level);
    const Masks found = run(maps::make_contour, stage, {{"size", "101"}, {"level", std::to_string(level)}});
    std::size_t partly = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!square.on_floor(i)) continue;
      const double expected = twin.visibility(i);
      partly += expected > 0.01 && expected < 0.99 ? 1 : 0;
      EXPECT_NEAR(found.visibility[i], expected, 4e-5) << "level " << level;
    }
    EXPECT_GT(partly, 100U);
  }
}

// Packets, searches and walks find the contours of a level that a pixel finds alone, and of the two levels that a
// budget asks for; V lies between theirs.
TEST_F(MapsContour, LevelsAreTheSameForPacketsAndSearches) {
  for (const auto& scene : {ball_over_floor(1), plate_over_plate()}) {
    const Stage stage(scene, 20, 20, light_samples(1));
    const auto differing = [](const std::vector<float>& a, const std::vector<float>& b) {
      std::size_t count = 0;
      for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i] ? 1 : 0;
      return count;
    };
    const auto with = [&](const Factory& factory, MethodOptions options) {
      options.emplace("size", "96");
      return run(factory, stage, options).visibility;
    };
    std::vector<std::vector<float>> levels;
    for (const char* level : {"0", "1", "2", "3", "4"}) {
      levels.push_back(with(maps::make_contour, {{"level", level}}));
      EXPECT_EQ(differing(with(maps::make_packet, {{"level", level}}), levels.back()), 0U) << level;
      EXPECT_EQ(differing(with(maps::make_contour, {{"level", level}, {"search", "none"}}), levels.back()), 0U)
          << level;
    }
    EXPECT_EQ(with(maps::make_contour, {{"budget", "100000"}}), levels[0]);
    std::size_t between = 0, coarse = 0;
    for (const char* budget : {"40", "150"}) {
      const std::vector<float> stepped = with(maps::make_contour, {{"budget", budget}, {"blend", "off"}}),
                               blended = with(maps::make_contour, {{"budget", budget}});
      EXPECT_EQ(differing(with(maps::make_packet, {{"budget", budget}}),
                          with(maps::make_packet, {{"budget", budget}, {"packet", "1x1"}})),
                0U)
          << budget;
      for (std::size_t i = 0; i < stepped.size(); ++i) {
        bool one = false, two = false;
        for (std::size_t l = 0; l < levels.size(); ++l) {
          one = one || stepped[i] == levels[l][i];
          coarse += l > 0 && stepped[i] == levels[l][i] && stepped[i] != levels[0][i] ? 1 : 0;
          if (l == 0) continue;
          const float low = std::min(levels[l - 1][i], levels[l][i]), high = std::max(levels[l - 1][i], levels[l][i]);
          two = two || (blended[i] >= low - 1e-6F && blended[i] <= high + 1e-6F);
          between += blended[i] > low + 1e-3F && blended[i] < high - 1e-3F ? 1 : 0;
        }
        EXPECT_TRUE(one) << budget << ", pixel " << i;
        EXPECT_TRUE(two) << budget << ", pixel " << i;
      }
    }
    EXPECT_GT(coarse, 50U);
    EXPECT_GT(between, 30U);
  }
}

// Packets of 64 pixels with kernels of thousands of cells need more turns of loops than drivers for processors let a
// workgroup have: it is asked again by fewer rows, and neither V nor what is counted of packets shows that.
TEST_F(MapsContour, LoopsThatADriverCutsOffAreRunAgain) {
  const Stage stage(ball_over_floor(1), 16, 16, light_samples(1));
  const auto with = [&](const char* packet) {
    return counted(maps::make_packet, stage, {{"size", "512"}, {"packet", packet}, {"hierarchy", "off"}});
  };
  const auto many = with("8x8"), alone = with("1x1");
  EXPECT_EQ(many.masks.visibility, alone.masks.visibility);
  EXPECT_EQ(many.count("kernelCells"), alone.count("kernelCells"));
  EXPECT_GT(alone.count("kernelCells"), 1e6);
  EXPECT_LE(many.count("packetsShared") + many.count("packetsParted") + many.count("packetsTrivial"), 4);
}

TEST_F(MapsContour, TilesDoNotChangeIt) {
  const Stage stage(ball_over_floor(1), 31, 40, light_samples(1));
  for (const char* sub_lights : {"1", "2"}) {
    const auto method = maps::make_packet(device(), {{"size", "64"}, {"sublights", sub_lights}});
    EXPECT_EQ(run(*method, stage).visibility, run(*method, stage, 7).visibility);
  }
}

TEST_F(MapsContour, DepthsBehindTheNearestAreAskedInOneWay) {
  const Stage stage(ball_over_floor(1), 32, 32, light_samples(1));
  for (const char* depth : {"second", "midpoint", "dual"}) {
    const Masks flat = run(maps::make_contour, stage, {{"size", "64"}, {"depth", depth}});
    EXPECT_EQ(run(maps::make_packet, stage, {{"size", "64"}, {"depth", depth}}).visibility, flat.visibility) << depth;
  }
}

TEST_F(MapsContour, NothingInTheKernelIsLitAndAnUmbraIsDark) {
  // Light of half-size 1 at 5, occluder of half-size 1 at 2, floor: umbra where |x| < 1 − 2/3 · ... of the square.
  const Stage stage(parallel_square(), 48, 48, light_samples(1));
  const ParallelSquare square(stage);
  const OctagonTwin twin(stage, 128);
  for (const Factory& factory : {Factory(maps::make_contour), Factory(maps::make_packet)}) {
    const Masks found = run(factory, stage, {{"size", "128"}});
    std::size_t lit = 0, dark = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!square.on_floor(i)) continue;
      // Where the twin is further than the areas' rounding inside either.
      const double expected = twin.visibility(i);
      if (expected == 1) {
        ++lit;
        EXPECT_EQ(found.visibility[i], 1.0F);
      } else if (expected < 1e-12) {
        ++dark;
        EXPECT_EQ(found.visibility[i], 0.0F);
      }
    }
    EXPECT_GT(lit, 100U);
    EXPECT_GT(dark, 10U);
  }
}

// Guennebaud 2006's trivial pixels: tighter ranges find more of them, and smaller kernels.
TEST_F(MapsContour, TighterRangesFindSmallerKernels) {
  const Stage stage(plate_over_plate(), 40, 40, light_samples(1));
  std::array<Counted, 4> runs;
  std::size_t at = 0;
  for (const char* search : {"none", "hsm", "ysm", "mssm"}) {
    runs[at++] = counted(maps::make_contour, stage, {{"size", "128"}, {"search", search}, {"traversal", "flat"}});
  }
  for (std::size_t i = 1; i < runs.size(); ++i) {
    EXPECT_LE(runs[i].count("kernelCells"), runs[i - 1].count("kernelCells"));
    EXPECT_GE(runs[i].count("packetsTrivial"), runs[i - 1].count("packetsTrivial"));
  }
  EXPECT_LT(runs[3].count("kernelCells"), 0.8 * runs[1].count("kernelCells"));
}

// The mean over the parts of the light as lights of their own (Yang 2009, section 5).
TEST_F(MapsContour, SubLightsAreTheMeanOfContoursOfTheParts) {
  const scenes::Scene scene = ball_over_floor(1);
  const Stage stage(scene, 32, 32, light_samples(1));
  const Masks found = run(maps::make_packet, stage, {{"size", "64"}, {"sublights", "2"}});
  const auto& whole = std::get<scenes::Rectangle>(scene.lights.front().shape);
  const glm::dvec3 half_u = 0.5 * whole.half_u, half_v = 0.5 * whole.half_v;
  std::vector<double> mean(found.visibility.size(), 0.0);
  for (const double x : {-0.5, 0.5}) {
    for (const double z : {-0.5, 0.5}) {
      scenes::Scene part = scene;
      part.lights.front() = rectangle_light({x, 5, z}, half_u, half_v);
      const Stage part_stage(part, 32, 32, light_samples(1));
      const Masks one = run(maps::make_contour, part_stage, {{"size", "64"}});
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += 0.25 * static_cast<double>(one.visibility[i]);
    }
  }
  double largest = 0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    largest = std::max(largest, std::abs(mean[i] - static_cast<double>(found.visibility[i])));
  }
  EXPECT_LT(largest, 1e-6);
}

// Disks, ellipses and polygons are cut in polygons: together they are the light, and looked at from each one's own
// centroid less is missed, as of a rectangle (MapsContourClaims).
TEST_F(MapsContour, SubLightsOfAnyShape) {
  for (const int shape : {1, 2, 4}) {
    scenes::Scene scene = ball_over_floor(1);
    scene.lights.front().shape = under_shape(shape).lights.front().shape;
    const Stage stage(scene, 40, 40, light_samples(1));
    const Masks truth = exact(stage);
    std::vector<double> errors;
    for (const char* sub_lights : {"1", "2", "4"}) {
      const Masks found = run(maps::make_packet, stage, {{"size", "128"}, {"sublights", sub_lights}});
      errors.push_back(floor_errors(stage, found, truth).rmse);
      RecordProperty(fmt::format("shape {} S={}", shape, sub_lights), fmt::format("{:.4f}", errors.back()));
      fmt::print("shape {}, S={}: RMSE {:.4f}\n", shape, sub_lights, errors.back());
    }
    EXPECT_LT(errors[1], 0.6 * errors[0]) << shape;
    EXPECT_LT(errors[2], 0.7 * errors[1]) << shape;
  }
}

// A light whose left half is black is its right half.
TEST_F(MapsContour, SubLightsWeighByTheTexture) {
  scenes::Scene scene = ball_over_floor(1);
  const Stage plain(scene, 24, 24, light_samples(4));
  visibility::Light textured = plain.light;
  textured.texture = visibility::LightTexture{
      .width = 2, .height = 1, .colors = {glm::vec3(0), glm::vec3(1)}, .luminance = {0, 1}, .mean_luminance = 0.5};
  const auto method = maps::make_packet(device(), {{"size", "64"}, {"sublights", "2"}});
  const Masks found = tests::run(*method, plain.floats, textured, plain.samples);
  const visibility::LightFrame frame = visibility::light_frame(plain.light);
  std::vector<double> mean(found.visibility.size(), 0.0);
  for (const double t : {-0.5, 0.5}) {
    visibility::Light part = plain.light;
    const glm::dvec3 center = frame.center + 0.5 * frame.u + t * frame.v, u = 0.5 * frame.u, v = 0.5 * frame.v;
    part.center = center;
    part.center_u = center + u;
    part.center_v = center + v;
    part.outline = {center - u - v, center + u - v, center + u + v, center - u + v};
    const auto contour = maps::make_contour(device(), {{"size", "64"}});
    const Masks one = tests::run(*contour, plain.floats, part, plain.samples);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += 0.5 * static_cast<double>(one.visibility[i]);
  }
  for (std::size_t i = 0; i < mean.size(); ++i) EXPECT_NEAR(found.visibility[i], mean[i], 1e-6);
}

TEST_F(MapsContour, WhatItCannotDoIsRefused) {
  scenes::Scene scene = ball_over_floor(1);
  const Stage plain(scene, 8, 8, light_samples(4));
  visibility::Light textured = plain.light;
  textured.texture = visibility::LightTexture{
      .width = 1, .height = 1, .colors = {glm::vec3(1)}, .luminance = {1}, .mean_luminance = 1};
  const auto contour = maps::make_contour(device(), {{"size", "16"}});
  contour->prepare_mesh(plain.floats);
  EXPECT_THROW(contour->prepare_light(textured), InputError);
  scene.lights.front().shape = scenes::Sphere{{0, 5, 0}, 0.9};
  const Stage bulb(scene, 8, 8, light_samples(4));
  const auto packet = maps::make_packet(device(), {{"size", "16"}, {"sublights", "2"}});
  packet->prepare_mesh(bulb.floats);
  EXPECT_THROW(packet->prepare_light(bulb.light), InputError);
  for (const char* extent : {"0x3", "3x0", "9x8", "3", "x3", "3x", "3x3x", "3X3", "-1x2", " 2x2", "4294967297x1"}) {
    EXPECT_THROW(maps::make_packet(device(), {{"packet", extent}}), UsageError) << extent;
  }
  // Outlines know no texture, and sub-lights are weighed by theirs.
  const auto one = maps::make_packet(device(), {{"size", "16"}}),
             four = maps::make_packet(device(), {{"size", "16"}, {"sublights", "2"}});
  one->prepare_mesh(plain.floats);
  four->prepare_mesh(plain.floats);
  EXPECT_FALSE(one->description().textures);
  try {
    one->prepare_light(textured);
    ADD_FAILURE() << "a texture is not weighed";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("packet:sublights=S"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(four->description().textures);
  four->prepare_light(textured);
  EXPECT_THROW(maps::make_contour(device(), {{"traversal", "deep"}}), UsageError);
}

}  // namespace
}  // namespace penumbra::tests
