// SPDX-License-Identifier: Apache-2.0
// Tests form factors of `exact` against closed forms and brute force, and by additivity. Lights near the floor make
// cosines and distances vary over the light as much as they can.

#include "reference/methods.hpp"
#include "tests/unit/exact_area_scenes.hpp"
#include "visibility/lights/form_factor.hpp"
#include "visibility/lights/unshadowed_light.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace penumbra::areas {
namespace {

using tests::area_scene;
using tests::AreaStage;
using tests::random_dyadic;
using visibility::UnshadowedLight;

/// The form factors are sums of a thousand trapezoids with four terms up to 1/4, each off by an ulp or two of that, and
/// with ends of edges that moved by an ulp.
constexpr double kRounding = 1e-12;
constexpr glm::vec3 kUp(0, 1, 0);

ExactView view(const AreaStage& stage, const glm::vec3& p, SweepArithmetic arithmetic = SweepArithmetic::rounded) {
  Receiver receiver = tests::receiver_at(stage.floats, p);
  receiver.n = kUp;
  return stage.area.view(receiver, arithmetic);
}

scenes::Scene with_light(scenes::Scene scene, scenes::AreaLight light) {
  scene.lights.push_back(std::move(light));
  return scene;
}

TEST(ExactRadiance, UnderAParallelSquareTheHiddenPartIsARectangle) {
  constexpr unsigned kSeed = 1;
  constexpr double kLight = 2, kHalf = 0.5, kBoard = 0.25;  // heights; both squares have the same half-size
  for (const double board : {1.0, kBoard, kLight - 1.0 / 64}) {
    const AreaStage stage(with_light(area_scene(tests::quad({0, board, 0}, {kHalf, 0, 0}, {0, 0, -kHalf})),
                                     tests::ceiling_light(kLight, kHalf)));
    std::mt19937 random(kSeed);
    int part = 0;
    for (int i = 0; i < 200; ++i) {
      const glm::vec3 p(random_dyadic(random, -1.5, 1.5), 0, random_dyadic(random, -1.5, 1.5));
      const UnshadowedLight seen(stage.light, p, kUp);
      const auto shadow_of = [&](double corner, double at) { return ((corner - at) * kLight / board + at) / kHalf; };
      const glm::dvec2 low(shadow_of(-kHalf, p.x), shadow_of(-kHalf, p.z));
      const glm::dvec2 high(shadow_of(kHalf, p.x), shadow_of(kHalf, p.z));
      const glm::dvec2 one(1), from = glm::clamp(low, -one, one), to = glm::clamp(high, -one, one);
      const double expected = seen.whole() - seen.box(from, to);
      const ExactView result = view(stage, p);
      ASSERT_NEAR(result.form_factor.x, expected, kRounding) << p.x << " " << p.z;
      ASSERT_NEAR(result.visibility, 1 - (to.x - from.x) * (to.y - from.y) / 4, kRounding);
      ASSERT_EQ(result.visibility, stage.visibility(p));
      if (i % 20 == 0) {
        ASSERT_NEAR(view(stage, p, SweepArithmetic::rational).form_factor.x, expected, kRounding);
      }
      if (result.visibility == 1) {
        ASSERT_EQ(result.form_factor, glm::dvec3(seen.whole()));
      }
      part += result.visibility > 0 && result.visibility < 1 ? 1 : 0;
    }
    EXPECT_GT(part, 10);
  }
}

/// A light near the floor, nearly upright; if its bottom is below y = 0, the horizon cuts it.
scenes::AreaLight panel(double bottom) {
  return tests::rectangle_light({0, bottom + 0.75, -1}, {1, 0, 0.25}, {0, 0.75, 0.125});
}

std::vector<tests::Corners> random_triangles(std::mt19937& random, int count) {
  const auto point = [&] {
    return glm::dvec3(random_dyadic(random, -1.5, 1.5), random_dyadic(random, -0.25, 1.5),
                      random_dyadic(random, -1.25, 0.75));
  };
  std::vector<tests::Corners> triangles;
  for (int i = 0; i < count; ++i) triangles.push_back({point(), point(), point()});
  return triangles;
}

/// Returns whether the open segment from p to l meets the triangle, in double. It must not meet the triangle's edges.
bool blocked(const glm::dvec3& p, const glm::dvec3& l, const tests::Corners& t) {
  const glm::dvec3 d = l - p, e = t[1] - t[0], f = t[2] - t[0], h = glm::cross(d, f);
  const double under = glm::dot(e, h);
  if (under == 0) return false;
  const glm::dvec3 s = p - t[0], q = glm::cross(s, e);
  const double u = glm::dot(s, h) / under, v = glm::dot(d, q) / under, at = glm::dot(f, q) / under;
  return u >= 0 && v >= 0 && u + v <= 1 && at > 0 && at < 1;
}

struct Brute {
  double form_factor = 0;
  double doubtful = 0;  ///< the part in cells that differ from a neighbour, which bounds the boundary's error
};

/// Sums over size × size cells, each visible if its middle is.
Brute brute_force(const AreaStage& stage, const std::vector<tests::Corners>& triangles, const glm::vec3& p, int size) {
  const glm::dvec3 c(stage.light.center), u = glm::dvec3(stage.light.center_u) - c,
                                          v = glm::dvec3(stage.light.center_v) - c;
  const auto at = [&](int i) { return 2.0 * i / size - 1; };
  std::vector<char> sees(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x);
  };
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const glm::dvec3 l = c + (at(x) + 1.0 / size) * u + (at(y) + 1.0 / size) * v;
      sees[index(x, y)] = std::ranges::none_of(triangles, [&](const auto& t) { return blocked(p, l, t); }) ? 1 : 0;
    }
  }
  const UnshadowedLight seen(stage.light, p, kUp);
  Brute result;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double f = seen.box({at(x), at(y)}, {at(x + 1), at(y + 1)});
      if (sees[index(x, y)] != 0) result.form_factor += f;
      bool alike = true;
      for (const auto& [i, j] : {std::pair{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}}) {
        if (i >= 0 && j >= 0 && i < size && j < size) alike &= sees[index(i, j)] == sees[index(x, y)];
      }
      if (!alike) result.doubtful += f;
    }
  }
  return result;
}

