#pragma once

#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// A quantity and the values that a sweep gives it, as texts.
struct SweptKey {
  std::string name;
  std::vector<std::string> values;
};

/// Reads the texts of --over: KEY=VALUE,VALUE,… with further keys after commas. A..B stands for A, 2A, 4A … up to B,
/// A..B+S for A, A + S, A + 2S … up to B. Throws UsageError for what is no such text, and for a key given twice.
std::vector<SweptKey> parse_over(std::span<const std::string> texts);

}  // namespace penumbra::app
