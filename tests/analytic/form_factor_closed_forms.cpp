// SPDX-License-Identifier: Apache-2.0
// Form factors against published closed forms (J. Howell, A Catalog of Radiation Heat Transfer Configuration Factors),
// against quadrature, and against one another.

#include "visibility/lights/form_factor.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace penumbra::visibility {
namespace {

using std::numbers::pi;
using Quad = std::array<glm::dvec3, 4>;

constexpr double kUlp = 0x1p-52;
constexpr glm::dvec3 kUp(0, 0, 1);

/// Corners c ± u ± v, clockwise as seen from the origin if u × v points away from it.
Quad quad(const glm::dvec3& c, const glm::dvec3& u, const glm::dvec3& v) {
  return {c - u - v, c + u - v, c + u + v, c - u + v};
}

/// Howell C-11: an element and a parallel rectangle a × b at distance c, with one corner on the element's normal.
double parallel_corner(double a, double b, double c) {
  const double x = a / c, y = b / c, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * pi);
}

/// Howell C-12: an upright rectangle, b wide and a high, that stands on the element's plane at distance c; its nearest
/// point is a corner.
double upright_corner(double a, double b, double c) {
  const double diagonal = std::hypot(a, c);
  return (std::atan2(b, c) - c / diagonal * std::atan2(b, diagonal)) / (2 * pi);
}

TEST(FormFactor, OfAParallelRectangle) {
  for (const double c : {0.01, 0.3, 1.0, 7.0, 1000.0}) {
    const double expected = 4 * parallel_corner(0.5, 0.75, c);
    EXPECT_NEAR(form_factor(quad({0, 0, c}, {0.5, 0, 0}, {0, 0.75, 0}), kUp), expected, 16 * kUlp) << c;
    EXPECT_NEAR(form_factor(quad({0.5, 0.75, c}, {0.5, 0, 0}, {0, 0.75, 0}), kUp), parallel_corner(1, 1.5, c),
                16 * kUlp)
        << c;
  }
}

TEST(FormFactor, OfAnUprightRectangleDownToContact) {
  // The element touches the light in the limit c → 0: 1/4 at one of its corners, 1/2 between two.
  for (const double c : {5.0, 1.0, 0.1, 1e-3, 1e-6, 1e-12, 1e-20, 1e-30}) {
    const double expected = 2 * upright_corner(1.5, 0.75, c);
    // The rectangle stands at x = c and faces −x; u × v points to +x, away from the element.
    EXPECT_NEAR(form_factor(quad({c, 0, 0.75}, {0, 0.75, 0}, {0, 0, 0.75}), kUp), expected, 16 * kUlp) << c;
  }
  EXPECT_NEAR(form_factor(quad({1e-30, 0, 0.75}, {0, 0.75, 0}, {0, 0, 0.75}), kUp), 0.5, 1e-12);
}

TEST(FormFactor, WhatIsBelowTheHorizonDoesNotCount) {
  const double above = 2 * upright_corner(1, 0.75, 0.4);
  EXPECT_NEAR(form_factor(quad({0.4, 0, 0}, {0, 0.75, 0}, {0, 0, 1}), kUp), above, 16 * kUlp);
  EXPECT_NEAR(form_factor(quad({0.4, 0, -1}, {0, 0.75, 0}, {0, 0, 2}), kUp), above, 16 * kUlp);
  EXPECT_EQ(form_factor(quad({0.4, 0, -1}, {0, 0.75, 0}, {0, 0, 1}), kUp), 0);
}

TEST(FormFactor, FarAwayIsASmallSolidAngle) {
  // Expected: area cos cos / π d², with a relative error of (size/d)² and of a few ulps of d/size (see
  // form_factor.hpp).
  const glm::dvec3 toward = glm::normalize(glm::dvec3(1, 2, 3));
  const glm::dvec3 u = glm::normalize(glm::cross(toward, kUp)), v = glm::cross(toward, u);  // u × v = toward
  for (const double d : {1e3, 1e5, 1e7, 1e9}) {
    // The corners are rounded at the distance d; their directions are not.
    const Quad corners = quad(d * toward, 0.5 * u, 0.5 * v);
    const std::array<glm::dvec3, 4> directions{u, v, -u, -v};
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % 4];
      sum += form_factor_term({a, b, directions[i]}, kUp);
    }
    const double expected = toward.z / (pi * d * d);
    EXPECT_NEAR(sum / expected, 1, 1 / (d * d) + 32 * kUlp * d) << d;
  }
}

