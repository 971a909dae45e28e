#pragma once

#include "volumes/wedges/soft_visibility.hpp"

#include <string>
#include <vector>

namespace penumbra::app {

/// A light as a view sample sees it, by the centre's silhouettes and by the sample's own.
struct LightPicture {
  const visibility::Light& light;
  const volumes::Casters& casters;
  const volumes::SoftVisibility& soft;
  volumes::LitPoint sample;
  const volumes::LayerSum &center, &receiver;
  double exact = 0;  ///< V
  std::string title;
};

/// An SVG document of two panels side by side, in the light's true proportions, as docs/coverage.md says how to read.
std::string svg_of(const LightPicture& picture);

}  // namespace penumbra::app
