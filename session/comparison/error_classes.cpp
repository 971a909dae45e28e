// SPDX-License-Identifier: Apache-2.0
// Classifies judged pixels by visibility and hiding object.

#include "session/comparison/error_classes.hpp"

#include "reference/hiding_objects.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace penumbra::session {
namespace {

void sort_by_visibility(LightTruth& truth) {
  for (const std::uint32_t pixel : truth.judged) {
    const float v = truth.reference[pixel];
    auto& pixels = v >= 1 ? truth.classes.lit : v <= 0 ? truth.classes.umbra : truth.classes.penumbra;
    pixels.push_back(pixel);
  }
}

/// Finds the objects whose triangles hide the light, or one piece of a light in several pieces, and adds them to
/// `hidden`.
void sort_by_object(const Session& session, std::size_t light, std::span<const std::uint32_t> shadowed,
                    std::vector<reference::HiddenBy>& hidden) {
  const auto found =
      reference::hiding_objects(session.floats_for(light), session.samples, session.lights[light], shadowed);
  for (std::size_t i = 0; i < found.size(); ++i) {
    hidden[i].own |= found[i].own;
    hidden[i].other |= found[i].other;
    hidden[i].nearest = std::min(hidden[i].nearest, found[i].nearest);
    hidden[i].widening = std::max(hidden[i].widening, found[i].widening * std::sqrt(session.lights[light].area));
  }
}

/// Returns the sizes. `hidden`: of the shadowed pixels.
PenumbraSizes sizes_of(const Session& session, std::span<const std::uint32_t> shadowed,
                       std::span<const reference::HiddenBy> hidden) {
  const visibility::PinholeCamera& camera = session.samples.camera;
  const std::vector<float> unknown(session.pixel_count(), std::numeric_limits<float>::quiet_NaN());
  PenumbraSizes sizes{unknown, unknown, unknown};
  for (std::size_t i = 0; i < shadowed.size(); ++i) {
    const std::uint32_t pixel = shadowed[i];
    if (!hidden[i].own && !hidden[i].other) continue;
    const double of_view = camera.half_height.value_or(double{session.samples.depth[pixel]} * camera.tan_half_fov);
    const double of_pixel = 2 * of_view / camera.height;
    sizes.width[pixel] = static_cast<float>(hidden[i].widening);
    sizes.width_pixels[pixel] = static_cast<float>(hidden[i].widening / of_pixel);
    sizes.contact_pixels[pixel] = static_cast<float>(hidden[i].nearest / of_pixel);
  }
  return sizes;
}

}  // namespace

void sort_into_classes(const Session& session, std::vector<LightTruth>& truths, Progress& progress) {
  for (LightTruth& truth : truths) {
    truth.classes = {};
    truth.sizes = {};
    sort_by_visibility(truth);
  }
  const std::vector<WholeLight> wholes = whole_lights(session.lights);
  progress.begin("objects that cast shadows", session.lights.size());
  for (std::size_t whole = 0; whole < truths.size(); ++whole) {
    compare::PixelClasses& classes = truths[whole].classes;
    std::vector<std::uint32_t> shadowed;
    std::ranges::set_union(classes.penumbra, classes.umbra, std::back_inserter(shadowed));
    std::vector<reference::HiddenBy> hidden(shadowed.size());
    for (std::size_t piece = 0; piece < wholes[whole].count; ++piece) {
      sort_by_object(session, wholes[whole].first + piece, shadowed, hidden);
      progress.advance();
    }
    for (std::size_t i = 0; i < shadowed.size(); ++i) {
      if (hidden[i].other) classes.cast.push_back(shadowed[i]);
      if (hidden[i].own) classes.self.push_back(shadowed[i]);
    }
    truths[whole].sizes = sizes_of(session, shadowed, hidden);
  }
  progress.clear();
}

}  // namespace penumbra::session
