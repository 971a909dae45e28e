// SPDX-License-Identifier: Apache-2.0
// Form factors of polygons, disks and ellipses in closed form (Lambert 1760; Baum et al. 1989); form_factor.hpp has the
// equations.

#include "visibility/lights/form_factor.hpp"

#include "visibility/lights/angle_over_sine.hpp"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace penumbra::visibility {
namespace {

using std::numbers::pi;

/// Integrals along a disk's rim as seen from an element: of 1, cos φ and sin φ, each divided by A − B cos φ, from one
/// angle to another.
class Rim {
 public:
  Rim(double radius, double off_axis, double height)
      : b_(2 * off_axis * radius),
        a_(radius * radius + off_axis * off_axis + height * height),
        least_((radius - off_axis) * (radius - off_axis) + height * height),
        most_((radius + off_axis) * (radius + off_axis) + height * height),
        root_(std::sqrt(least_ * most_)) {}

  [[nodiscard]] double a() const { return a_; }
  [[nodiscard]] double b() const { return b_; }
  [[nodiscard]] double root() const { return root_; }  ///< √(A² − B²)

  [[nodiscard]] double of_one(double from, double to) const { return (turned(to) - turned(from)) / root_; }

  [[nodiscard]] double of_cosine(double from, double to) const {
    const double ratio = b_ / a_;
    if (ratio > 1.0 / 64) return (a_ * of_one(from, to) - (to - from)) / b_;
    // 1/A Σ (B/A)^(k−1) ∫ cosᵏ: cut off where 64⁻⁹ = 2⁻⁵⁴ remains.
    double sum = 0, power = 1, before = to - from, last = std::sin(to) - std::sin(from);  // ∫ cos⁰, ∫ cos¹
    for (int k = 1; k <= 9; ++k) {
      sum += power * last;
      power *= ratio;
      const double ends = std::pow(std::cos(to), k) * std::sin(to) - std::pow(std::cos(from), k) * std::sin(from);
      const double next = (ends + k * before) / (k + 1);
      before = last;
      last = next;
    }
    return sum / a_;
  }

  [[nodiscard]] double of_sine(double from, double to) const {
    const double change = std::cos(from) - std::cos(to), low = at(from);
    return b_ == 0 ? change / a_ : std::log1p(b_ * change / low) / b_;
  }

 private:
  /// Returns A − B cos φ, without cancellation.
  [[nodiscard]] double at(double angle) const {
    const double sine = std::sin(angle / 2);
    return least_ + 2 * b_ * sine * sine;
  }
  /// Returns ∫ √(A² − B²) / (A − B cos φ) from 0, continuous over all turns.
  [[nodiscard]] double turned(double angle) const {
    const double turns = std::round(angle / (2 * pi)), rest = angle - 2 * pi * turns;
    return 2 * std::atan2(std::sqrt(most_) * std::sin(rest / 2), std::sqrt(least_) * std::cos(rest / 2)) +
           2 * pi * turns;
  }

  double b_, a_, least_, most_, root_;
};

/// A symmetric matrix diagonalised by Jacobi rotations: eigenvalues on the diagonal, eigenvectors in columns. Each
/// rotation subtracts t · b from the diagonal, so that small eigenvalues next to large ones keep their precision.
struct Axes3 {
  glm::dmat3 matrix, vectors{1.0};

  explicit Axes3(const glm::dmat3& symmetric) : matrix(symmetric) {
    for (int sweep = 0; sweep < 16; ++sweep) {
      const bool turned = turn(0, 1), again = turn(0, 2), more = turn(1, 2);
      if (!turned && !again && !more) return;
    }
  }

 private:
  bool turn(int i, int j) {
    const double b = matrix[i][j];
    if (b * b <= 0x1p-120 * std::abs(matrix[i][i] * matrix[j][j])) return false;
    const double theta = (matrix[j][j] - matrix[i][i]) / (2 * b);
    const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::hypot(theta, 1.0));
    const double c = 1 / std::hypot(t, 1.0), s = t * c;
    matrix[i][i] -= t * b;
    matrix[j][j] += t * b;
    matrix[i][j] = matrix[j][i] = 0;
    const int k = 3 - i - j;
    const double at_i = matrix[k][i], at_j = matrix[k][j];
    matrix[k][i] = matrix[i][k] = c * at_i - s * at_j;
    matrix[k][j] = matrix[j][k] = s * at_i + c * at_j;
    const glm::dvec3 column = vectors[i];
    vectors[i] = c * column - s * vectors[j];
    vectors[j] = s * column + c * vectors[j];
    return true;
  }
};

}  // namespace

