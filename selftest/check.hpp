#pragma once

#include <cstdint>
#include <limits>
#include <string>

/// The device's passes, on whatever device and driver there is, held against their twins in C++: the comparisons that
/// tests make on scenes of theirs, and `penumbra devices --self-test` on the user's machine.
namespace penumbra::selftest {

/// One pass against what says what is right.
struct Check {
  std::string pass;
  std::string against{};
  std::string rule{};           ///< what must hold, in words
  std::uint64_t compared = 0;   ///< values
  std::uint64_t differing = 0;  ///< that are not the twin's own
  std::uint64_t wrong = 0;      ///< that break the rule
  double largest = 0,
         allowed = 0;     ///< the difference that comes nearest to its bound, or is farthest beyond, and that bound
  std::string first{};    ///< the first wrong one: where, and what it is
  std::string refused{};  ///< why it could not run, if so
  bool lacking = false;   ///< it could not because this device lacks what the pass needs: no fault

  [[nodiscard]] bool passed() const { return refused.empty() && wrong == 0 && compared > 0; }

  /// A value that must be the twin's own.
  template <typename T, typename Where>
  void same(const T& found, const T& expected, const Where& where) {
    ++compared;
    if (found == expected) return;
    ++differing;
    fail(where);
  }
  /// A value that may be off by `bound`.
  template <typename Where>
  void within(double difference, double bound, const Where& where) {
    ++compared;
    differing += difference != 0 ? 1 : 0;
    keep_worst(difference, bound);
    if (!(difference <= bound)) fail(where);
  }
  /// A difference, and what is allowed there: kept if it comes nearer to its bound than any before.
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
  /// Joins what another run of the same check found.
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
