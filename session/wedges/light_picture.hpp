// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/wedges/soft_visibility.hpp"

#include <string>
#include <vector>

namespace penumbra::session {

/// Light as seen from a view sample, computed once with the silhouettes as seen from the light's centre and once with
/// those seen from the view sample.
struct LightPicture {
  const visibility::Light& light;
  const volumes::Casters& casters;
  const volumes::SoftVisibility& soft;
  volumes::LitPoint sample;
  const volumes::LayerSum &center, &receiver;
  double exact = 0;  ///< V
  std::string title;
};

/// Returns an SVG document of two panels side by side, in the light's true proportions; explained in docs/coverage.md.
std::string svg_of(const LightPicture& picture);

}  // namespace penumbra::session
