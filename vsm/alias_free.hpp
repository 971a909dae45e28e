#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::vsm {

/// `alias-free`: the irregular z-buffer (Aila and Laine 2004; Johnson et al. 2005). Hard shadows of the light's centre,
/// decided exactly at each view sample; every kind of light. On the processor. docs/alias-free.md.
std::unique_ptr<visibility::Method> make_alias_free(const visibility::MethodOptions& options);

}  // namespace penumbra::vsm
