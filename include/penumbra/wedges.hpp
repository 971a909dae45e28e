// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/export.hpp>
#include <penumbra/scene.hpp>

#include <functional>
#include <string>
#include <string_view>

namespace penumbra {

struct WedgeOptions {
  std::string light = {};                 ///< the light's name; empty: the first
  std::string construction = "original";  ///< original, tight, or one with a deliberate fault, broken:1 to broken:6
  std::string from = "centre";            ///< silhouettes from the light's centre, or from anywhere on the light
  bool validate = false;                  ///< prove every invariant by exact signs
  /// Called between the steps of the work, which ends if this function returns false or throws
  /// (RendererOptions::progress).
  std::function<bool(std::string_view stage, double done)> progress = {};
};

/// Returns the penumbra wedges of a light: the JSON of `penumbra wedges --json`, with `violations` if validated. Throws
/// UsageError for invalid options, InputError for a light without wedges, and Cancelled.
PENUMBRA_API std::string wedges_json(const Scene& scene, const WedgeOptions& options = {});

}  // namespace penumbra
