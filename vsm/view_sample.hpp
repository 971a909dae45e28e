#pragma once

#include "render/machine.hpp"
#include "visibility/method.hpp"

#include <memory>

namespace penumbra::vsm {

/// `view-sample`: triangle-bitmask view-sample mapping for arbitrary receivers (Eisemann-Décoret 2007, Sintorn et al.
/// 2008) of every light (spheres and suns on the processor's vector units alone), one- and two-sided, any 1 … 4096
/// light samples, any triangle soup; no bias, no adjacency. Every bit is the truth of its pair
/// (visibility/pair_truth.hpp): float arithmetic with error bounds, the few open questions by exact predicates. The
/// device must outlive it.
std::unique_ptr<visibility::Method> make_view_sample(const render::Machine& machine,
                                                     const visibility::MethodOptions& options);

/// Are this light's shadows computed on the processor, though the method is given a device?
bool view_sample_on_vectors(const render::Machine& machine, const visibility::MethodOptions& options,
                            const visibility::Light& light);

/// What it is with these options; needs no device.
visibility::MethodDescription view_sample_description(const visibility::MethodOptions& options = {});

}  // namespace penumbra::vsm
