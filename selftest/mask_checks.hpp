#pragma once

#include "selftest/check.hpp"
#include "selftest/small_scenes.hpp"
#include "visibility/method.hpp"

#include <string>

namespace penumbra::selftest {

/// Every bit of a method with masks that claims the truth, against visibility::decide_pair (exact predicates on the
/// stored floats): all passes that make the mask together.
Check check_masks(visibility::Method& method, const Stage& stage, const std::string& name);

}  // namespace penumbra::selftest
