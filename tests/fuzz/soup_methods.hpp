// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "tests/fuzz/soup_case.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace penumbra::fuzz {

/// Findings of one case, or of many.
struct SoupFindings {
  std::uint64_t cases = 0, pairs = 0, visible = 0;  ///< pairs: those of each case, as the judge decides them
  std::uint64_t answers = 0;                        ///< pairs that a method answered
  std::uint64_t refusals = 0;  ///< cases that a method refused because float32 cannot represent them
  std::uint64_t wrong = 0;
  std::string first_wrong;  ///< which method, and the pair in numbers

  void operator+=(const SoupFindings& other);
};

/// Every method that promises the truth of its pairs in all bits, in each of its variants, on one device.
class SoupMethods {
 public:
  explicit SoupMethods(const render::Device& device) : device_(&device) {}

  /// Compares every bit of every method, and visibility::decide_pair, with SoupJudge.
  SoupFindings check(const SoupCase& judged);

 private:
  struct Variant {
    std::string name;
    std::unique_ptr<visibility::Method> method;
  };
  /// Returns the variants for this number and kind of light samples, because a method that gets other light samples
  /// compiles its shaders again.
  std::vector<Variant>& variants_for(const visibility::Light& light);

  const render::Device* device_;
  std::map<std::tuple<visibility::LightKind, std::uint32_t, std::uint32_t>, std::vector<Variant>> variants_;
};

}  // namespace penumbra::fuzz
