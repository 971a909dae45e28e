// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::vsm {

/// Makes `view-sample` on the processor's own vector units (view-sample with engine=native): every light and pattern.
/// Gives the same bits as the device, since every bit is the truth of its pair. docs/view-sample.md, "On vector units".
std::unique_ptr<visibility::Method> make_view_sample_on_vectors(visibility::MethodDescription description);

}  // namespace penumbra::vsm
