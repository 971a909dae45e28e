// SPDX-License-Identifier: Apache-2.0
// Tests fits of maps to a camera's view in closed form: the papers' distances, warps and frustum faces, and the squares
// that queried tiles leave.

#include "maps/host/base_face.hpp"
#include "maps/host/face_fit.hpp"
#include "maps/host/queried_tiles.hpp"
#include "maps/host/warps.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace penumbra::tests {
namespace {

constexpr double kBeyond = std::numeric_limits<double>::infinity();

// Eisemann et al. 2009, section 3.2.3.1: C_i = z_n (z_f / z_n)^(i/m); Zhang et al. 2006 mix these with equal slices.
TEST(MapFits, SlicesEndWhereThePapersSay) {
  maps::ViewFit fit{.fit = maps::Fit::cascades, .split_share = 0.5};
  EXPECT_EQ(fit.slices(), 4U);
  const auto ends = [&](maps::Split split) {
    fit.split = split;
    return maps::split_depths(fit, 1, 81, 4);
  };
  const auto expect = [](const std::vector<double>& found, const std::vector<double>& right) {
    ASSERT_EQ(found.size(), right.size());
    for (std::size_t i = 0; i < right.size(); ++i) EXPECT_NEAR(found[i], right[i], 1e-12 * right[i]);
  };
  expect(ends(maps::Split::logarithmic), {1, 3, 9, 27, 81});
  expect(ends(maps::Split::uniform), {1, 21, 41, 61, 81});
  expect(ends(maps::Split::practical), {1, 12, 25, 44, 81});
  fit.split_share = 0.05;  // from depth 5 on
  const double step = std::pow(81.0 / 5, 0.25);
  expect(ends(maps::Split::pseudo_near), {1, 5 * step, 5 * step * step, 5 * step * step * step, 81});
}

TEST(MapFits, DistancesAreThePapers) {
  // Wimmer et al. 2004: (z_n + sqrt(z_n z_f)) over the sine.
  EXPECT_DOUBLE_EQ(maps::lispsm_distance(1, 16, 1), 5);
  EXPECT_DOUBLE_EQ(maps::lispsm_distance(1, 16, 0.5), 10);
  // Martin and Tan 2004: the focus region covers four fifths: 0.8 = (n + d)/d · f/(f + n).
  const double n = maps::tsm_distance(8, 2);
  EXPECT_NEAR((n + 8) / 8 * 2 / (2 + n), 0.8, 1e-12);
  EXPECT_EQ(maps::tsm_distance(8, 6.4), kBeyond);
}

/// An overhead light so far away that its rays are parallel, over an eye at 0 that looks along b: Eisemann et al. 2009,
/// figure 3.7.
class Overhead : public testing::Test {
 protected:
  static constexpr double kHeight = 1e5, kNear = 1, kFar = 25;

  Overhead() {
    for (const double z : {kNear, kFar}) {
      for (const double x : {-0.5, 0.5}) points_.emplace_back(x * z, z, kHeight);
    }
  }
  [[nodiscard]] maps::FittedFace face(maps::Fit fit) const {
    const maps::SeenBody body{.points = points_,
                              .near = kNear,
                              .far = kFar,
                              .eye = {0, 0, kHeight},
                              .forward = {0, 1, 0},
                              .across = {2, 0, 0},
                              .upward = {0, 0, 2}};
    const maps::Warp warp = fit == maps::Fit::view ? maps::Warp() : maps::warp_of(fit, body, 0.25);
    maps::PlaceBounds bounds;
    for (const glm::dvec3& point : points_) {
      const glm::dvec3 at = warp.matrix * point;
      bounds.add(glm::dvec2(at) / at.z);
    }
    glm::dmat3 unit = maps::to_unit(bounds, 0);
    if (warp.ratio > 0) {
      unit[1] = {0, 1, 0};
      unit[2].y = 0;
    }
    return {.to_face = unit * warp.matrix, .ratio = warp.ratio};
  }
  /// Eisemann et al. 2009, equation 3.1 with cos α / cos β = 1, across the view and along it: 1/z · dz/ds.
  static glm::dvec2 errors(const maps::FittedFace& face, double z) {
    const glm::dvec3 at(0, z, kHeight);
    const glm::dvec2 across = face.moves(at, {1, 0, 0}), along = face.moves(at, {0, 1, 0});
    return {1 / (z * glm::length(across)), 1 / (z * glm::length(along))};
  }

