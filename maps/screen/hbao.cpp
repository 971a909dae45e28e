// SPDX-License-Identifier: Apache-2.0
// Computes horizon-based ambient occlusion: Bavoil, Sainz and Dimitrov 2008, "Image-space horizon-based ambient
// occlusion". Along directions of the picture the highest horizon h is found; V = 1 - 1/2π ∫ (sin h - sin t) W dθ, with
// t the angle of the surface's own tangent. Both angles are measured from the picture's plane, and W weights each rise
// of the horizon by the distance of its cause. Departure: the tangent is taken along the direction of the found sample,
// not along the direction of the search: in perspective these differ, and a plane would shade itself.

#include "maps/screen/methods.hpp"

#include "maps/host/mesh_verdict.hpp"
#include "maps/screen/screen_method.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace penumbra::maps {
namespace {

enum class Attenuation : std::uint8_t { none, linear, quadratic };

constexpr visibility::IntegerOption kDirections{"directions", 1, 1024, 16, "directions around a pixel"};
constexpr visibility::IntegerOption kSteps{"steps", 1, 1024, 8, "pixels read along each direction"};
constexpr visibility::RealOption kAngleBias{
    "angleBias", 0, 89, 30,
    "degrees above the tangent up to which nothing hides light, so that folds of a coarse mesh shade less"};
constexpr visibility::ChoiceOption kAttenuation{
    "attenuation",
    {{"none", Attenuation::none}, {"linear", Attenuation::linear}, {"quadratic", Attenuation::quadratic}},
    Attenuation::linear,
    "weight of a horizon at distance r, with the radius R: 1, 1 - r/R, or 1 - (r/R)^2"};

struct Hbao {
  std::uint32_t directions, steps;
  double bias;  ///< in radians
  Attenuation attenuation;

  [[nodiscard]] double weight(double share) const {
    if (attenuation == Attenuation::none) return 1;
    return 1 - (attenuation == Attenuation::linear ? share : share * share);
  }

  double operator()(const ScreenPicture& picture, std::size_t pixel, double radius, std::uint32_t dither) const {
    const glm::dvec3& middle = picture.point(pixel);
    const glm::dvec2 own = picture.centre_of(pixel);
    const double reach = radius * picture.pixels_per_length(-middle.z);
    // The dither rotates directions and, in another order, moves the first step inward: 7 is prime to 16.
    const double turn = static_cast<double>(dither) / kDithers;
    const double first = 1 - static_cast<double>(7 * dither % kDithers) / kDithers;
    double hidden = 0;
    for (std::uint32_t k = 0; k < directions; ++k) {
      const double angle = 2 * std::numbers::pi * (k + turn) / directions;
      const glm::dvec2 along(std::cos(angle), -std::sin(angle));
      double horizon = -1;  // sine of the horizon
      for (std::uint32_t step = 0; step < steps; ++step) {
        const glm::dvec2 place = own + reach * (step + first) / steps * along;
        if (!picture.holds(place)) break;
        const auto seen = picture.surface_at(place);
        if (!seen || *seen == pixel) continue;
        const glm::dvec3 to = picture.point(*seen) - middle;
        const double away = glm::length(to);
        if (!(away < radius) || !(away > 0)) continue;
        const double base = std::max(horizon, tangent(picture.normal(pixel), glm::dvec2(to)));
        const double sine = to.z / away;
        if (sine <= base) continue;
        hidden += weight(away / radius) * (sine - base);
        horizon = sine;
      }
    }
    return 1 - hidden / directions;
  }

  /// Returns the sine of the surface's own angle over the picture's plane in this direction, plus the bias.
  [[nodiscard]] double tangent(const glm::dvec3& n, const glm::dvec2& to) const {
    constexpr double kUpright = std::numbers::pi / 2;
    const double across = glm::length(to);
    if (!(across > 0)) return -1;
    const double rise = std::atan2(-(n.x * to.x + n.y * to.y) / across, std::max(n.z, 0.0));
    return std::sin(std::min(rise + bias, kUpright));
  }
};

visibility::MeshVerdict hbao_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("horizons of what the camera sees around the view sample", mesh);
}

}  // namespace

std::unique_ptr<visibility::Method> make_hbao(const visibility::MethodOptions& options) {
  visibility::MethodDescription description = screen_description("hbao", "Bavoil, Sainz and Dimitrov 2008");
  description.exact_for =
      "nothing; without attenuation, the fraction of directions (not of light) that a height field leaves visible";
  description.verdict_on = hbao_verdict;
  for (const auto& option :
       {kDirections.description(), kSteps.description(), kAngleBias.description(), kAttenuation.description()})
    description.options.push_back(option);
  const visibility::ParsedOptions parsed = visibility::parse_options(description, options);
  const Hbao hbao{parsed[kDirections], parsed[kSteps], glm::radians(parsed[kAngleBias]), parsed[kAttenuation]};
  return make_screen_method(std::move(description), parsed, hbao);
}

}  // namespace penumbra::maps