TEST(ExactRadiance, IsWhatBruteForceComesTo) {
  constexpr unsigned kSeed = 2;
  std::mt19937 random(kSeed);
  int part = 0;
  double coarse_error = 0, fine_error = 0, v_error = 0;
  for (int round = 0; round < 12; ++round) {
    const std::vector<tests::Corners> triangles = random_triangles(random, 3);
    const AreaStage stage(with_light(area_scene(triangles), panel(round % 3 == 0 ? -0.5 : 0.25)));
    const glm::vec3 p(random_dyadic(random, -1, 1), 0, random_dyadic(random, -0.5, 0.75));
    const ExactView exact = view(stage, p);
    if (exact.visibility == 0 || exact.form_factor.x == UnshadowedLight(stage.light, p, kUp).whole()) continue;
    ++part;
    const Brute coarse = brute_force(stage, triangles, p, 32), fine = brute_force(stage, triangles, p, 256);
    // A cell that the boundary crosses is off by at most its whole value. It either differs from a neighbour, or the
    // boundary leaves it before reaching its middle: half of the doubtful cells' sum is a generous bound for both cases
    // together.
    EXPECT_NEAR(fine.form_factor, exact.form_factor.x, 0.5 * fine.doubtful + 1e-9) << "seed " << kSeed << " " << round;
    coarse_error += std::abs(coarse.form_factor - exact.form_factor.x);
    fine_error += std::abs(fine.form_factor - exact.form_factor.x);
    v_error += std::abs(exact.visibility * UnshadowedLight(stage.light, p, kUp).whole() - exact.form_factor.x);
  }
  EXPECT_GE(part, 5);
  EXPECT_LT(fine_error, coarse_error / 4);  // the fine grid has cells of an eighth of the width, 65,536 samples
  EXPECT_LT(fine_error, v_error / 20);      // V times the unshadowed integral is a different quantity
}

TEST(ExactRadiance, QuartersOfALightAddUp) {
  constexpr unsigned kSeed = 3;
  std::mt19937 random(kSeed);
  for (int round = 0; round < 20; ++round) {
    const scenes::Scene scene = area_scene(random_triangles(random, 12));
    const scenes::AreaLight light = panel(round % 2 == 0 ? -0.5 : 0.25);
    const glm::vec3 p(random_dyadic(random, -1, 1), 0, random_dyadic(random, -0.5, 0.75));
    const double whole = view(AreaStage(with_light(scene, light)), p).form_factor.x;
    double sum = 0;
    const auto& shape = std::get<scenes::Rectangle>(light.shape);
    for (const double s : {-0.5, 0.5}) {
      for (const double t : {-0.5, 0.5}) {
        const scenes::AreaLight quarter = tests::rectangle_light(shape.center + s * shape.half_u + t * shape.half_v,
                                                                 shape.half_u / 2.0, shape.half_v / 2.0);
        sum += view(AreaStage(with_light(scene, quarter)), p).form_factor.x;
      }
    }
    EXPECT_NEAR(sum, whole, kRounding) << "seed " << kSeed << ", round " << round;
  }
}