double form_factor_term(const FormFactorEdge& edge, const glm::dvec3& n) {
  const glm::dvec3 product = 0.5 * glm::cross(edge.a + edge.b, edge.direction);
  const double squared = glm::dot(product, product);
  if (squared == 0) return 0;
  return glm::dot(n, product) * angle_over_sine(squared, glm::dot(edge.a, edge.b)) * kPerTurn;
}

double form_factor_arc(const FormFactorArc& arc, const glm::dvec3& n) {
  // Positive nodes and their weights (Gauss–Legendre).
  constexpr std::array<std::array<double, 2>, 5> kNodes{{{0.1488743389816312, 0.2955242247147529},
                                                         {0.4333953941292472, 0.2692667193099964},
                                                         {0.6794095682990244, 0.2190863625159820},
                                                         {0.8650633666889845, 0.1494513491505806},
                                                         {0.9739065285171717, 0.0666713443086881}}};
  constexpr double kLongest = 1, kShortest = 0x1p-40;  // half-length of a piece
  const double along_n = glm::dot(n, glm::cross(arc.u, arc.v)), sine = -glm::dot(n, glm::cross(arc.center, arc.u)),
               cosine = glm::dot(n, glm::cross(arc.center, arc.v)), size = glm::length(arc.u) + glm::length(arc.v);
  const auto at = [&](double angle) { return arc.center + std::cos(angle) * arc.u + std::sin(angle) * arc.v; };
  const auto integrand = [&](double angle) {
    const glm::dvec3 r = at(angle);
    return (along_n + cosine * std::cos(angle) + sine * std::sin(angle)) / glm::dot(r, r);
  };
  const double direction = arc.arc < 0 ? -1 : 1, end = std::abs(arc.arc);
  double sum = 0, begin = 0;
  while (begin < end) {
    double half = std::min(kLongest, (end - begin) / 2);
    const auto middle = [&] { return arc.from + direction * (begin + half); };
    while (half > kShortest && 3.3 * half > std::log1p(0.414 * glm::length(at(middle())) / size)) half /= 2;
    double piece = 0;
    for (const auto& [node, weight] : kNodes)
      piece += weight * (integrand(middle() - half * node) + integrand(middle() + half * node));
    sum += half * piece;
    const double next = begin + 2 * half;
    begin = end - next <= 0x1p-50 * end ? end : next;
  }
  return direction * sum / (2 * pi);
}

void FormFactorLoop::add(const FormFactorEdge& edge, double height_a, double height_b) {
  if (height_a < 0 && height_b < 0) return;
  if (height_a >= 0 && height_b >= 0) {
    sum_ += form_factor_term(edge, n_);
  } else if (height_a >= 0) {
    const glm::dvec3 kept = height_a / (height_a - height_b) * edge.direction, cut = edge.a + kept;
    sum_ += form_factor_term({edge.a, cut, kept}, n_);
    up_ ? close(cut, *up_) : void(down_ = cut);
  } else {
    const glm::dvec3 kept = height_b / (height_b - height_a) * edge.direction, cut = edge.b - kept;
    sum_ += form_factor_term({cut, edge.b, kept}, n_);
    down_ ? close(*down_, cut) : void(up_ = cut);
  }
}

void FormFactorLoop::close(const glm::dvec3& down, const glm::dvec3& up) {
  sum_ += form_factor_term({down, up, up - down}, n_);
  down_.reset();
  up_.reset();
}

double form_factor(std::span<const glm::dvec3> corners, const glm::dvec3& n) {
  FormFactorLoop loop(n);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    loop.add({a, b, b - a}, glm::dot(n, a), glm::dot(n, b));
  }
  return loop.sum();
}

