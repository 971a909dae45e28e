#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::vsm {

/// `view-sample` on the processor's own vector units (view-sample with engine=native): every light and
/// pattern. The same bits, since every one is the truth of its pair.
/// docs/view-sample.md, "On vector units".
std::unique_ptr<visibility::Method> make_view_sample_on_vectors(visibility::MethodDescription description);

}  // namespace penumbra::vsm
