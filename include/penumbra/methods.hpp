#pragma once

#include <penumbra/export.hpp>

#include <string>
#include <vector>

namespace penumbra {

struct MethodOption {
  std::string name, default_value, help;
  std::vector<std::string> choices;  ///< empty: a number from `least` to `most`
  double least = 0, most = 0;
  bool whole = false;  ///< of a number: without a fraction
};

/// A shadow method, as `penumbra methods` lists it.
struct MethodInfo {
  std::string name, family, paper;
  std::string output;     ///< mask: a bit for each light sample; scalar: V alone; radiance: V and form factors
  std::string exact_for;  ///< what its answers are exact for
  std::vector<std::string> lights;  ///< kinds of lights that it does
  std::vector<MethodOption> options;
};

/// All methods, those of a family from the best on.
PENUMBRA_API std::vector<MethodInfo> methods();
/// The JSON of `penumbra methods --json`.
PENUMBRA_API std::string methods_json();

}  // namespace penumbra
