// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: views of one light point's maps and push constants of look-ups. maps/README.md has the
// notation.
#ifndef PENUMBRA_MAPS_MAP_VIEW  // included more than once by shaders, hence an include guard in place of #pragma once
#define PENUMBRA_MAPS_MAP_VIEW
#ifdef __cplusplus
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
namespace penumbra::maps::gpu {
using glm::vec2;
using glm::vec3;
using uint = std::uint32_t;
inline constexpr uint kLookupGroup = 64;
inline constexpr uint kWholeLight = 1u << 30;
inline constexpr float kCircle = -1.0F;
inline constexpr uint kDepthFirst = 0, kDepthSecond = 1, kDepthMidpoint = 2, kDepthDual = 3;
#else
const uint kLookupGroup = 64;       // invocations of a look-up's workgroup
const float kCircle = -1.0;         // in place of a ratio of logarithms: the face is a paraboloid's circle
const uint kWholeLight = 1u << 30;  // unit of the light in group_scalar_main.glsl: hidden light is counted in parts of
                                    // 1 / kWholeLight
// LookupPush::depth_use: the surface of a texel behind which a receiver is in shadow.
const uint kDepthFirst = 0, kDepthSecond = 1, kDepthMidpoint = 2, kDepthDual = 3;
#endif

// One side of the light's plane as seen from a light point. With d = (x, y, z) in the light's basis, z > 0 on this
// side: one face holds the directions (x/z, y/z) in a window; five (a hemicube) hold every direction.
struct SideView {
  vec2 lower, upper;  // window of (x/z, y/z); one face only
  uint first_face;    // index among the faces of its light point
  uint face_count;    // 0: no receiver on this side; 1: a window; 5: a hemicube
};

struct LightView {
  vec3 point;        // the light point, in scene floats
  float far;         // distance beyond every receiver and caster; maps hold (distance along the face's axis) / far
  SideView side[2];  // 0: where the light's normal points, 1: behind
};

// Axes of the light's plane, orthonormal; n points to the emitting side.
struct LightBasis {
  vec3 u, v, n;
};

// View sample in the form used by look-ups. n is zero for samples without shadow: background, the light's own body,
// receivesShadow false.
struct Receiver {
  vec3 p, n;
  uint plane;   // index of the plane of the sample's triangle (visibility::SceneFloats); all ones for objects that cast
                // no shadow
  uint object;  // index of the sample's object; all ones for objects that cast no shadow
};

// Push constants of caster.vert and caster.frag: one face.
struct CasterPush {
  vec3 point;
  float near;
  vec3 row_x;  // clip.x = dot(row_x, corner - point); y and w in the same form
  float far;
  vec3 row_y;
  uint first_vertex;
  vec3 row_w;
  float offset_factor;  // polygon offset: factor of the change of depth across a texel, added to depths
  vec3
      depth_row;  // depth / clip.w = dot(depth_row, (x, y, 1)) at the pixel (x, y): (0, 0, 1) unless the face is warped
  float offset_units;  // polygon offset: constant added to depths. Whole 16 bytes, so that the next member has the same
                       // offset in both layouts (render/both.glsl)
};

// Push constants of logarithmic.vert and logarithmic.frag: a face whose rows are logarithms of those of a warped face
// (Lloyd et al. 2008), with b in [0, 1] across the contents: -log(1 - b (1 - 1/ratio)) / log(ratio).
struct LogarithmicPush {
  vec3 point;
  float far;
  vec3 row_a;  // a = dot(row_a, x - point) / dot(row_k, x - point); b in the same form
  float ratio;
  vec3 row_b;
  uint first_vertex;
  vec3 row_k;
  uint size;
  vec3 inverse_a;  // direction of (a, b): inverse_a a + inverse_b b + inverse_1
  float margin;    // fraction of the face on either side of b in [0, 1]
  vec3 inverse_b;
  uint peels;  // 1: draws the surfaces behind the layer that begins at `previous` in the maps, in texels
  vec3 inverse_1;
  uint previous;
  vec3 along;  // the face's axis
  uint filler;
};

// Push constants of peel.frag: a face of a deeper layer. caster.vert reads the first part.
struct PeelPush {
  CasterPush face;
  uint previous;  // first texel of the previous layer in the maps
  uint size;
};

// Last words of the results of look-ups by workgroups, some of whose loops a driver may end (group_kernel.glsl). Three
// lists of one word for each receiver precede this struct: the workgroups that run in this pass, those to be repeated,
// and the numbers of those that a sorting pass left (GroupList).
struct CutLoops {
  uint any;     // 1: some workgroup's loops were ended
  uint asked;   // first word of the first list; 0: all workgroups run
  uint to_ask;  // first word of the second list
};
const uint kCutLoopWords = 3;

// Words before CutLoops, for look-ups with a sorting pass (group_list.glsl).
struct GroupList {
  uint count;  // number of listed workgroups of the part of the tile that was sorted last
  uint first;  // first word of the list, whose entries for a part begin at the part's first result
};
const uint kGroupListWords = 2;

// Push constants of every look-up, followed by the look-up's own.
struct LookupPush {
  LightBasis basis;
  float bias;      // in texels
  uint size;       // of a face, texels on a side
  uint two_sided;  // 1: the light emits to both sides of its plane; 2: a sphere, whose plane exists only for the maps
  uint first_receiver;  // in the receivers' buffer
  uint receiver_count;
  uint first_result;     // position of the results of the first receiver, counted in receivers
  uint words_per_pixel;  // of results: a mask's words, or 1 for V
  uint first_point;      // first of the light points whose maps are looked up; all of these points are bits of one word
  uint point_count;
  uint faces;      // of one light point; layer i of the centre's maps begins at face i * faces
  uint layers;     // of maps from the light's centre
  uint depth_use;  // kDepthFirst ...
  uint first_row;  // rows of a map processed in this pass
  uint last_row;
  uint width;      // number of receivers in a row of the picture
  uint own_depth;  // 1: texels are compared with the receiver's own depth, as published; 0: with its plane
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_MAP_VIEW
