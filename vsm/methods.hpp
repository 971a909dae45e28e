#pragma once

#include "engines/method_row.hpp"
#include "render/machine.hpp"
#include "visibility/method.hpp"

#include <memory>
#include <span>

/// Factory and description of each method; a description needs no device.
namespace penumbra::vsm {

/// The table of this room's methods; the best come first.
std::span<const engines::MethodRow> methods();

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

/// `hierarchical-penumbra` (Laine and Aila 2005): from all pairs of a view sample and a light sample, each triangle
/// takes away those that it is between, whole boxes of pairs at once. Planar lights and suns; every bit is the truth of
/// its pair. On the processor. docs/hierarchical-penumbra.md.
std::unique_ptr<visibility::Method> make_hierarchical_penumbra(const visibility::MethodOptions& options);

/// `view-sample-planar` (Eisemann and Décoret 2007): footprints of triangles on planar receivers, or on a height field,
/// and left-sample maps. Planar lights and suns. With lookup=exact every bit is the truth of its pair, with
/// lookup=nearest what the map says. On the processor. docs/view-sample-planar.md.
std::unique_ptr<visibility::Method> make_view_sample_planar(const visibility::MethodOptions& options);

/// `alias-free`: the irregular z-buffer (Aila and Laine 2004; Johnson et al. 2005). Hard shadows of the light's centre,
/// decided exactly at each view sample; every kind of light. On the processor. docs/alias-free.md.
std::unique_ptr<visibility::Method> make_alias_free(const visibility::MethodOptions& options);

}  // namespace penumbra::vsm
