// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/export.hpp>

#include <string>
#include <vector>

namespace penumbra {

struct MethodOption {
  std::string name, default_value, help;
  std::vector<std::string> choices;  ///< empty: a number from `least` to `most`
  double least = 0, most = 0;
  bool whole = false;  ///< for a number: only integers are allowed
};

/// Shadow method, as listed by `penumbra methods`.
struct MethodInfo {
  std::string name, family, paper;
  std::string output;     ///< mask: one bit for each light sample; scalar: V alone; radiance: V and form factors
  std::string exact_for;  ///< cases in which its results are exact
  std::vector<std::string> lights;  ///< supported kinds of lights
  std::vector<MethodOption> options;
};

/// Returns all methods, sorted from best to worst within each family.
PENUMBRA_API std::vector<MethodInfo> methods();
/// Returns the JSON of `penumbra methods --json`.
PENUMBRA_API std::string methods_json();

}  // namespace penumbra
