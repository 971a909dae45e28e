// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"
#include "volumes/counters/vectors/edge_search.hpp"

#include <memory>

namespace penumbra::volumes {

/// Makes `depth-complexity` on the processor's own vector units (depth-complexity with engine=native): variant=soup,
/// every light and pattern. Gives the same bits as the device, since every bit is the truth of its pair.
/// docs/depth-complexity.md, "On vector units".
std::unique_ptr<visibility::Method> make_depth_complexity_on_vectors(visibility::MethodDescription description,
                                                                     Search search);

}  // namespace penumbra::volumes
