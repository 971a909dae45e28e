// SPDX-License-Identifier: Apache-2.0
// Floods borders of hard shadows over a picture (Arvo et al. 2004, see arvo.cpp).

#include "maps/single_shadow/flood.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace penumbra::maps {
namespace {

/// Point of a hard shadow's border, as seen from the light's centre, and the height of its caster.
struct Border {
  glm::dvec2 at{0};
  double blocker = 0;
};

/// Returns half a penumbra's width at a pixel, as seen from the light's centre.
double reach(const FloodPixel& pixel, const Border& border, double light) {
  return light * (1 / border.blocker - 1 / pixel.height);
}

using State = FloodPixel::State;
constexpr std::array<std::array<int, 2>, 8> kAround{
    {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};

class Flood {
 public:
  Flood(std::span<const FloodPixel> pixels, std::uint32_t width, double light)
      : pixels_(pixels), width_(static_cast<int>(width)), light_(light), borders_(pixels.size()) {}

  FloodResult run() {
    std::vector<std::size_t> front = begin();
    FloodResult result;
    while (!front.empty()) {
      ++result.passes;
      front = grow(front);
    }
    result.share.resize(pixels_.size());
    for (std::size_t i = 0; i < pixels_.size(); ++i) result.share[i] = share(i);
    return result;
  }

 private:
  /// Calls `see` for the neighbours of a pixel, the first `count` of kAround, that are in the picture and not
  /// background.
  template <typename See>
  void each_neighbour(std::size_t i, std::size_t count, const See& see) const {
    const int x = static_cast<int>(i) % width_, y = static_cast<int>(i) / width_;
    const int height = static_cast<int>(pixels_.size()) / width_;
    for (std::size_t k = 0; k < count; ++k) {
      const int to_x = x + kAround[k][0], to_y = y + kAround[k][1];
      if (to_x < 0 || to_y < 0 || to_x >= width_ || to_y >= height) continue;
      const auto other =
          static_cast<std::size_t>(to_y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(to_x);
      if (pixels_[other].state != State::nothing) see(other);
    }
  }

  /// Keeps a border if it is within reach and nearer than the border in `kept`.
  void offer(std::size_t i, const Border& border, std::optional<Border>& kept) const {
    const double away = glm::distance(pixels_[i].seen, border.at);
    if (!(away < reach(pixels_[i], border, light_))) return;
    if (!kept || away < glm::distance(pixels_[i].seen, kept->at)) kept = border;
  }

  /// Returns the pixels at a hard border. A border lies between two pixels that are neighbours as seen from the light's
  /// centre: no farther apart than a penumbra's width; else they are two surfaces.
  std::vector<std::size_t> begin() {
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const FloodPixel& pixel = pixels_[i];
      if (pixel.state == State::nothing) continue;
      std::optional<Border> nearest;
      each_neighbour(i, 4, [&](std::size_t other) {
        if (pixels_[other].state == pixel.state) return;
        const FloodPixel& shaded = pixel.state == State::shaded ? pixel : pixels_[other];
        offer(i, {0.5 * (pixel.seen + pixels_[other].seen), shaded.blocker}, nearest);
      });
      if (!nearest) continue;
      borders_[i] = nearest;
      front.push_back(i);
    }
    return front;
  }

  /// Returns the pixels reached by the front in the next step of one pixel.
  std::vector<std::size_t> grow(const std::vector<std::size_t>& front) {
    std::vector<std::size_t> candidates;
    for (const std::size_t i : front) {
      each_neighbour(i, 8, [&](std::size_t other) {
        if (!borders_[other] && pixels_[other].state == pixels_[i].state) candidates.push_back(other);
      });
    }
    std::ranges::sort(candidates);
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    std::vector<std::size_t> next;
    std::vector<Border> taken;
    for (const std::size_t i : candidates) {
      std::optional<Border> nearest;
      each_neighbour(i, 8, [&](std::size_t other) {
        if (borders_[other] && pixels_[other].state == pixels_[i].state) offer(i, *borders_[other], nearest);
      });
      if (!nearest) continue;
      next.push_back(i);
      taken.push_back(*nearest);
    }
    for (std::size_t k = 0; k < next.size(); ++k) borders_[next[k]] = taken[k];
    return next;
  }

  [[nodiscard]] double share(std::size_t i) const {
    const FloodPixel& pixel = pixels_[i];
    const double end = pixel.state == State::shaded ? 0 : 1;
    if (!borders_[i]) return end;
    const double away = std::min(glm::distance(pixel.seen, borders_[i]->at) / reach(pixel, *borders_[i], light_), 1.0);
    return 0.5 + (end - 0.5) * away;
  }

  std::span<const FloodPixel> pixels_;
  int width_;
  double light_;
  std::vector<std::optional<Border>> borders_;
};

}  // namespace

FloodResult flood(std::span<const FloodPixel> pixels, std::uint32_t width, double light) {
  if (pixels.empty()) return {};
  return Flood(pixels, width, light).run();
}

}  // namespace penumbra::maps
