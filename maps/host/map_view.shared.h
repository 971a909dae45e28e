// One struct, two languages: how the maps of one light point cover what they cover. README.md has the picture.
#ifndef PENUMBRA_MAPS_MAP_VIEW  // shaders include this in several ways
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
const uint kWholeLight = 1u << 30;  // group_scalar_main.glsl: hidden light is counted in parts of this
// LookupPush::depth_use: what of a texel's surfaces a receiver must be behind, to be in its shadow.
const uint kDepthFirst = 0, kDepthSecond = 1, kDepthMidpoint = 2, kDepthDual = 3;
#endif

// One side of the light's plane as a light point sees it. With d = (x, y, z) in the light's basis, z > 0 on this side:
// one face holds the directions (x/z, y/z) in a window; five (a hemicube) hold every direction.
struct SideView {
  vec2 lower, upper;  // window of (x/z, y/z); one face only
  uint first_face;    // among the faces of its light point
  uint face_count;    // 0: no receiver on this side; 1: a window; 5: a hemicube
};

struct LightView {
  vec3 point;        // the light point, in scene floats
  float far;         // beyond every receiver and caster; maps hold (distance along the face's axis) / far
  SideView side[2];  // 0: where the light's normal points, 1: behind
};

// Axes of the light's plane, orthonormal; n points to the emitting side.
struct LightBasis {
  vec3 u, v, n;
};

// A view sample as the look-ups take it. n is zero where nothing is shadowed: background, the light's own body,
// receivesShadow false.
struct Receiver {
  vec3 p, n;
  uint plane;   // the number of its triangle's plane (visibility::SceneFloats); all ones where it casts no shadow
  uint object;  // the number of its object; all ones where it casts no shadow
};

// caster.vert, caster.frag: one face.
struct CasterPush {
  vec3 point;
  float near;
  vec3 row_x;  // clip.x = dot(row_x, corner - point), likewise y and w
  float far;
  vec3 row_y;
  uint first_vertex;
  vec3 row_w;
  float offset_factor;  // polygon offset: depths grow by so many times their change across a texel
  vec3
      depth_row;  // depth / clip.w = dot(depth_row, (x, y, 1)) at the pixel (x, y): (0, 0, 1) unless the face is warped
  float offset_units;  // and by this. Whole 16 bytes, so that what follows lies at the same place in both layouts
                       // (render/both.glsl)
};

// logarithmic.vert, logarithmic.frag: a face whose rows are logarithms of those of a warped face (Lloyd et al. 2008),
// with b in [0, 1] across what it holds: -log(1 - b (1 - 1/ratio)) / log(ratio).
struct LogarithmicPush {
  vec3 point;
  float far;
  vec3 row_a;  // a = dot(row_a, x - point) / dot(row_k, x - point), likewise b
  float ratio;
  vec3 row_b;
  uint first_vertex;
  vec3 row_k;
  uint size;
  vec3 inverse_a;  // to the direction of (a, b): inverse_a a + inverse_b b + inverse_1
  float margin;    // the share of the face on either side of b in [0, 1]
  vec3 inverse_b;
  uint peels;  // 1: what is behind the layer that begins at `previous` in the maps, in texels
  vec3 inverse_1;
  uint previous;
  vec3 along;  // the face's axis
  uint filler;
};

// peel.frag: a face of a deeper layer. caster.vert reads the first part.
struct PeelPush {
  CasterPush face;
  uint previous;  // where the layer before begins in the maps, in texels
  uint size;
};

// The last words of the results of look-ups by workgroups, some of whose loops a driver may cut off
// (group_kernel.glsl). Two lists of a word for each receiver lie before it: of which workgroups are asked, and which
// are to be asked again.
struct CutLoops {
  uint any;     // 1: some workgroup's loops were cut off
  uint asked;   // where the first list begins; 0: all are asked
  uint to_ask;  // where the second does
};
const uint kCutLoopWords = 3;

// What every look-up needs; its own push constants follow.
struct LookupPush {
  LightBasis basis;
  float bias;      // in texels
  uint size;       // of a face, texels on a side
  uint two_sided;  // 1: the light emits to both sides of its plane; 2: it is a sphere, whose plane is only its maps'
  uint first_receiver;  // in the receivers' buffer
  uint receiver_count;
  uint first_result;     // where the results of the first receiver go, counted in receivers
  uint words_per_pixel;  // of results: a mask's words, or 1 for V
  uint first_point;      // of the light points whose maps are asked; all of them bits of one word
  uint point_count;
  uint faces;      // of one light point; layer i of the centre's maps begins at face i * faces
  uint layers;     // of maps from the light's centre
  uint depth_use;  // kDepthFirst ...
  uint first_row;  // rows of a map that are looked at now; the others, before or after
  uint last_row;
  uint width;      // receivers a row of the picture
  uint own_depth;  // 1: texels are compared with the receiver's own depth, as published; 0: with its plane
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_MAP_VIEW
