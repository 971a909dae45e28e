// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/machine.hpp"
#include "visibility/method.hpp"

#include <memory>

/// Factory and description of each method. Descriptions are callable without a Vulkan device.
namespace penumbra::volumes {

/// Makes `edge-scatter`: signed silhouette edges scattered into a grid of light samples, with a running sum for each
/// light row. Any light, one- and two-sided, any pattern, any triangle soup, no bias; on the device planar lights only.
/// Every bit is the truth of its pair: cases that float arithmetic leaves open are decided by exact predicates.
/// docs/edge-scatter.md.
std::unique_ptr<visibility::Method> make_edge_scatter(const render::Machine& machine,
                                                      const visibility::MethodOptions& options);

/// Returns whether this light's shadows are computed on the processor's vector units although the method has a device.
bool edge_scatter_on_vectors(const render::Machine& machine, const visibility::MethodOptions& options,
                             const visibility::Light& light);

/// Returns the description with the given options; rows=exact has no masks. Callable without a Vulkan device. Throws
/// UsageError for unknown options and options that exclude each other.
visibility::MethodDescription edge_scatter_description(const visibility::MethodOptions& options = {});

}  // namespace penumbra::volumes
