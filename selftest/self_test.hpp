#pragma once

#include "render/device.hpp"
#include "selftest/check.hpp"

#include <vector>

namespace penumbra::selftest {

/// Everything, on small scenes of its own: seconds. A check that cannot run says why (Check::refused), among them all
/// of OpenGL where there is none.
std::vector<Check> run_self_test(const render::Device& device);

}  // namespace penumbra::selftest