  std::vector<glm::dvec3> points_;
};

TEST_F(Overhead, ErrorsAlongTheViewAreThoseOfTheNotes) {
  const double ratio = kFar / kNear, length = kFar - kNear;
  // Uniform: dz/ds is the length of the depth range.
  const maps::FittedFace uniform = face(maps::Fit::view);
  EXPECT_NEAR(errors(uniform, kNear).y, length / kNear, 1e-6 * length);
  EXPECT_NEAR(errors(uniform, kFar).y, length / kFar, 1e-6);
  // PSM: the error is constant across the view, and grows as z along it.
  const maps::FittedFace psm = face(maps::Fit::psm);
  EXPECT_NEAR(errors(psm, kFar).x / errors(psm, kNear).x, 1, 1e-3);
  EXPECT_NEAR(errors(psm, kFar).y / errors(psm, kNear).y, ratio, 1e-3 * ratio);
  EXPECT_NEAR(errors(psm, 5).y / errors(psm, kNear).y, 5, 5e-3);
  // LiSPSM: at n_opt both ends have the same error, sqrt(z_n / z_f) times the uniform one; in between it is smaller.
  const maps::FittedFace lispsm = face(maps::Fit::lispsm);
  const double most = length / kNear / std::sqrt(ratio);
  EXPECT_NEAR(errors(lispsm, kNear).y, most, 1e-4 * most);
  EXPECT_NEAR(errors(lispsm, kFar).y, most, 1e-4 * most);
  EXPECT_LT(errors(lispsm, 5).y, 0.6 * most);
  // LogPSM: the error is constant in both directions; along the view it is the logarithm of the depths' ratio.
  const maps::FittedFace logpsm = face(maps::Fit::logpsm);
  for (const double z : {1.0, 2.0, 7.0, 25.0}) {
    EXPECT_NEAR(errors(logpsm, z).x, errors(logpsm, kNear).x, 1e-3 * errors(logpsm, kNear).x);
    EXPECT_NEAR(errors(logpsm, z).y, std::log(ratio), 1e-3) << z;
  }
  // TSM: the first quarter of the depths gets four fifths of the rows.
  const maps::FittedFace tsm = face(maps::Fit::tsm);
  const auto row = [&](double z) { return tsm.place({0, z, kHeight})->y; };
  EXPECT_NEAR((row(kNear + 0.25 * length) - row(kNear + 1e-9)) / (row(kFar - 1e-9) - row(kNear + 1e-9)), 0.8, 1e-4);
}

// Wimmer et al. 2004: at any angle γ between the view and parallel light, LiSPSM's errors along the view are equal at
// both ends of a level surface across the light. The eye's image may lie among the points, because the surface may be
// below the eye.
TEST(MapFits, LiSPSMHasEqualErrorsAtBothEndsOfATiltedView) {
  constexpr double kHeight = 1e5, kLength = 24, kDepth = 2;
  for (const double degrees : {75.0, 60.0, 30.0, 15.0}) {
    const double sine = std::sin(glm::radians(degrees)), cosine = std::cos(glm::radians(degrees));
    for (const double first : {-1.5, 0.0, 1.5}) {
      // The point (0, first, kHeight) is kDepth in front of the eye, whose image is at b = 0.
      const glm::dvec3 forward(0, sine, cosine);
      const double below = (kDepth - first * sine) / cosine;
      std::vector<glm::dvec3> points;
      for (const double b : {first, first + kLength}) {
        for (const double a : {-1.0, 1.0}) points.emplace_back(a, b, kHeight);
      }
      const maps::SeenBody body{.points = points,
                                .near = kDepth,
                                .far = kDepth + kLength * sine,
                                .eye = {0, 0, kHeight - below},
                                .forward = forward,
                                .across = {2, 0, 0},
                                .upward = {0, 0, 2}};
      const maps::Warp warp = maps::warp_of(maps::Fit::lispsm, body, 0.25);
      const auto row = [&](double b) {
        const glm::dvec3 at = warp.matrix * glm::dvec3(0, b, kHeight);
        return at.y / at.z;
      };
      const auto error = [&](double b) {
        constexpr double kStep = 1e-3;
        const double change = (row(b + kStep) - row(b - kStep)) / (2 * kStep), depth = kDepth + (b - first) * sine;
        return 1 / (change * depth);
      };
      EXPECT_NEAR(error(first + kLength) / error(first), 1, 1e-3) << degrees << ", " << first;
      EXPECT_LT(error(first + kLength / 4), error(first)) << degrees << ", " << first;
    }
  }
}

TEST_F(Overhead, PlacesAndDirectionsAreInverse) {
  for (const maps::Fit fit : {maps::Fit::view, maps::Fit::lispsm, maps::Fit::tsm, maps::Fit::psm, maps::Fit::logpsm}) {
    const maps::FittedFace one = face(fit);
    for (const glm::dvec2& at : {glm::dvec2(0.1, 0.2), glm::dvec2(0.5, 0.9), glm::dvec2(0.99, 0.01)}) {
      const auto back = one.place(3.0 * one.direction(at));
      ASSERT_TRUE(back);
      EXPECT_NEAR(glm::length(*back - at), 0, 1e-7);
      EXPECT_NEAR(glm::dot(one.along, one.direction(at)), 1, 1e-12);
    }
  }
}

// Brabec et al. 2002: a direction at the angle θ from the axis is mapped to tan(θ/2) from the middle; the circle, θ =
// 90°, is two texels inside the sides. Derivatives agree with differences of places.
TEST(MapFits, AParaboloidSeesAHalfSpaceInACircle) {
  const maps::FittedFace face = maps::paraboloid_face(0, 64, 2);
  for (const double degrees : {0.0, 30.0, 60.0, 89.9}) {
    const double angle = glm::radians(degrees);
    for (const double turn : {0.0, 1.0, 4.0}) {
      const glm::dvec3 e(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle));
      const auto at = face.place(3.0 * e);
      ASSERT_TRUE(at);
      EXPECT_NEAR(glm::length(*at - 0.5), (0.5 - 2.0 / 64) * std::tan(angle / 2), 1e-12);
      EXPECT_NEAR(glm::length(face.direction(*at) - e / e.z), 0, 1e-9 / e.z);
      const glm::dvec3 by(0.3, -0.2, 0.15);
      const glm::dvec2 step = (*face.place(3.0 * e + 1e-6 * by) - *face.place(3.0 * e - 1e-6 * by)) / 2e-6;
      EXPECT_NEAR(glm::length(face.moves(3.0 * e, by) - step), 0, 1e-8);
    }
  }
  EXPECT_FALSE(face.place({1, 0, 0}));
  EXPECT_FALSE(face.place({0.1, 0, -1}));
}

