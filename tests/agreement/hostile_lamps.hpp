// SPDX-License-Identifier: Apache-2.0
#pragma once

// Lamps and casters for which rounding matters most: panels in, near and through the light's plane, magnitudes too
// different for one float, needles.

#include "tests/agreement/support.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <variant>
#include <vector>

namespace penumbra::tests {

enum class Hostility : std::uint8_t { panels, magnitudes, needles };
inline constexpr std::array kHostilities{Hostility::panels, Hostility::magnitudes, Hostility::needles};
inline std::string name_of(Hostility hostility) {
  return hostility == Hostility::panels ? "panels" : hostility == Hostility::magnitudes ? "magnitudes" : "needles";
}

class HostileLamp {
 public:
  HostileLamp(Hostility hostility, std::uint32_t seed) : random_(seed) {
    lamp();
    if (hostility == Hostility::panels) panels();
    if (hostility == Hostility::magnitudes) magnitudes();
    if (hostility == Hostility::needles) needles();
    add_object(scene_, "floor", quad({0, -2, 0}, {4, 0, 0}, {0, 0, -4}));
    // The anchor puts the scene's origin at 0, so that numbers next to 0 are not rounded.
    if (below(2) == 0)
      add_object(scene_, "anchor", {{glm::dvec3(-640), glm::dvec3(640, 640, -640), glm::dvec3(640)}}).casts_shadow =
          false;
  }

  [[nodiscard]] const scenes::Scene& scene() const { return scene_; }
  [[nodiscard]] std::mt19937& random() { return random_; }

 private:
  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }
  double real() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  glm::dvec3 anywhere() { return {real(), real(), real()}; }
  double lattice(int range) {
    return 0.5 * (static_cast<double>(below(static_cast<std::uint32_t>(4 * range + 1))) - 2 * range);
  }
  glm::dvec3 lattice_point(int range) { return {lattice(range), lattice(range), lattice(range)}; }

  /// Adds a light: tilted, with coordinates that are exact in float or arbitrary; along the axes; long and narrow; with
  /// sides at any angle.
  void lamp() {
    do {
      const bool exact = below(2) == 0;
      center_ = exact ? lattice_point(2) + glm::dvec3(0, 2, 0) : 2.0 * anywhere() + glm::dvec3(0, 2, 0);
      u_ = exact ? lattice_point(1) : anywhere();
      v_ = exact ? lattice_point(1) : anywhere();
      if (below(4) == 0) u_ = {0.25 + below(3), 0, 0}, v_ = {0, 0, below(2) == 0 ? 2.0 : -0.5};
      if (!exact && below(2) == 0) v_ = glm::cross(u_, v_);  // at right angles
      if (below(6) == 0) v_ *= 0x1p-7;
    } while (!(glm::length(glm::cross(u_, v_)) > 1e-3 * glm::length(u_) * glm::length(v_)));
    if (glm::cross(u_, v_).y > 0 && below(4) != 0) std::swap(u_, v_);  // most emit downward
    scene_.lights.push_back(rectangle_light(center_, u_, v_));
    scene_.lights[0].two_sided = below(3) == 0;
  }

  [[nodiscard]] glm::dvec3 in_plane(double s, double t) const { return center_ + s * u_ + t * v_; }

