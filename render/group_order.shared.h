// SPDX-License-Identifier: Apache-2.0
#ifndef PENUMBRA_RENDER_GROUP_ORDER
#define PENUMBRA_RENDER_GROUP_ORDER
// The order of workgroups, for C++ and GLSL: see render/group_order.glsl.
#ifdef __cplusplus
#include <cstdint>
namespace penumbra::render::gpu {
using uint = std::uint32_t;
inline constexpr uint kStripsConstant = 100;
/// Value of the specialization constant kStripsConstant on processors. A strip of a picture of 512 x 512 pixels is
/// eight rows.
inline constexpr uint kStripsOnProcessor = 64;
}  // namespace penumbra::render::gpu
#else
const uint kStripsConstant = 100;  // specialization constant that every compute pass sets
#endif
#endif  // PENUMBRA_RENDER_GROUP_ORDER