TEST(FormFactor, AnElementInTheLightsPlaneOrOnItsEdgeGetsNothingWrong) {
  const Quad flat = quad({3, 0, 0.5}, {1, 0, 0}, {0, 0, 0.25});  // its plane contains the element and the normal
  EXPECT_NEAR(form_factor(flat, kUp), 0, kUlp);
  EXPECT_EQ(form_factor_term({{-1, 0, 0}, {1, 0, 0}, {2, 0, 0}}, kUp), 0);
  EXPECT_EQ(form_factor_term({{0, 0, 0}, {1, 0, 1}, {1, 0, 1}}, kUp), 0);
  EXPECT_EQ(form_factor_term({{1, 0, 1}, {1, 0, 1}, {0, 0, 0}}, kUp), 0);
}

/// Gauss's rule with 5 × 5 points on a box of (s, t); boxes are cut in four until the result no longer changes.
double integrate(const std::function<double(double, double)>& f, std::array<double, 4> box, double tolerance) {
  constexpr std::array<double, 5> kAt{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                      0.9061798459386640};
  constexpr std::array<double, 5> kWeight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                          0.4786286704993665, 0.2369268850561891};
  const auto rule = [&](const std::array<double, 4>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t j = 0; j < 5; ++j) {
        sum += kWeight[i] * kWeight[j] *
               f((b[0] + b[1] + kAt[i] * (b[1] - b[0])) / 2, (b[2] + b[3] + kAt[j] * (b[3] - b[2])) / 2);
      }
    }
    return sum * (b[1] - b[0]) * (b[3] - b[2]) / 4;
  };
  const double s = (box[0] + box[1]) / 2, t = (box[2] + box[3]) / 2;
  const std::array<std::array<double, 4>, 4> parts{
      {{box[0], s, box[2], t}, {s, box[1], box[2], t}, {box[0], s, t, box[3]}, {s, box[1], t, box[3]}}};
  double fine = 0;
  for (const auto& part : parts) fine += rule(part);
  if (std::abs(fine - rule(box)) <= tolerance || box[1] - box[0] < 1e-3) return fine;
  double sum = 0;
  for (const auto& part : parts) sum += integrate(f, part, tolerance / 2);
  return sum;
}

TEST(FormFactor, IsTheIntegralOfTheCosines) {
  constexpr unsigned kSeed = 5;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> one(-1, 1);
  const auto vector = [&] { return glm::dvec3(one(random), one(random), one(random)); };
  int cut = 0;
  for (int round = 0; round < 60; ++round) {
    const glm::dvec3 c = 2.0 * vector(), n = glm::normalize(vector());
    glm::dvec3 u = vector(), v = vector();
    const glm::dvec3 normal = glm::cross(u, v);
    const double h = glm::dot(normal, c) / glm::length(normal);
    if (std::abs(h) < 0.15) continue;  // too close for the quadrature; the closed form has no such limit
    if (h < 0) std::swap(u, v);
    const auto f = [&](double s, double t) {
      const glm::dvec3 d = c + s * u + t * v;
      const double squared = glm::dot(d, d);
      return std::max(0.0, glm::dot(n, d)) * std::abs(h) * glm::length(normal) / (pi * squared * squared);
    };
    const Quad corners = quad(c, u, v);
    const bool above = std::ranges::all_of(corners, [&](const glm::dvec3& q) { return glm::dot(n, q) >= 0; });
    const bool below = std::ranges::all_of(corners, [&](const glm::dvec3& q) { return glm::dot(n, q) <= 0; });
    cut += !above && !below ? 1 : 0;
    // The function f has a kink along a horizon; subdivision stops there at boxes of a thousandth, where f is small.
    EXPECT_NEAR(form_factor(corners, n), integrate(f, {-1, 1, -1, 1}, 1e-10), above ? 1e-9 : 1e-6)
        << "seed " << kSeed << ", round " << round;
  }
  EXPECT_GT(cut, 10);
}