// A camera that moves by less than a texel, or turns a little, does not move texels: their borders are multiples of a
// width that changes in steps.
TEST(MapFits, SnappedTexelsStayWhereTheyAre) {
  std::set<double> widths;
  for (int i = 0; i < 200; ++i) {
    const double lower = -0.3 + 0.0001 * i, upper = 0.41 + 0.00013 * i;
    const maps::SnappedSpan span = maps::snapped(lower, upper, 256);
    widths.insert(span.texel);
    EXPECT_LE(span.lower, lower);
    EXPECT_GE(span.lower + 256 * span.texel, upper);
    EXPECT_LE(span.texel, (upper - lower) / 255 * std::exp2(0.25) * (1 + 1e-12));
    const double border = span.lower / span.texel;
    EXPECT_EQ(border, std::round(border));
  }
  EXPECT_EQ(widths.size(), 1U);
}

// Kozlov 2004: a ray leaves the frustum through one of its faces. Coordinates on a side face are the position along the
// picture's border and the inverse depth; on the near and far faces they are those in the picture.
TEST(MapFits, RaysLeaveAFrustumThroughTheFaceThatSaysSo) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(-1, 1), share(0, 1);
  constexpr double kNear = 4, kFar = 20;
  std::set<std::size_t> left_through;
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 forward = glm::normalize(glm::dvec3(anywhere(random), anywhere(random), anywhere(random)));
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.3, 0.9, 0.2)));
    const glm::dvec3 up = glm::cross(right, forward);
    const glm::dvec3 eye(8 * anywhere(random), 8 * anywhere(random), 5 + 4 * anywhere(random));
    const maps::SeenBody body{.points = {},
                              .near = kNear,
                              .far = kFar,
                              .eye = eye,
                              .forward = forward,
                              .across = right / 0.8,
                              .upward = up / 0.6};
    const double depth = kNear + (kFar - kNear) * share(random);
    const glm::dvec3 x = eye + depth * (forward + 0.8 * anywhere(random) * right + 0.6 * anywhere(random) * up);
    // Reference: walk along the ray to where it leaves the picture or the range of depths.
    double leaves = kBeyond;
    glm::dvec2 place(0);
    std::size_t through = 0;
    const glm::dvec3 inverse_range(0, 1 / kNear + 1 / kFar, 1 / kNear - 1 / kFar);
    const auto seen = [&](double t) {
      const glm::dvec3 d = t * x - eye;
      return glm::dvec3(glm::dot(right, d) / 0.8, glm::dot(up, d) / 0.6, glm::dot(forward, d));
    };
    const auto meets = [&](const glm::dvec3& normal, double offset, std::size_t number) {
      const double t = offset / glm::dot(normal, x);
      if (!(t > 1) || !(t < leaves)) return;
      leaves = t;
      through = number;
      const glm::dvec3 at = seen(t);
      const double inverse = (2 / at.z - inverse_range.y) / inverse_range.z;
      place = number < 4 ? glm::dvec2((number % 2 == 0 ? at.y : at.x) / at.z, inverse) : glm::dvec2(at) / at.z;
    };
    for (std::size_t side = 0; side < 4; ++side) {
      const double sign = side < 2 ? -1 : 1;
      const glm::dvec3 g = sign * (side % 2 == 0 ? right / 0.8 : up / 0.6) - forward;
      meets(g, glm::dot(g, eye), side);
    }
    meets(forward, glm::dot(forward, eye) + kNear, 4);
    meets(forward, glm::dot(forward, eye) + kFar, 5);
    left_through.insert(through);
    std::size_t within = 0;
    for (const maps::FrustumFace& face : maps::frustum_faces(body)) {
      if (face.beyond(x) > 1e-9) continue;
      ++within;
      const glm::dvec3 at = face.matrix * x;
      EXPECT_NEAR(at.x / at.z, place.x, 1e-9) << i << ", face " << through;
      EXPECT_NEAR(at.y / at.z, place.y, 1e-9) << i << ", face " << through;
    }
    EXPECT_EQ(within, 1U) << i;
  }
  EXPECT_EQ(left_through.size(), 6U);
}

