// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "selftest/check.hpp"

#include <vector>

namespace penumbra::selftest {

/// Runs all checks, on small scenes, in seconds. A check that cannot run has a reason (Check::refused), including all
/// checks of OpenGL where it is not available.
std::vector<Check> run_self_test(const render::Device& device);

}  // namespace penumbra::selftest