  void panels() {
    const glm::dvec3 n = glm::normalize(glm::cross(u_, v_));
    std::vector<Corners> soup;
    for (std::uint32_t count = 1 + below(3); count > 0; --count) {
      const double size = std::array{1.0, 1.2, 0.5, 2.0}[below(4)];
      const glm::dvec3 beside =
          below(3) == 0 ? std::array{2.0, 1.0, 0.5}[below(3)] * (below(2) == 0 ? u_ : v_) : glm::dvec3(0);
      std::vector<Corners> panel = quad(center_ + beside, size * u_, size * v_);
      if (below(4) == 0)
        panel = {
            {in_plane(lattice(1), lattice(1)), in_plane(lattice(2), lattice(2)), in_plane(lattice(2), lattice(1))}};
      switch (below(6)) {
        case 0:  // near the light's plane: by a unit in the last place, or several
          for (Corners& corners : panel)
            for (glm::dvec3& x : corners) x += std::ldexp(real(), -24 + static_cast<int>(below(8))) * n;
          break;
        case 1:  // at a distance from the plane as a whole
          for (Corners& corners : panel)
            for (glm::dvec3& x : corners) x += std::ldexp(1.0, -static_cast<int>(below(40))) * (below(2) == 0 ? n : -n);
          break;
        case 2:  // through the plane, along a line through the light or its side
          for (Corners& corners : panel)
            for (glm::dvec3& x : corners) {
              const glm::dvec3 off = x - center_ - beside;
              x += std::ldexp(glm::dot(off, u_), -static_cast<int>(below(2) * 20)) * n;
            }
          break;
        case 3:  // with one corner off the plane
          panel[0][below(3)] += real() * n;
          break;
        default:
          break;  // in the plane, up to the rounding of its corners
      }
      soup.insert(soup.end(), panel.begin(), panel.end());
    }
    add_object(scene_, "panels", soup);
    std::vector<Corners> others;
    for (std::uint32_t count = below(6); count > 0; --count) {
      const glm::dvec3 a = 2.0 * anywhere();
      others.push_back({a, a + anywhere(), a + anywhere()});
      if (below(3) == 0) others.back()[0] = in_plane(lattice(1), lattice(1));  // a corner in the light's plane
    }
    if (below(2) == 0) others.push_back({lattice_point(2), lattice_point(2), lattice_point(2)});
    add_object(scene_, "others", others);
    if (below(4) == 0) add_object(scene_, "body", quad(center_, u_, v_)).emits = 0;
  }

  /// Returns a number of any size between 2⁻⁴⁰ and 2⁹, with either sign; sometimes a whole number, or 0.
  double mixed() {
    if (below(4) == 0) return lattice(4);
    const double size = std::ldexp(1 + static_cast<double>(below(16)) / 16, static_cast<int>(below(50)) - 40);
    return below(2) == 0 ? size : -size;
  }
  void magnitudes() {
    std::vector<Corners> soup;
    const auto corner = [&] { return below(3) == 0 ? 2.0 * anywhere() : glm::dvec3(mixed(), mixed(), mixed()); };
    for (std::uint32_t count = 1 + below(8); count > 0; --count) {
      Corners corners{corner(), corner(), corner()};
      if (!soup.empty() && below(3) == 0) corners = {soup.back()[1], soup.back()[0], corner()};
      soup.push_back(corners);
    }
    add_object(scene_, "soup", soup);
    if (below(3) == 0) {
      const double size = std::ldexp(1.0, -static_cast<int>(below(12)));
      scene_.lights[0].shape = scenes::Rectangle{center_, size * u_, size * v_};
    }
  }

  void needles() {
    std::vector<Corners> soup;
    for (std::uint32_t count = 2 + below(12); count > 0; --count) {
      const glm::dvec3 a = 3.0 * anywhere(), b = below(2) == 0 ? in_plane(2 * real(), 2 * real()) : 3.0 * anywhere();
      const double width = std::ldexp(1.0, -static_cast<int>(below(30)));
      const double along = std::array{0.5, 1.0, 0.0, 0.99}[below(4)];
      soup.push_back({a, b, glm::mix(a, b, along) + width * anywhere()});
      if (below(2) == 0) soup.push_back({soup.back()[2], b, a + width * anywhere()});
    }
    add_object(scene_, "needles", soup);
  }

  std::mt19937 random_;
  scenes::Scene scene_;
  glm::dvec3 center_{0}, u_{0}, v_{0};
};

/// Makes view samples on corners, edges and quarters of triangles, and anywhere on triangles.
inline visibility::ViewSamples hostile_samples(const visibility::SceneFloats& floats, std::mt19937& random,
                                               std::uint32_t width, std::uint32_t height) {
  visibility::ViewSamples samples = samples_on_triangles(floats, width, height, random);
  for (std::size_t i = 0; i < samples.size(); i += 1 + random() % 2) {
    if (samples.triangle[i] == visibility::ViewSamples::kBackground) continue;
    const auto corners = floats.corners(static_cast<std::uint32_t>(samples.triangle[i]));
    std::uniform_real_distribution<double> share(0, 1);
    const double s = share(random), t = share(random) * (1 - s);
    const glm::dvec3 a(corners[0]);
    samples.p[i] = glm::vec3(a + s * (glm::dvec3(corners[1]) - a) + t * (glm::dvec3(corners[2]) - a)) + 0.0F;
  }
  return samples;
}

}  // namespace penumbra::tests
