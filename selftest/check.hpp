// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>

/// Comparison of the device's passes, on any device and driver, with their twins in C++: used by tests on their own
/// scenes, and by `penumbra devices --self-test` on the user's machine.
namespace penumbra::selftest {

/// Comparison of one pass with its reference.
struct Check {
  std::string pass;
  std::string against{};
  std::string rule{};           ///< condition to hold, in words
  std::uint64_t compared = 0;   ///< number of values
  std::uint64_t differing = 0;  ///< number of values that differ from the twin's
  std::uint64_t wrong = 0;      ///< number of values that violate the rule
  double largest = 0,
         allowed = 0;     ///< the difference nearest to its bound, or farthest beyond it, and this bound
  std::string first{};    ///< location and value of the first violation
  std::string refused{};  ///< reason why the check could not run, if so
  bool lacking = false;   ///< the check could not run because this device lacks a feature needed by the pass: not a
                          ///< fault

  [[nodiscard]] bool passed() const { return refused.empty() && wrong == 0 && compared > 0; }

  /// Compares a value that must equal the twin's.
  template <typename T, typename Where>
  void same(const T& found, const T& expected, const Where& where) {
    ++compared;
    if (found == expected) return;
    ++differing;
    fail(where);
  }
  /// Compares a value that may be off by `bound`.
  template <typename Where>
  void within(double difference, double bound, const Where& where) {
    ++compared;
    differing += difference != 0 ? 1 : 0;
    keep_worst(difference, bound);
    if (!(difference <= bound)) fail(where);
  }
  /// Keeps a difference and its bound if it is nearer to its bound than all previous ones.
  void keep_worst(double difference, double bound) {
    const auto share = [](double d, double b) {
      return b > 0 ? d / b : d > 0 ? std::numeric_limits<double>::infinity() : 0;
    };
    if (share(difference, bound) < share(largest, allowed) || (difference == 0 && allowed > 0)) return;
    largest = difference;
    allowed = bound;
  }
  template <typename Where>
  void fail(const Where& where) {
    if (wrong++ == 0) first = where();
  }
  /// Adds the result of another run of the same check.
  void add(const Check& more) {
    compared += more.compared;
    differing += more.differing;
    if (wrong == 0) first = more.first;
    wrong += more.wrong;
    if (refused.empty()) refused = more.refused;
    lacking = lacking || more.lacking;
    keep_worst(more.largest, more.allowed);
  }
};

}  // namespace penumbra::selftest