TEST(ExactRadiance, ATextureIsTheSumOfItsTexelsLights) {
  constexpr unsigned kSeed = 4;
  constexpr std::uint32_t kWidth = 4, kHeight = 2;
  std::mt19937 random(kSeed);
  for (int round = 0; round < 8; ++round) {
    const scenes::Scene scene = area_scene(round == 0 ? std::vector<tests::Corners>() : random_triangles(random, 6));
    scenes::AreaLight light = panel(round % 2 == 0 ? 0.25 : -0.5);
    scenes::Texture texture{"random", kWidth, kHeight, {}};
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
      texture.texels.emplace_back(random() % 5, random() % 3, random() % 2 + 1);
    }
    const glm::vec3 p(random_dyadic(random, -1, 1), 0, random_dyadic(random, -0.5, 0.75));
    const auto& shape = std::get<scenes::Rectangle>(light.shape);
    glm::dvec3 sum(0);
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        const double s = (2.0 * x + 1) / kWidth - 1, t = 1 - (2.0 * y + 1) / kHeight;
        const scenes::AreaLight texel =
            tests::rectangle_light(shape.center + s * shape.half_u + t * shape.half_v, shape.half_u / double{kWidth},
                                   shape.half_v / double{kHeight});
        sum += view(AreaStage(with_light(scene, texel)), p).form_factor *
               glm::dvec3(texture.texels[std::size_t{y} * kWidth + x]);
      }
    }
    light.texture = texture;
    const AreaStage stage(with_light(scene, light), 64);
    for (const SweepArithmetic arithmetic : {SweepArithmetic::rounded, SweepArithmetic::rational}) {
      const glm::dvec3 result = view(stage, p, arithmetic).form_factor;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(result[c], sum[c], 5 * kRounding) << "seed " << kSeed << ", " << round;
    }
  }
}

TEST(ExactRadiance, MoreTexelsThanBlocksAreTheirMeans) {
  // 130 columns make blocks of three, and a last one of one. A texture that is constant in each block gives the same
  // form factor for both.
  constexpr unsigned kSeed = 10;
  std::mt19937 random(kSeed);
  const auto level = [](std::uint32_t block) { return static_cast<float>(block * 7 % 5) + 1; };
  scenes::Texture fine{"fine", 130, 2, {}};
  for (std::uint32_t i = 0; i < 260; ++i) fine.texels.emplace_back(level(i % 130 / 3), i < 130 ? 2 : 0, 1);
  for (int round = 0; round < 4; ++round) {
    const scenes::Scene scene = area_scene(round == 0 ? std::vector<tests::Corners>() : random_triangles(random, 4));
    const glm::vec3 p(random_dyadic(random, -1, 1), 0, random_dyadic(random, -0.5, 0.75));
    scenes::AreaLight light = panel(0.25);
    const auto shape = std::get<scenes::Rectangle>(light.shape);
    light.texture = fine;
    const glm::dvec3 result = view(AreaStage(with_light(scene, light), 1024), p).form_factor;
    glm::dvec3 sum(0);
    for (std::uint32_t x = 0; x < 44; ++x) {
      const double left = 6.0 * x / 130 - 1, right = std::min(6.0 * (x + 1) / 130, 2.0) - 1;
      for (const double half : {-0.5, 0.5}) {
        const scenes::AreaLight block =
            tests::rectangle_light(shape.center + (left + right) / 2 * shape.half_u + half * shape.half_v,
                                   (right - left) / 2 * shape.half_u, shape.half_v / 2.0);
        sum += view(AreaStage(with_light(scene, block)), p).form_factor * glm::dvec3(level(x), half > 0 ? 2 : 0, 1);
      }
    }
    // The lights that stand for blocks are rounded to float32, which moves their borders by 1e-7.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(result[c], sum[c], 5e-6) << "seed " << kSeed << ", round " << round;
  }
}

