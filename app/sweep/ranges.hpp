// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// Swept quantity and its values, as texts.
struct SweptKey {
  std::string name;
  std::vector<std::string> values;
};

/// Parses the texts of --over: KEY=VALUE,VALUE,… with further keys after commas. A..B stands for A, 2A, 4A … up to B,
/// A..B+S for A, A + S, A + 2S … up to B. Throws UsageError for any other text, and for a key given twice.
std::vector<SweptKey> parse_over(std::span<const std::string> texts);

}  // namespace penumbra::app
