// SPDX-License-Identifier: Apache-2.0
// Push constants shared by C++ and GLSL: the camera of the visibility buffer, in double, relative to the scene's
// origin.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace penumbra::render::gpu {
using uint = std::uint32_t;
#define DOUBLE3(name) double name[3]
#else
#define DOUBLE3(name) dvec3 name
#endif

struct VisibilityBufferPush {
  DOUBLE3(eye);
  DOUBLE3(right);
  DOUBLE3(up);
  DOUBLE3(middle);  // toward the picture's centre; not forward if the lens is shifted
  double tan_half_fov;
  uint width, height;         // size of the whole picture
  uint first_row, row_count;  // the band in the buffers
};

#ifdef __cplusplus
}  // namespace penumbra::render::gpu
#endif
#undef DOUBLE3