/// Parts of a round light that share sides add up to the whole light, however near p is to the rim and wherever the
/// horizon is.
TEST(ExactRadiance, PartsOfRoundLightsAddUp) {
  std::mt19937 random(5);
  double largest = 0;
  for (int i = 0; i < 400; ++i) {
    scenes::AreaLight light;
    light.name = "round";
    light.shape = scenes::Ellipse{{0, 1, 0}, {0.75, 0, 0.25}, {0.125, 0.5, 0.5}};
    const AreaStage stage(with_light(area_scene({}), light));
    const glm::dvec3 near =
        i % 2 == 0 ? glm::dvec3(1, 0, 0) : glm::dvec3(0.75, 1, 0.25) * (1 - std::ldexp(1.0, -i / 8));
    const glm::vec3 p(near.x + random_dyadic(random, -0.25, 0.25), near.y - 0.5, near.z);
    const glm::vec3 n(random_dyadic(random, -1, 1), 1, random_dyadic(random, -1, 1));
    const UnshadowedLight seen(stage.light, p, n);
    if (!seen.shines()) continue;
    const double s = random_dyadic(random, -0.75, 0.75), t = random_dyadic(random, -0.75, 0.75);
    const double parts = seen.part(std::array<glm::dvec2, 4>{glm::dvec2(-1, -1), {s, -1}, {t, 1}, {-1, 1}}) +
                         seen.part(std::array<glm::dvec2, 4>{glm::dvec2(s, -1), {1, -1}, {1, 1}, {t, 1}});
    const double whole = seen.whole();  // by the circle of the same cone
    EXPECT_NEAR(parts, whole, 1e-12) << i;
    largest = std::max(largest, std::abs(parts - whole));
  }
  fmt::print("off by {:.1e} at most\n", largest);
}

TEST(ExactRadiance, HalfADiskAndHalfASphere) {
  // Seen from under the centre, a board hides x < 0. The disk's stored axes are exact here, the sphere's are doubles.
  // Half of the rim is an arc, integrated by quadrature; the chord of the other half passes under p.
  for (const bool sphere : {false, true}) {
    scenes::AreaLight light;
    light.name = "round";
    if (sphere) {
      light.shape = scenes::Sphere{{0, 1, 0}, 0.75};
    } else {
      light.shape = scenes::Disk{{0, 1, 0}, {0, -1, 0}, 0.75};
    }
    const AreaStage stage(with_light(area_scene(tests::quad({-1, 0.25, 0}, {1, 0, 0}, {0, 0, -1})), light));
    const double whole = UnshadowedLight(stage.light, {0, 0, 0}, kUp).whole();
    EXPECT_NEAR(whole, sphere ? 0.5625 : 0.5625 / 1.5625, 1e-15);  // for a sphere: r² / d²
    EXPECT_NEAR(view(stage, {0, 0, 0}).form_factor.x, whole / 2, 1e-14);
    const AreaStage bare(with_light(area_scene({}), light));
    EXPECT_EQ(view(bare, {8, 0, 0}).form_factor.x, UnshadowedLight(bare.light, {8, 0, 0}, kUp).whole());
  }
}

/// Makes a board in front of the panel.
scenes::Scene boards_before_a_panel() {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {3, 0, 0}, {0, 0, -3}));
  tests::add_object(scene, "board", tests::quad({-0.25, 0.5, -0.5}, {0.5, 0, 0}, {0, 0.5, 0}));
  scene.lights.push_back(panel(0.25));
  scene.cameras.push_back(tests::camera({0.5, 2.5, 3}, {0, 0.25, -0.25}));
  return scene;
}

std::vector<glm::dvec3> form_factors(const tests::Stage& stage, visibility::Method& method) {
  method.prepare_mesh(stage.floats);
  method.prepare_light(stage.light);
  method.prepare_view(stage.samples);
  method.evaluate({0, stage.samples.height});
  std::vector<glm::dvec3> result(stage.samples.size());
  method.read_form_factors(result);
  return result;
}

TEST(ExactRadiance, TheMethodGivesTheSameBitsOnAnyNumberOfThreadsAndOnlyWhatIsWanted) {
  const tests::Stage stage(boards_before_a_panel(), 32, 24);
  const auto method = reference::make_exact({});
  const std::vector<glm::dvec3> many = form_factors(stage, *method);
  {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const std::vector<glm::dvec3> one = form_factors(stage, *method);
    EXPECT_EQ(std::memcmp(many.data(), one.data(), many.size() * sizeof many[0]), 0);
  }
  const std::vector<std::uint32_t> wanted{100, 400, 401, 767};
  method->want_pixels(wanted);
  const std::vector<glm::dvec3> some = form_factors(stage, *method);
  int lit = 0;
  for (std::uint32_t i = 0; i < some.size(); ++i) {
    if (std::ranges::find(wanted, i) == wanted.end()) {
      EXPECT_TRUE(std::isnan(some[i].x));
    } else {
      EXPECT_EQ(some[i], many[i]);
      lit += some[i].x > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(lit, 0);
}

}  // namespace
}  // namespace penumbra::areas
