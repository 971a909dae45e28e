#pragma once

#include "render/machine.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method; a description needs no device.
namespace penumbra::volumes {

/// `edge-scatter`: signed silhouette edges scattered into a grid of light samples, one running sum a light row.
/// Any light, one- and two-sided, any pattern, any triangle soup, no bias; on the device planar lights. Every bit is
/// the truth of its pair: what float arithmetic leaves open is decided by exact predicates. docs/edge-scatter.md.
std::unique_ptr<visibility::Method> make_edge_scatter(const render::Machine& machine,
                                                      const visibility::MethodOptions& options);

/// Are this light's shadows computed on the processor's vector units, though the method is given a device?
bool edge_scatter_on_vectors(const render::Machine& machine, const visibility::MethodOptions& options,
                             const visibility::Light& light);

/// What it is; needs no device.
/// With these options, which must be among its own: rows=exact has no masks. Throws UsageError for options that exclude
/// each other.
visibility::MethodDescription edge_scatter_description(const visibility::MethodOptions& options = {});

}  // namespace penumbra::volumes
