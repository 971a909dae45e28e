#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::vsm {

/// `hierarchical-penumbra` (Laine and Aila 2005): from all pairs of a view sample and a light sample, each triangle
/// takes away those that it is between, whole boxes of pairs at once. Planar lights and suns; every bit is the truth of
/// its pair. On the processor. docs/hierarchical-penumbra.md.
std::unique_ptr<visibility::Method> make_hierarchical_penumbra(const visibility::MethodOptions& options);

}  // namespace penumbra::vsm
