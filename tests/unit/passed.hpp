// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "selftest/check.hpp"

#include <gtest/gtest.h>

namespace penumbra::tests {

/// Expects that a check of the self-test passed.
inline void expect_passed(const selftest::Check& check) {
  EXPECT_TRUE(check.passed()) << check.pass << " against " << check.against << " (" << check.rule
                              << "): " << check.wrong << " of " << check.compared
                              << " wrong, the first: " << check.first << check.refused;
}

}  // namespace penumbra::tests
