#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::tests {

/// One thing that can be chosen, such as an option of the program, and what it can be.
struct Factor {
  std::string name;
  std::vector<std::string> values;
  /// It means something only where that factor has that value: (its index, below this one's; index of the value).
  std::optional<std::pair<std::size_t, std::size_t>> only_if = {};
};

/// A choice for each factor: an index into its values, or nothing where it means nothing.
using Choices = std::vector<std::optional<std::size_t>>;

/// Says of choices, some of which may be open yet, whether they can go together.
using Allowed = std::function<bool(const Choices&)>;

/// Rows in which every combination of values of any `strength` (2 or 3) factors occurs that is allowed by itself: a
/// greedy covering array (Cohen et al., The AETG system, 1997). The same rows on every machine.
std::vector<Choices> covering_array(const std::vector<Factor>& factors, std::size_t strength, const Allowed& allowed);

/// Those combinations that no row has: none, unless an allowed combination cannot be completed to an allowed row.
std::size_t uncovered_combinations(const std::vector<Factor>& factors, std::size_t strength, const Allowed& allowed,
                                   const std::vector<Choices>& rows);

}  // namespace penumbra::tests
