// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace penumbra::session {

/// Returns the names of the kinds of lights supported by the method.
std::vector<std::string> light_names(const visibility::MethodDescription& method);

/// Method with one option set, where this option changes the method's description.
struct Variant {
  std::string option, value;
  visibility::MethodDescription method;
};

/// Returns the variants: each option by itself, with each of its choices; for an integer, with the first of these
/// values that has an effect: the least, the least plus 1, the greatest.
std::vector<Variant> variants_of(const visibility::MethodDescription& method);

/// Returns the JSON printed by `methods --json`.
nlohmann::ordered_json methods_json();

}  // namespace penumbra::session
