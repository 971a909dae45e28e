// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal to this room: Embree's calls for one, four, eight or sixteen rays under one name.

#include <embree3/rtcore.h>

#include <limits>
#include <type_traits>

namespace penumbra::reference {

template <int kWidth>
struct Packet;
template <>
struct Packet<1> {
  using Rays = RTCRay;
  using Hits = RTCRayHit;
  static void occluded(const int* /*valid*/, RTCScene scene, RTCIntersectContext* context, Rays* rays) {
    rtcOccluded1(scene, context, rays);
  }
  static void intersect(const int* /*valid*/, RTCScene scene, RTCIntersectContext* context, Hits* rays) {
    rtcIntersect1(scene, context, rays);
  }
};
// NOLINTBEGIN(readability-identifier-naming): these constants are called, and are named, as the functions above
template <>
struct Packet<4> {
  using Rays = RTCRay4;
  using Hits = RTCRayHit4;
  static constexpr auto occluded = rtcOccluded4;
  static constexpr auto intersect = rtcIntersect4;
};
template <>
struct Packet<8> {
  using Rays = RTCRay8;
  using Hits = RTCRayHit8;
  static constexpr auto occluded = rtcOccluded8;
  static constexpr auto intersect = rtcIntersect8;
};
template <>
struct Packet<16> {
  using Rays = RTCRay16;
  using Hits = RTCRayHit16;
  static constexpr auto occluded = rtcOccluded16;
  static constexpr auto intersect = rtcIntersect16;
};
// NOLINTEND(readability-identifier-naming)

/// Returns the lanes of a packet's field, which is an array, or of a single ray's, which is not.
template <typename Field>
auto* lanes(Field& field) {
  if constexpr (std::is_array_v<Field>) {
    return &field[0];
  } else {
    return &field;
  }
}

/// Value that Embree writes to tfar of an occluded ray.
inline constexpr float kOccluded = -std::numeric_limits<float>::infinity();

}  // namespace penumbra::reference
