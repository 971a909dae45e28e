// SPDX-License-Identifier: Apache-2.0
#pragma once

// Compares edge-scatter with rows=exact with the exact areas, view sample by view sample.

#include "reference/methods.hpp"
#include "tests/agreement/support.hpp"
#include "volumes/edges/light_window.hpp"
#include "volumes/scatter/methods.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <memory>
#include <numbers>
#include <vector>

namespace penumbra::tests {

/// Both round V to float once, by at most 2⁻²⁵ for numbers up to 1. Before that, rows=exact is right to 2⁻²⁶
/// (volumes::kProven), and the exact areas to 10⁻¹², or to 10⁻¹⁰ for disks: 64 · 2⁻⁵³ for each of a few thousand
/// trapezoids at the rim.
constexpr double kExactRowsTolerance = 2 * 0x1p-25 + 0x1p-26 + 1e-10;

/// Results of a method whose output is radiance.
struct RowsAnswer {
  std::vector<float> shares;
  std::vector<glm::dvec3> form_factors;
};
inline RowsAnswer run_exact_rows(visibility::Method& method, const visibility::SceneFloats& floats,
                                 const visibility::Light& light, const visibility::ViewSamples& samples) {
  method.prepare_mesh(floats);
  method.prepare_light(light);
  method.prepare_view(samples);
  RowsAnswer result{std::vector<float>(samples.size()), {}};
  const std::uint32_t rows = method.max_tile_rows();
  for (std::uint32_t first = 0; first < samples.height; first += rows) {
    const visibility::Tile tile{first, std::min(rows, samples.height - first)};
    method.evaluate(tile);
    const std::size_t pixels = std::size_t{tile.row_count} * samples.width;
    method.read_visibility(std::span(result.shares).subspan(std::size_t{first} * samples.width, pixels));
    std::vector<glm::dvec3> form_factors(pixels);
    method.read_form_factors(form_factors);
    result.form_factors.insert(result.form_factors.end(), form_factors.begin(), form_factors.end());
  }
  return result;
}

class ExactRows : public DeviceTest {
 protected:
  static std::unique_ptr<visibility::Method> make() {
    return volumes::make_edge_scatter(device(), {{"rows", "exact"}});
  }

  using Answer = RowsAnswer;
  static Answer run(visibility::Method& method, const visibility::SceneFloats& floats, const visibility::Light& light,
                    const visibility::ViewSamples& samples) {
    return run_exact_rows(method, floats, light, samples);
  }

  struct Found {
    std::size_t pixels = 0, partly = 0, unproven = 0, wrong = 0, wrong_form_factors = 0;
    double largest = 0, largest_form_factor = 0;
  };
  /// Returns the form factor of the part of the light by which V may be wrong, at the light's smallest distance, plus
  /// the rounding of some hundred doubles.
  static double form_factor_tolerance(const visibility::Light& light, const glm::vec3& p) {
    if (!visibility::is_planar(light.kind)) {
      const visibility::LightFrame seen = visibility::light_frame_from(light, p);
      const double away = glm::length(light.sun ? seen.center : seen.center - glm::dvec3(p));
      return kExactRowsTolerance * glm::dot(seen.u, seen.u) / (away * away) + 1e-13;
    }
    const volumes::WindowAxes axes = volumes::axes_of(light, volumes::window_of(light));
    const glm::dvec3 d = glm::dvec3(p) - axes.corner;
    const double s = std::clamp(glm::dot(d, axes.u) / glm::dot(axes.u, axes.u), 0.0, 1.0),
                 t = std::clamp(glm::dot(d, axes.v) / glm::dot(axes.v, axes.v), 0.0, 1.0);
    const glm::dvec3 nearest = d - s * axes.u - t * axes.v;
    double brightest = 1;
    if (light.texture) {
      for (const glm::vec3& color : light.texture->colors)
        brightest = std::max({brightest, double{color.x}, double{color.y}, double{color.z}});
      brightest /= mean_luminance(light);
    }
    return brightest * (kExactRowsTolerance * light.area / (std::numbers::pi * glm::dot(nearest, nearest)) + 1e-13);
  }
  static double mean_luminance(const visibility::Light& light) { return std::min(1.0, light.texture->mean_luminance); }
  /// Compares with the exact areas, and adds the differences to `found`.
  static void compare(const visibility::SceneFloats& floats, const visibility::Light& light,
                      const visibility::ViewSamples& samples, double tolerance, Found& found) {
    const auto rows = make();
    const auto exact = reference::make_exact({});
    const auto [shares, form_factors] = run(*rows, floats, light, samples);
    const auto [truth, true_form_factors] = run(*exact, floats, light, samples);
    const auto counters = rows->counters();
    const auto unproven = counters.find("unprovenPixels");
    found.unproven += unproven == counters.end() ? 0 : unproven->second;
    std::size_t wrong = 0;
    const std::vector<visibility::PixelClass> classes = visibility::classify_pixels(floats, samples, light);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (classes[i] <= visibility::PixelClass::unshadowed) continue;  // not evaluated
      const double error = std::abs(static_cast<double>(shares[i]) - static_cast<double>(truth[i]));
      ++found.pixels;
      found.partly += truth[i] > 0 && truth[i] < 1 ? 1 : 0;
      const glm::dvec3 off = glm::abs(form_factors[i] - true_form_factors[i]);
      const double form_factor_error = std::max({off.x, off.y, off.z});
      found.largest_form_factor = std::max(found.largest_form_factor, form_factor_error);
      found.wrong_form_factors += form_factor_error > form_factor_tolerance(light, samples.p[i]) ? 1 : 0;
      found.largest = std::max(found.largest, error);
      if (error <= tolerance) continue;
      if (wrong++ == 0) {
        ADD_FAILURE() << fmt::format("pixel {}: rows {} exact {}; p {} on {}", i, shares[i], truth[i],
                                     text_of(samples.p[i]), samples.triangle[i]);
      }
    }
    found.wrong += wrong;
  }
};

}  // namespace penumbra::tests
