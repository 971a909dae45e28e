#pragma once

#include "visibility/method.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace penumbra::app {

/// Names of the kinds of lights that the method does.
std::vector<std::string> light_names(const visibility::MethodDescription& method);

/// A method with one option set, where that changes what the method is.
struct Variant {
  std::string option, value;
  visibility::MethodDescription method;
};

/// Each option by itself, at all of its choices; of a number the first that matters of the least two and the most.
std::vector<Variant> variants_of(const visibility::MethodDescription& method);

/// The JSON that `methods --json` prints.
nlohmann::ordered_json methods_json();

}  // namespace penumbra::app
