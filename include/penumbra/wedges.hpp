#pragma once

#include <penumbra/export.hpp>
#include <penumbra/scene.hpp>

#include <string>

namespace penumbra {

struct WedgeOptions {
  std::string light = {};                 ///< its name; empty: the first
  std::string construction = "original";  ///< original, tight, or one that is wrong on purpose, broken:1 to broken:6
  std::string from = "centre";            ///< silhouettes from the light's centre, or from anywhere on it
  bool validate = false;                  ///< prove every invariant by exact signs
};

/// The penumbra wedges of a light: the JSON of `penumbra wedges --json`, with `violations` if they were validated.
/// Throws UsageError for options that cannot be meant, InputError for a light that has no wedges.
PENUMBRA_API std::string wedges_json(const Scene& scene, const WedgeOptions& options = {});

}  // namespace penumbra
