// SPDX-License-Identifier: Apache-2.0
#pragma once

// Small scenes for tests of visibility and of its oracles; they are those of the self-test.

#include "selftest/small_scenes.hpp"

namespace penumbra::tests {

using namespace selftest;  // NOLINT(google-build-using-namespace): they were made for tests

}  // namespace penumbra::tests
