// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/method_row.hpp"
#include "render/machine.hpp"
#include "visibility/method.hpp"

#include <memory>
#include <span>

/// Factory and description of each method; a description needs no device.
namespace penumbra::vsm {

/// Returns the table of this folder's methods, the best first.
std::span<const engines::MethodRow> methods();

/// Makes `view-sample`: triangle-bitmask view-sample mapping for arbitrary receivers (Eisemann-Décoret 2007, Sintorn et
/// al. 2008), for every light (spheres and suns only on the processor's vector units), one- and two-sided, any 1 … 4096
/// light samples, any triangle soup; no bias, no adjacency. Every bit is the truth of its pair
/// (visibility/pair_truth.hpp): float arithmetic with error bounds, the few open questions by exact predicates. The
/// device must outlive the method.
std::unique_ptr<visibility::Method> make_view_sample(const render::Machine& machine,
                                                     const visibility::MethodOptions& options);

/// Returns whether this light's shadows are computed on the processor although the method has a device.
bool view_sample_on_vectors(const render::Machine& machine, const visibility::MethodOptions& options,
                            const visibility::Light& light);

/// Returns the description with the given options. Callable without a Vulkan device.
visibility::MethodDescription view_sample_description(const visibility::MethodOptions& options = {});

/// Makes `hierarchical-penumbra` (Laine and Aila 2005): from all pairs of a view sample and a light sample, each
/// triangle removes the pairs that it hides, whole boxes of pairs at once. Planar lights and suns; every bit is the
/// truth of its pair. On the processor. docs/hierarchical-penumbra.md.
std::unique_ptr<visibility::Method> make_hierarchical_penumbra(const visibility::MethodOptions& options);

/// Makes `view-sample-planar` (Eisemann and Décoret 2007): footprints of triangles on planar receivers, or on a height
/// field, and left-sample maps. Planar lights and suns. With lookup=exact every bit is the truth of its pair, with
/// lookup=nearest the content of the map. On the processor. docs/view-sample-planar.md.
std::unique_ptr<visibility::Method> make_view_sample_planar(const visibility::MethodOptions& options);

/// Makes `alias-free`: the irregular z-buffer (Aila and Laine 2004; Johnson et al. 2005). Hard shadows of the light's
/// centre, decided exactly at each view sample; every kind of light. On the processor. docs/alias-free.md.
std::unique_ptr<visibility::Method> make_alias_free(const visibility::MethodOptions& options);

}  // namespace penumbra::vsm
