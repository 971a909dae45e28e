// SPDX-License-Identifier: Apache-2.0
// Exact predicates compared with GMP's rationals: on a tiny lattice, where zeros are the rule, on doubles of every
// exponent, and a few ulps from degenerate.

#include "mesh/predicates.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace penumbra::mesh {
namespace {

using Vector = std::array<mpq_class, 3>;

Vector difference(const glm::dvec3& to, const glm::dvec3& from) {
  return {mpq_class(to.x) - mpq_class(from.x), mpq_class(to.y) - mpq_class(from.y),
          mpq_class(to.z) - mpq_class(from.z)};
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Side exact_side(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) {
  const Vector n = cross(difference(b, a), difference(c, a)), d = difference(p, a);
  return static_cast<Side>(sgn(n[0] * d[0] + n[1] * d[1] + n[2] * d[2]));
}
Side exact_direction(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  const Vector n = cross(difference(b, a), difference(c, a));
  return static_cast<Side>(sgn(n[0] * mpq_class(d.x) + n[1] * mpq_class(d.y) + n[2] * mpq_class(d.z)));
}
bool exactly_collinear(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const Vector n = cross(difference(b, a), difference(c, a));
  return n[0] == 0 && n[1] == 0 && n[2] == 0;
}

struct Tally {
  int back = 0, on = 0, front = 0, collinear = 0;
};

using PointSource = std::function<glm::dvec3()>;

void expect_exact(const PointSource& point, int rounds, Tally& tally) {
  for (int round = 0; round < rounds; ++round) {
    const glm::dvec3 a = point(), b = point(), c = point(), p = point();
    const Side side = exact_side(a, b, c, p);
    ASSERT_EQ(side_of_plane(a, b, c, p), side) << "round " << round;
    ASSERT_EQ(SidesOfPlane(a, b, c)(p), side) << "round " << round;
    ASSERT_EQ(side_of_plane(b, a, c, p), opposite(side)) << "round " << round;
    ASSERT_EQ(side_of_plane(b, c, a, p), side) << "round " << round;
    ASSERT_EQ(side_of_plane(p, c, b, a), side) << "round " << round;  // an even permutation of all four
    const bool straight = exactly_collinear(a, b, c);
    ASSERT_EQ(collinear(a, b, c), straight) << "round " << round;
    tally.back += side == Side::back ? 1 : 0;
    tally.on += side == Side::on ? 1 : 0;
    tally.front += side == Side::front ? 1 : 0;
    tally.collinear += straight ? 1 : 0;

    const glm::vec3 fa(a), fb(b), fc(c), fp(p);
    const auto finite = [](const glm::vec3& v) {
      return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    if (!finite(fa) || !finite(fb) || !finite(fc) || !finite(fp)) continue;
    ASSERT_EQ(side_of_plane(fa, fb, fc, fp), exact_side(fa, fb, fc, fp)) << "float, round " << round;
    ASSERT_EQ(collinear(fa, fb, fc), exactly_collinear(fa, fb, fc)) << "float, round " << round;
    ASSERT_EQ(side_of_direction(fa, fb, fc, fp), exact_direction(fa, fb, fc, fp)) << "direction, round " << round;
  }
}

class Predicates : public testing::TestWithParam<std::uint32_t> {
 protected:
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int number(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

  /// Returns a random mantissa and sign with an exponent from `low` to `high`; below the range of doubles the result is
  /// subnormal or 0.
  double wild(int low, int high) {
    const double value = std::ldexp(between(1, 2), number(low, high));
    return number(0, 1) == 0 ? value : -value;
  }

  std::mt19937 random_{GetParam()};
};

TEST_P(Predicates, Lattice) {
  Tally tally;
  expect_exact([&] { return glm::dvec3(number(-2, 2), number(-2, 2), number(-2, 2)); }, 2000, tally);
  EXPECT_GT(tally.on, 200);
  EXPECT_GT(tally.collinear, 20);
  EXPECT_GT(tally.front, 500);
  EXPECT_GT(tally.back, 500);
}

TEST_P(Predicates, LatticesOfEveryScale) {
  // Ties whose products of three coordinates leave the range of doubles, at its lower and upper end.
  for (const int exponent : {-1074, -1060, -700, -360, -150, 126, 340, 700, 1020}) {
    Tally tally;
    const double unit = std::ldexp(1.0, exponent);
    expect_exact([&] { return unit * glm::dvec3(number(-2, 2), number(-2, 2), number(-2, 2)); }, 150, tally);
    EXPECT_GT(tally.on, 3) << exponent;
    EXPECT_GT(tally.front + tally.back, 20) << exponent;
  }
}

TEST_P(Predicates, WildDoubles) {
  Tally tally;
  expect_exact([&] { return glm::dvec3(wild(-1080, 1022), wild(-1080, 1022), wild(-1080, 1022)); }, 150, tally);
  expect_exact([&] { return glm::dvec3(wild(-1080, -1000), wild(-1080, -1000), wild(-1080, -1000)); }, 150, tally);
  expect_exact([&] { return glm::dvec3(wild(990, 1022), wild(990, 1022), wild(990, 1022)); }, 150, tally);
  expect_exact([&] { return glm::dvec3(wild(-40, 40), wild(-40, 40), wild(-40, 40)); }, 400, tally);
  EXPECT_GT(tally.front, 200);
  EXPECT_GT(tally.back, 200);
}

TEST_P(Predicates, MixedMagnitudes) {
  const std::array<double, 12> values = {0,          -0.0,  1,      -1,     1 + 0x1p-52, 0x1p-1074,
                                         -0x1p-1022, 1e300, -1e300, 1e-300, 0x1p60,      3};
  Tally tally;
  const auto value = [&] { return values[static_cast<std::size_t>(number(0, 11))]; };
  expect_exact([&] { return glm::dvec3(value(), value(), value()); }, 1500, tally);
  EXPECT_GT(tally.on, 5);
  EXPECT_GT(tally.front + tally.back, 500);
}

TEST_P(Predicates, NearlyCoplanarAndNearlyCollinear) {
  Tally tally;
  const auto ulp_off = [&](double x) {
    const int steps = number(-1, 1);
    return steps == 0 ? x : std::nextafter(x, steps * std::numeric_limits<double>::infinity());
  };
  expect_exact(
      [&] {
        const double x = between(-1, 1), y = between(-1, 1);
        return glm::dvec3(x, y, ulp_off(0.3 * x - 0.7 * y));
      },
      500, tally);
  expect_exact(
      [&] {
        const double t = std::round(between(-64, 64)) / 16;  // t, 3 t and 5 t are exact: collinear up to the ulp
        return glm::dvec3(t, ulp_off(3 * t), ulp_off(5 * t));
      },
      500, tally);
  EXPECT_GT(tally.front, 100);
  EXPECT_GT(tally.back, 100);
  EXPECT_GT(tally.on, 10);
}

TEST_P(Predicates, DirectionsNearlyAlongAPlane) {
  int on = 0, off = 0;
  for (int round = 0; round < 2000; ++round) {
    const auto point = [&] { return glm::vec3(number(-40, 40), number(-40, 40), number(-40, 40)) / 16.0f; };
    const glm::vec3 a = point(), b = point(), c = point();
    glm::vec3 d = static_cast<float>(number(-3, 3)) * (b - a) + static_cast<float>(number(-3, 3)) * (c - a);
    d /= number(0, 1) == 0 ? 1.0f : 3.0f;
    if (number(0, 2) == 0) d.x = std::nextafter(d.x, 9.0f);
    const Side side = exact_direction(a, b, c, d);
    ASSERT_EQ(side_of_direction(a, b, c, d), side) << round;
    ASSERT_EQ(side_of_direction(b, a, c, d), opposite(side)) << round;
    ++(side == Side::on ? on : off);
  }
  EXPECT_GT(on, 300);
  EXPECT_GT(off, 300);
}

TEST_P(Predicates, CoplanarIsAllThreeOnThePlane) {
  int yes = 0;
  for (int round = 0; round < 5000; ++round) {
    const auto point = [&] { return glm::vec3(number(-1, 1), number(-1, 1), number(-1, 1)); };
    const std::array<glm::vec3, 3> carrier = {point(), point(), point()}, other = {point(), point(), point()};
    if (collinear(carrier[0], carrier[1], carrier[2]) || collinear(other[0], other[1], other[2])) continue;
    bool expected = true;
    for (const glm::vec3& corner : other) {
      expected &= exact_side(carrier[0], carrier[1], carrier[2], corner) == Side::on;
    }
    ASSERT_EQ(coplanar(carrier, other), expected) << round;
    ASSERT_EQ(coplanar(other, carrier), expected) << round;
    yes += expected ? 1 : 0;
  }
  EXPECT_GT(yes, 10);
}

/// The last product cancels the sum of the others, except for rounding.
TEST_P(Predicates, SumsOfProductsThatNearlyCancel) {
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<double> real(-1, 1);
  int rounded_wrongly = 0;
  for (int round = 0; round < 20000; ++round) {
    std::array<double, 4> x{}, y{};
    for (double& number : x) number = real(random);
    for (double& number : y) number = real(random);
    y[3] = -(x[0] * y[0] + x[1] * y[1] + x[2] * y[2]) / x[3];
    mpq_class sum = 0;
    double in_double = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      sum += mpq_class(x.at(i)) * mpq_class(y.at(i));
      in_double += x.at(i) * y.at(i);
    }
    rounded_wrongly += in_double * sum.get_d() < 0 ? 1 : 0;
    ASSERT_EQ(sign_of_products(x, y), sgn(sum)) << "round " << round;
  }
  EXPECT_GT(rounded_wrongly, 100);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Predicates, testing::Range(0u, 4u));

}  // namespace
}  // namespace penumbra::mesh
