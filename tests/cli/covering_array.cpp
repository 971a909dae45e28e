// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/covering_array.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_set>
#include <utility>

namespace penumbra::tests {
namespace {

using Code = std::uint64_t;  // up to three (factor, value) pairs of 20 bits each, ascending

Code code_of(std::size_t factor, std::size_t value) {
  return static_cast<Code>(factor) << 10U | static_cast<Code>(value + 1);
}
constexpr unsigned kBits = 20;
constexpr std::size_t factor_of(Code code) {
  return static_cast<std::size_t>(code >> 10U & 1023U);
}

bool apart(const Factor& a, const Factor& b) {
  return !a.group.empty() && !b.group.empty() && a.group != b.group;
}

/// Which pairs of factors are wanted (not those of two different groups), computed once.
class Pairs {
 public:
  explicit Pairs(const std::vector<Factor>& factors) : count_(factors.size()) {
    for (const Factor& a : factors) {
      for (const Factor& b : factors) wanted_.push_back(!apart(a, b));
    }
  }
  [[nodiscard]] bool wanted(std::size_t a, std::size_t b) const { return wanted_[a * count_ + b]; }

 private:
  std::size_t count_;
  std::vector<bool> wanted_;
};

/// Calls `visit(code)` for each wanted combination of `strength` chosen values.
template <typename Visit>
void for_each_combination(const Pairs& pairs, const Choices& row, std::size_t strength, Visit visit) {
  for (std::size_t a = 0; a < row.size(); ++a) {
    if (!row[a]) continue;
    for (std::size_t b = a + 1; b < row.size(); ++b) {
      if (!row[b] || !pairs.wanted(a, b)) continue;
      const Code two = code_of(a, *row[a]) << kBits | code_of(b, *row[b]);
      if (strength == 2) {
        visit(two);
        continue;
      }
      for (std::size_t c = b + 1; c < row.size(); ++c) {
        if (row[c] && pairs.wanted(a, c) && pairs.wanted(b, c)) visit(two << kBits | code_of(c, *row[c]));
      }
    }
  }
}

/// Visits only combinations that contain the value of `factor`.
template <typename Visit>
void for_each_combination_with(const Pairs& pairs, const Choices& row, std::size_t strength, std::size_t factor,
                               Visit visit) {
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i != factor && row[i] && pairs.wanted(i, factor)) others.push_back(i);
  }
  const auto code = [&](std::size_t i) { return code_of(i, *row[i]); };
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (strength == 2) {
      std::array<std::size_t, 2> two{factor, others[i]};
      std::ranges::sort(two);
      visit(code(two[0]) << kBits | code(two[1]));
      continue;
    }
    for (std::size_t j = i + 1; j < others.size(); ++j) {
      if (!pairs.wanted(others[i], others[j])) continue;
      std::array<std::size_t, 3> three{factor, others[i], others[j]};
      std::ranges::sort(three);
      visit((code(three[0]) << kBits | code(three[1])) << kBits | code(three[2]));
    }
  }
}

/// Chooses the factor's value, and the values of other factors on which its meaning depends. Returns false if one of
/// these factors already has another value.
bool choose(const std::vector<Factor>& factors, std::size_t factor, std::size_t value, Choices& row) {
  if (row[factor] && *row[factor] != value) return false;
  row[factor] = value;
  const auto& only_if = factors[factor].only_if;
  return !only_if || choose(factors, only_if->first, only_if->second, row);
}

class Generator {
 public:
  Generator(const std::vector<Factor>& factors, std::size_t strength, const Allowed& allowed)
      : factors_(factors), pairs_(factors), strength_(strength), allowed_(allowed) {
    for (const Factor& factor : factors) used_.emplace_back(factor.values.size(), 0);
    Choices row(factors.size());
    collect(row, 0, strength);
  }

  CoveringArray array(std::size_t most) {
    const std::size_t combinations = open_.size();
    std::vector<Choices> rows;
    for (const auto& [seed, code] : wanted_) {
      if (rows.size() == most) break;
      if (open_.contains(code)) rows.push_back(completed(seed, rows.size()));
    }
    return {std::move(rows), combinations, open_.size()};
  }

  std::size_t without(const std::vector<Choices>& rows) {
    for (const Choices& row : rows) cover(row);
    return open_.size();
  }