/// A shadow's edge at x = 0.3371 on a face of 8 × 8 texels. The first cut moves it from 3/8 to 5/16, the second to
/// 11/32, and the third, to 22/64, not at all: queries see no change, and no square is cut again. Each cut divides the
/// squares that hold the edge.
class QueriedTiles : public testing::Test {
 protected:
  static maps::QueriedTiles query(std::uint32_t tiles, std::uint32_t changed) {
    constexpr std::size_t kSide = 256;
    std::vector<std::optional<maps::SeenReceiver>> receivers;
    for (std::size_t i = 0; i < kSide * kSide; ++i) {
      const std::size_t row = i / kSide;
      const glm::dvec2 at((static_cast<double>(i % kSide) + 0.5) / kSide, (static_cast<double>(row) + 0.5) / kSide);
      receivers.emplace_back(maps::SeenReceiver{0, {at.x, at.y, 1}, 1});
    }
    receivers[5] = std::nullopt;  // the background
    const auto picture = [&](const std::vector<maps::FittedFace>& faces) {
      std::vector<float> visibility;
      for (const auto& receiver : receivers) {
        const maps::FittedFace* face = receiver ? maps::face_for(faces, *receiver) : nullptr;
        if (face == nullptr) {
          visibility.push_back(1);
          continue;
        }
        const glm::dvec2 centre = (glm::floor(*face->place(receiver->e) * 8.0) + 0.5) / 8.0;
        visibility.push_back(face->direction(centre).x < 0.3371 ? 1.0F : 0.0F);
      }
      return visibility;
    };
    return maps::queried_tiles(
        {maps::FittedFace{}}, receivers,
        {.fit = maps::Fit::tiles, .tiles = tiles, .refine = maps::Refine::queried, .changed = changed}, picture);
  }
};

TEST_F(QueriedTiles, CutsWhileACutChangesThePicture) {
  const maps::QueriedTiles all = query(64, 0);
  EXPECT_EQ(all.pictures, 4U);
  EXPECT_EQ(all.faces.size(), 22U);  // after the cuts: 1, 4, 2 + 8, 6 + 16
  for (const maps::FittedFace& face : all.faces) {
    const double across = face.direction({1, 0}).x - face.direction({0, 0}).x, left = face.direction({0, 0}).x;
    const bool holds_edge = left < 0.3371 && left + across > 0.3371;
    EXPECT_EQ(across == 0.125, holds_edge || std::abs(left - 0.375) < 1e-9) << left << ", " << across;
  }
}

TEST_F(QueriedTiles, StopsAtItsLimits) {
  EXPECT_EQ(query(12, 0).faces.size(), 10U);
  EXPECT_EQ(query(16, 0).faces.size(), 16U);  // two of the four squares that should be cut
  // The first cut changes a sixteenth of the pixels, half of them in each of two squares.
  EXPECT_EQ(query(64, 256 * 256 / 32).faces.size(), 4U);
  EXPECT_EQ(query(64, 256 * 256 / 32 - 1).faces.size(), 10U);
  EXPECT_EQ(query(1, 0).faces.size(), 1U);
}

}  // namespace
}  // namespace penumbra::tests
