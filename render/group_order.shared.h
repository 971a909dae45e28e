// SPDX-License-Identifier: Apache-2.0
#ifndef PENUMBRA_RENDER_GROUP_ORDER
#define PENUMBRA_RENDER_GROUP_ORDER
// The order of workgroups, for C++ and GLSL: see render/group_order.glsl.
#ifdef __cplusplus
#include <cstdint>
namespace penumbra::render::gpu {
using uint = std::uint32_t;
inline constexpr uint kStripsConstant = 100;
inline constexpr uint kStripsOnProcessor = 64;
}  // namespace penumbra::render::gpu
#else
const uint kStripsConstant = 100;    // specialization constant that every compute pass sets
const uint kStripsOnProcessor = 64;  // its value where workgroups take turns
#endif
#endif  // PENUMBRA_RENDER_GROUP_ORDER