 private:
  /// Adds all combinations of `left` more factors, starting at `first`.
  void collect(const Choices& row, std::size_t first, std::size_t left) {
    if (left == 0) {
      add(row);
      return;
    }
    for (std::size_t factor = first; factor < factors_.size(); ++factor) {
      if (!goes_with(row, factor)) continue;
      for (std::size_t value = 0; value < factors_[factor].values.size(); ++value) {
        Choices more = row;
        more[factor] = value;
        collect(more, factor + 1, left - 1);
      }
    }
  }

  [[nodiscard]] bool goes_with(const Choices& row, std::size_t factor) const {
    for (std::size_t i = 0; i < factor; ++i) {
      if (row[i] && !pairs_.wanted(i, factor)) return false;
    }
    return true;
  }

  void add(const Choices& combination) {
    Choices seed = combination;
    for (std::size_t factor = 0; factor < seed.size(); ++factor) {
      if (combination[factor] && !choose(factors_, factor, *combination[factor], seed)) return;
    }
    if (!allowed_(seed)) return;
    for_each_combination(pairs_, combination, strength_, [&](Code code) {
      wanted_.emplace_back(seed, code);
      open_.insert(code);
    });
  }

  Choices completed(Choices row, std::size_t number) {
    const std::size_t count = row.size();
    for (std::size_t i = 0; i < 2 * count; ++i) {  // twice: a factor without meaning at first may gain one
      const std::size_t factor = (i + number) % count;
      if (!row[factor] && means_something(row, factor)) row[factor] = best_value(row, factor);
    }
    cover(row);
    return row;
  }

  [[nodiscard]] bool means_something(const Choices& row, std::size_t factor) const {
    const auto& only_if = factors_[factor].only_if;
    return !only_if || row[only_if->first] == only_if->second;
  }

  /// Returns the allowed value that covers the most open combinations; if there are several, the one used least.
  [[nodiscard]] std::optional<std::size_t> best_value(Choices row, std::size_t factor) const {
    std::optional<std::size_t> best;
    std::pair<std::size_t, std::size_t> best_gain;
    for (std::size_t value = 0; value < factors_[factor].values.size(); ++value) {
      row[factor] = value;
      if (!allowed_(row)) continue;
      std::size_t gain = 0;
      for_each_combination_with(pairs_, row, strength_, factor,
                                [&](Code code) { gain += open_.contains(code) ? 1 : 0; });
      const std::pair<std::size_t, std::size_t> now{gain, SIZE_MAX - used_[factor][value]};
      if (best && now <= best_gain) continue;
      best = value;
      best_gain = now;
    }
    return best;
  }

  void cover(const Choices& row) {
    for_each_combination(pairs_, row, strength_, [&](Code code) { open_.erase(code); });
    for (std::size_t factor = 0; factor < row.size(); ++factor) {
      if (row[factor]) ++used_[factor][*row[factor]];
    }
  }

  const std::vector<Factor>& factors_;
  Pairs pairs_;
  std::size_t strength_;
  const Allowed& allowed_;
  std::vector<std::pair<Choices, Code>> wanted_;
  std::unordered_set<Code> open_;
  std::vector<std::vector<std::size_t>> used_;
};

}  // namespace

CoveringArray covering_array(const std::vector<Factor>& factors, std::size_t strength, const Allowed& allowed,
                             std::size_t most) {
  return Generator(factors, strength, allowed).array(most);
}

std::size_t uncovered_combinations(const std::vector<Factor>& factors, std::size_t strength, const Allowed& allowed,
                                   const std::vector<Choices>& rows) {
  return Generator(factors, strength, allowed).without(rows);
}

std::vector<std::set<std::string>> groups_with_news(const std::vector<Factor>& factors, std::size_t strength,
                                                    const std::vector<Choices>& rows) {
  const Pairs pairs(factors);
  std::unordered_set<Code> seen;
  std::vector<std::set<std::string>> news(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for_each_combination(pairs, rows[i], strength, [&](Code code) {
      if (!seen.insert(code).second) return;
      for (Code rest = code; rest != 0; rest >>= kBits) {
        const std::string& group = factors[factor_of(rest)].group;
        if (!group.empty()) news[i].insert(group);
      }
    });
  }
  return news;
}

}  // namespace penumbra::tests
