// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::tests {

/// One thing that can be chosen, such as an option of the program, and its possible values.
struct Factor {
  std::string name;
  std::vector<std::string> values;
  /// If set, the factor has a meaning only where another factor has a certain value: (that factor's index, below this
  /// one's; the value's index).
  std::optional<std::pair<std::size_t, std::size_t>> only_if = {};
  /// Factors of two different groups are not combined; a factor without a group is combined with all.
  std::string group = {};
};

/// A choice for each factor: an index into its values, or nullopt where the factor has no meaning.
using Choices = std::vector<std::optional<std::size_t>>;

/// Returns whether choices, some of which may still be open, can be combined.
using Allowed = std::function<bool(const Choices&)>;

/// Rows, and how many of the wanted combinations they contain.
struct CoveringArray {
  std::vector<Choices> rows;
  std::size_t combinations;  ///< wanted, and allowed by themselves
  std::size_t left;          ///< how many of these are in no row
};

/// Returns rows in which every wanted combination of values of any `strength` (2 or 3) factors occurs, if it is allowed
/// by itself: a greedy covering array (Cohen et al., The AETG system, 1997). The rows are the same on every machine.
/// `most` limits the number of rows; the first ones have the most new combinations.
CoveringArray covering_array(const std::vector<Factor>& factors, std::size_t strength, const Allowed& allowed,
                             std::size_t most = SIZE_MAX);

/// Returns the number of combinations that no row has: 0, unless an allowed combination cannot be completed to an
/// allowed row.
std::size_t uncovered_combinations(const std::vector<Factor>& factors, std::size_t strength, const Allowed& allowed,
                                   const std::vector<Choices>& rows);

/// Returns, for each row, the groups that have a new combination in it (of their own factors and those without a
/// group): all combinations still occur if each row is tried only for these groups.
std::vector<std::set<std::string>> groups_with_news(const std::vector<Factor>& factors, std::size_t strength,
                                                    const std::vector<Choices>& rows);

}  // namespace penumbra::tests