TEST(FormFactor, PiecesAddUpAndAnEdgeRunBackwardIsTheNegative) {
  constexpr unsigned kSeed = 6;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> one(-1, 1);
  const auto vector = [&] { return glm::dvec3(one(random), one(random), one(random)); };
  for (int round = 0; round < 500; ++round) {
    const glm::dvec3 c = vector(), u = vector(), v = vector(), n = glm::normalize(vector());
    const auto at = [&](double s, double t) { return c + s * u + t * v; };
    const glm::dvec3 a = at(-1, -1), b = at(1, -1), q = at(1, 1), d = at(-1, 1), middle = at(one(random), one(random));
    const std::array<glm::dvec3, 4> whole{a, b, q, d};
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      sum += form_factor(std::array<glm::dvec3, 3>{whole[i], whole[(i + 1) % 4], middle}, n);
    }
    // Inner edges cancel except for the rounding of up to a dozen additions of numbers below 1/2.
    EXPECT_NEAR(sum, form_factor(whole, n), 12 * kUlp) << "seed " << kSeed << ", round " << round;
    const FormFactorEdge edge{a, b, b - a}, back{b, a, a - b};
    EXPECT_EQ(form_factor_term(edge, n), -form_factor_term(back, n));
  }
}

double polygonal(const FormFactorDisk& disk, const glm::dvec3& n, int sides) {
  const glm::dvec3 z = glm::dot(disk.normal, disk.center) < 0 ? -disk.normal : disk.normal;
  const glm::dvec3 u = glm::normalize(glm::cross(z, std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
  const glm::dvec3 v = glm::cross(z, u);  // so that u × v points away from the element
  const double step = 2 * pi / sides, radius = disk.radius * std::sqrt(step / std::sin(step));  // for equal area
  std::vector<glm::dvec3> corners;
  for (int i = 0; i < sides; ++i) {
    corners.push_back(disk.center + radius * (std::cos(i * step) * u + std::sin(i * step) * v));
  }
  return form_factor(corners, n);
}

TEST(FormFactor, OfADiskStraightAboveAndAtTheHorizon) {
  for (const double h : {1e-3, 0.5, 2.0, 1e3}) {
    EXPECT_NEAR(form_factor(FormFactorDisk{{0, 0, h}, {0, 0, -1}, 0.5}, kUp), 0.25 / (0.25 + h * h), 8 * kUlp) << h;
  }
  // A disk that faces the element, which is then on its axis up to rounding; the horizon cuts it.
  const glm::dvec3 toward = glm::normalize(glm::dvec3(1, 2, 0.1));
  const FormFactorDisk facing{2.0 * toward, -toward, 0.8};
  EXPECT_NEAR(form_factor(facing, kUp), polygonal(facing, kUp, 20000), 1e-8);
  EXPECT_GT(form_factor(facing, kUp), 0.01);
  // An upright disk with its centre on the horizon plane: the upper half counts.
  EXPECT_EQ(form_factor(FormFactorDisk{{2, 0, -0.6}, {-1, 0, 0}, 0.5}, kUp), 0);
  EXPECT_NEAR(form_factor(FormFactorDisk{{2, 0, 0}, {-1, 0, 0}, 0.5}, kUp),
              polygonal({{2, 0, 0}, {-1, 0, 0}, 0.5}, kUp, 20000), 1e-8);
}

TEST(FormFactor, OfADiskIsThatOfItsPolygon) {
  constexpr unsigned kSeed = 7;
  constexpr int kSides = 4000;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> one(-1, 1);
  const auto vector = [&] { return glm::dvec3(one(random), one(random), one(random)); };
  int cut = 0;
  for (int round = 0; round < 300; ++round) {
    FormFactorDisk disk{2.0 * vector(), glm::normalize(vector()), 0.75 + 0.7 * one(random)};
    const glm::dvec3 n = glm::normalize(vector());
    const double h = std::abs(glm::dot(disk.normal, disk.center));
    if (h < 0.05) continue;
    const double across = std::sqrt(std::max(0.0, 1 - std::pow(glm::dot(n, disk.normal), 2))) * disk.radius;
    cut += std::abs(glm::dot(n, disk.center)) < across ? 1 : 0;
    // The polygon strays from the rim by R φ² / 2, φ = π / sides; the integrand is at most 1 / π h².
    const double stray = disk.radius * std::pow(pi / kSides, 2) / 2 * (2 * pi * disk.radius) / (pi * h * h);
    EXPECT_NEAR(form_factor(disk, n), polygonal(disk, n, kSides), stray + 1e-13) << "seed " << kSeed << ", " << round;
  }
  EXPECT_GT(cut, 50);
}

TEST(FormFactor, OfAnEllipseIsThatOfItsPolygon) {
  constexpr unsigned kSeed = 11;
  constexpr int kSides = 20000;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> one(-1, 1);
  const auto vector = [&] { return glm::dvec3(one(random), one(random), one(random)); };
  int cut = 0;
  for (int round = 0; round < 300; ++round) {
    const double distance = std::exp2(8 * one(random)), slim = round % 3 == 0 ? 0.01 : 1.0;
    const FormFactorEllipse ellipse{distance * glm::normalize(vector()), vector(), slim * vector()};
    const glm::dvec3 n = glm::normalize(vector()), across = glm::cross(ellipse.u, ellipse.v);
    const double h = std::abs(glm::dot(glm::normalize(across), ellipse.center));
    if (h < 0.05) continue;
    cut += std::abs(glm::dot(n, ellipse.center)) < std::hypot(glm::dot(n, ellipse.u), glm::dot(n, ellipse.v)) ? 1 : 0;
    const double step = 2 * pi / kSides, reach = std::sqrt(step / std::sin(step));  // for equal area
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < kSides; ++i)
      corners.push_back(ellipse.center + reach * (std::cos(i * step) * ellipse.u + std::sin(i * step) * ellipse.v));
    // The bound is that of a disk whose radius exceeds both axes of the ellipse; each corner's share may be off by an
    // ulp of its edge.
    const double size = std::hypot(glm::length(ellipse.u), glm::length(ellipse.v));
    const double stray = size * std::pow(pi / kSides, 2) / 2 * (2 * pi * size) / (pi * h * h);
    EXPECT_NEAR(form_factor(ellipse, n), std::abs(form_factor(corners, n)), stray + 1e-13)
        << "seed " << kSeed << ", " << round;
  }
  EXPECT_GT(cut, 30);
}

TEST(FormFactor, OfARoundEllipseIsTheDisks) {
  for (const double distance : {0.3, 1.0, 17.0, 1e5}) {
    const glm::dvec3 center = distance * glm::normalize(glm::dvec3(0.3, 0.2, 1)), normal(0, 0.6, -0.8);
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.1, 0.5, 1)), u(0.5, 0, 0), v(0, 0.4, 0.3);
    const double disk = form_factor(FormFactorDisk{center, normal, 0.5}, n);
    // The tolerance counts ε of the cone's axes and ε d / a of the disk's own (see form_factor.hpp).
    EXPECT_NEAR(form_factor(FormFactorEllipse{center, u, v}, n) / disk, 1, 64 * kUlp * (1 + distance)) << distance;
    EXPECT_NEAR(form_factor(FormFactorEllipse{center, v, -u}, n) / disk, 1, 64 * kUlp * (1 + distance)) << distance;
  }
}

