// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

/// Checks an internal invariant: if it fails, prints the condition, the place and the values, and aborts. Active in
/// release builds, too.
#define PENUMBRA_ASSERT(condition, ...)                                                                                \
  do {                                                                                                                 \
    if (!(condition)) {                                                                                                \
      fmt::print(stderr, "{}:{}: internal error: {}: {}\n", __FILE__, __LINE__, #condition, fmt::format(__VA_ARGS__)); \
      std::abort();                                                                                                    \
    }                                                                                                                  \
  } while (false)
