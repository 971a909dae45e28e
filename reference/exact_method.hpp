#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::reference {

/// `exact`: V of each view sample as the area that areas/exact_area.hpp defines, and the form factor of that region.
/// Evaluates only the pixels that the host wants (Method::want_pixels).
std::unique_ptr<visibility::Method> make_exact(const visibility::MethodOptions& options);

}  // namespace penumbra::reference