TEST(FormFactor, OfADiskHasNoSeams) {
  // Neighbouring formulas agree where they meet (horizon just touching; B/A = 1/64; ρ² = R² + h²).
  const auto value = [](double rho, double h, double tilt) {
    return form_factor(FormFactorDisk{{-rho, 0, h}, {0, 0, -1}, 1}, {std::sin(tilt), 0, std::cos(tilt)});
  };
  const auto expect_same = [&](double rho, double h, double tilt) {
    constexpr double kStep = 1e-12;
    EXPECT_NEAR(value(rho, h, tilt - kStep), value(rho, h, tilt + kStep), 1e-11) << rho << " " << h << " " << tilt;
    EXPECT_NEAR(value(rho - kStep, h, tilt), value(rho + kStep, h, tilt), 1e-11) << rho << " " << h << " " << tilt;
  };
  for (const double h : {0.5, 2.0}) {
    for (const double rho : {0.3, 1.0, 1.5}) {
      expect_same(rho, h, std::atan2(h, 1 + rho));               // the far side of the rim touches the horizon
      expect_same(std::sqrt(1 + h * h), h, 0.25 * rho);          // where `upper` changes its form
      expect_same((1 + h * h) / 128 * 1.0000610370189, h, 1.4);  // near B/A = 1/64, cut by the horizon
    }
  }
}

}  // namespace
}  // namespace penumbra::visibility
