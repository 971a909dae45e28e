// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::vsm {

/// Makes `view-sample` with variant=sintorn, as in Sintorn, Eisemann and Assarsson 2008: view samples in lists of light
/// pixels, twelve-point hulls, conservative rasterisation. Planar lights and suns; every bit is the truth of its pair.
/// Runs on the processor (docs/view-sample.md).
std::unique_ptr<visibility::Method> make_view_sample_lists(visibility::MethodDescription description);

}  // namespace penumbra::vsm
