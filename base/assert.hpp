#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

/// We erred: prints the condition, the place and the values, and aborts; on in release as well.
#define PENUMBRA_ASSERT(condition, ...)                                                                                \
  do {                                                                                                                 \
    if (!(condition)) {                                                                                                \
      fmt::print(stderr, "{}:{}: internal error: {}: {}\n", __FILE__, __LINE__, #condition, fmt::format(__VA_ARGS__)); \
      std::abort();                                                                                                    \
    }                                                                                                                  \
  } while (false)