double form_factor(const FormFactorDisk& disk, const glm::dvec3& n) {
  // Axes: z from the disk's plane to the element, x from the axis to the element. The rim at φ is then seen at
  // (R cos φ − ρ, R sin φ, −h), and r × dr = (hR cos φ, hR sin φ, R² − ρR cos φ) dφ, counter-clockwise.
  const double toward = -glm::dot(disk.normal, disk.center);
  const glm::dvec3 z = toward < 0 ? -disk.normal : disk.normal;
  const double h = std::abs(toward), r = disk.radius;
  glm::dvec3 off = -disk.center - h * z;
  off -= glm::dot(off, z) * z;  // near the axis the first difference is rounding, in any direction
  const double length = glm::length(off), rho = length > 0x1p-50 * glm::length(disk.center) ? length : 0;
  const glm::dvec3 side = std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = rho > 0 ? off / rho : glm::normalize(glm::cross(z, side)), y = glm::cross(z, x);
  const double nx = glm::dot(n, x), ny = glm::dot(n, y), nz = glm::dot(n, z);
  const Rim rim(r, rho, h);

  // The rim has the height R k cos(φ − ψ) + n · centre over the element's plane.
  const double k = std::sqrt(nx * nx + ny * ny), middle = glm::dot(n, disk.center);
  if (middle <= -r * k) return 0;
  if (middle >= r * k) {
    const double q = r * r + h * h - rho * rho, s = rim.root();
    const double upper = q >= 0 ? q + s : 4 * rho * rho * h * h / (s - q);  // A + S − 2ρ² without cancellation
    const double sum = nx * h * r * rim.b() + nz * r * r * upper;
    return std::max(0.0, -sum / (s * (rim.a() + s)));
  }
  const double psi = std::atan2(ny, nx), half = std::acos(std::clamp(-middle / (r * k), -1.0, 1.0));
  const double from = psi - half, to = psi + half;
  const double sum = (h * r * nx - rho * r * nz) * rim.of_cosine(from, to) + h * r * ny * rim.of_sine(from, to) +
                     nz * r * r * rim.of_one(from, to);
  // Closes the loop along the chord, which lies in the horizon.
  const auto at = [&](double angle) { return disk.center + r * (std::cos(angle) * x + std::sin(angle) * y); };
  const glm::dvec3 down = at(to), up = at(from);
  return std::max(0.0, -sum / (2 * pi) - form_factor_term({down, up, up - down}, n));
}

double form_factor(const FormFactorEllipse& ellipse, const glm::dvec3& n) {
  // Planes through the element that touch the ellipse have normals m with (m · u)² + (m · v)² = (m · c)²: the cone's
  // dual is u uᵀ + v vᵀ − c cᵀ. In axes along c its elements are graded like its eigenvalues, however far away the
  // ellipse is.
  const double distance = glm::length(ellipse.center);
  if (distance == 0) return 0;
  const glm::dvec3 z = ellipse.center / distance;
  const glm::dvec3 side = std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 y = glm::normalize(glm::cross(z, side)), x = glm::cross(y, z);
  const glm::dmat3 basis(x, y, z);
  const glm::dvec3 u = ellipse.u * basis, v = ellipse.v * basis, c(0, 0, distance);
  const Axes3 axes(glm::outerProduct(u, u) + glm::outerProduct(v, v) - glm::outerProduct(c, c));

  // In its axes the cone is X² / α² + Y² / β² = Z², α ≥ β.
  std::array<int, 3> order{0, 1, 2};
  std::ranges::sort(order, std::ranges::greater(), [&](int i) { return axes.matrix[i][i]; });
  const double along = -axes.matrix[order[2]][order[2]];
  const double alpha = axes.matrix[order[0]][order[0]] / along,
               beta = axes.matrix[order[1]][order[1]] / along;  // squares
  if (!(along > 0) || !(beta > 0)) return 0;                    // the cone is no wider than rounding errors
  // The plane Z = 1 + m Y cuts the cone in a circle: m² = (α² − β²) / (β² (1 + α²)). With q = β m the circle extends
  // from Y = −β / (1 + q) to β / (1 − q).
  const double q = std::sqrt((alpha - beta) / (1 + alpha)), b = std::sqrt(beta), m = q / b;
  const double reach = b * (1 + alpha) / (1 + beta);  // β / (1 − q²)
  const double stretch = std::hypot(1.0, m);
  const glm::dvec3 &to_y = axes.vectors[order[1]], &axis = axes.vectors[order[2]];
  const glm::dvec3 to_z = axis.z < 0 ? -axis : axis;
  const FormFactorDisk disk{basis * (reach * q * to_y + (1 + m * reach * q) * to_z),
                            basis * ((to_z - m * to_y) / stretch), reach * stretch};
  return form_factor(disk, n);
}

}  // namespace penumbra::visibility
