// SPDX-License-Identifier: Apache-2.0
// Divides directions into parts of equal power by median cuts (Debevec 2005).

#include "maps/host/median_cut.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace penumbra::maps {
namespace {

/// Position of a direction in a picture of the sky, in radians.
struct Place {
  double around, height;
};

class Cutter {
 public:
  Cutter(std::vector<Place> places, std::vector<std::vector<std::uint32_t>>& parts)
      : places_(std::move(places)), parts_(parts) {}

  void cut(std::span<std::uint32_t> part, std::uint32_t count) {
    if (count <= 1) {
      parts_.emplace_back(part.begin(), part.end());
      std::ranges::sort(parts_.back());
      return;
    }
    const auto extent = [&](double Place::*of) {
      const auto [least, most] = std::ranges::minmax(part, {}, [&](std::uint32_t i) { return places_[i].*of; });
      return std::pair(places_[least].*of, places_[most].*of);
    };
    const auto [west, east] = extent(&Place::around);
    const auto [low, high] = extent(&Place::height);
    const bool upright = high - low > (east - west) * std::cos(0.5 * (low + high));
    std::ranges::sort(part, {}, [&](std::uint32_t i) {
      const Place& place = places_[i];
      return upright ? std::tuple(place.height, place.around, i) : std::tuple(place.around, place.height, i);
    });
    const std::uint32_t first = count / 2;
    const std::size_t border = part.size() * first / count;
    cut(part.first(border), first);
    cut(part.subspan(border), count - first);
  }

 private:
  std::vector<Place> places_;
  std::vector<std::vector<std::uint32_t>>& parts_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> median_cut(std::span<const glm::vec3> directions,
                                                   const std::array<glm::vec3, 3>& axes, std::uint32_t parts) {
  std::vector<std::vector<std::uint32_t>> found;
  if (directions.empty()) return found;
  std::vector<Place> places;
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < directions.size(); ++i) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(directions[i]));
    const auto along = [&](std::size_t axis) { return glm::dot(d, glm::dvec3(axes[axis])); };
    places.push_back({std::atan2(along(0), along(1)), std::asin(std::clamp(along(2), -1.0, 1.0))});
    all.push_back(i);
  }
  Cutter(std::move(places), found).cut(all, std::min(parts, static_cast<std::uint32_t>(all.size())));
  return found;
}

}  // namespace penumbra::maps
