// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/did_you_mean.hpp"
#include "base/error.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// Returns the index of the element with this name. Throws UsageError, with the list of existing names, if there is
/// none; `what` is the elements' kind.
template <typename Named>
std::size_t find_named(const std::vector<Named>& elements, std::string_view name, const char* what) {
  const auto found = std::ranges::find(elements, name, &Named::name);
  if (found != elements.end()) return static_cast<std::size_t>(found - elements.begin());
  std::vector<std::string> names;
  for (const Named& element : elements) names.push_back(element.name);
  throw UsageError("the scene has no {} \"{}\"; it has: {}{}", what, name, fmt::join(names, ", "),
                   did_you_mean(name, names));
}

}  // namespace penumbra
