// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace penumbra::tests {

/// Returns numbers of a picture as a string of bytes that can be compared.
template <typename Value>
std::string bytes_of(std::span<const Value> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace penumbra::tests
