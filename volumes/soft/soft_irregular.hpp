#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::volumes {

/// `soft-irregular` (Johnson et al. 2009): an irregular shadow map of the light's centre for the umbra, and the
/// penumbra wedges of the centre's silhouettes drawn over view samples in a grid of the light's frustum, with signed
/// areas by arc cosines. Planar lights; on the processor. V is that of `soft-volume` with umbra=layers, and as
/// published, with umbra=map, wrong where one occluder is behind another. docs/soft-irregular.md.
std::unique_ptr<visibility::Method> make_soft_irregular(const visibility::MethodOptions& options);

}  // namespace penumbra::volumes
