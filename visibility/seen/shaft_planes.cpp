// SPDX-License-Identifier: Apache-2.0
// Compares the boxes and triangles of a mesh with a shaft's planes, a vector of planes at a time.

#include "visibility/seen/shaft_planes.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/seen/shaft_planes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace penumbra::visibility::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<double, 8> kDoubles{};
using Doubles = hn::Vec<decltype(kDoubles)>;

/// A bit for each vector of planes; set: the planes cut a box, and must be compared with its contents.
using Cutting = std::uint64_t;

Cutting all_of(const ShaftPlanes& planes) {
  const std::size_t vectors = (planes.count + hn::Lanes(kDoubles) - 1) / hn::Lanes(kDoubles);
  return vectors == 0 ? 0 : ~Cutting{0} >> (64 - vectors);
}

Doubles dot(Doubles x, Doubles y, Doubles z, const glm::dvec3& point) {
  return hn::Add(hn::Add(hn::Mul(x, hn::Set(kDoubles, point.x)), hn::Mul(y, hn::Set(kDoubles, point.y))),
                 hn::Mul(z, hn::Set(kDoubles, point.z)));
}

/// Returns whether the box may reach into the shaft, tested with the planes in `cutting`; removes planes that the whole
/// box is inside of.
bool touches(const ShaftPlanes& planes, const MiddleBox& box, Cutting& cutting) {
  for (Cutting left = cutting; left != 0; left &= left - 1) {
    const auto number = static_cast<std::uint32_t>(std::countr_zero(left));
    const std::size_t at = number * hn::Lanes(kDoubles);
    const Doubles x = hn::Load(kDoubles, &planes.x[at]), y = hn::Load(kDoubles, &planes.y[at]),
                  z = hn::Load(kDoubles, &planes.z[at]), most = hn::Load(kDoubles, &planes.most[at]);
    const Doubles middle = dot(x, y, z, box.middle), half = dot(hn::Abs(x), hn::Abs(y), hn::Abs(z), box.half);
    if (!hn::AllFalse(kDoubles, hn::Gt(hn::Sub(middle, half), most))) return false;
    if (hn::AllTrue(kDoubles, hn::Le(hn::Add(middle, half), most))) cutting &= ~(Cutting{1} << number);
  }
  return true;
}

bool touches(const ShaftPlanes& planes, const mesh::TriangleSoup& soup, std::uint32_t triangle, Cutting cutting) {
  const auto& [a, b, c] = soup.triangles[triangle];
  const glm::dvec3 &one = soup.positions[a], &two = soup.positions[b], &three = soup.positions[c];
  for (; cutting != 0; cutting &= cutting - 1) {
    const std::size_t at = static_cast<std::uint32_t>(std::countr_zero(cutting)) * hn::Lanes(kDoubles);
    const Doubles x = hn::Load(kDoubles, &planes.x[at]), y = hn::Load(kDoubles, &planes.y[at]),
                  z = hn::Load(kDoubles, &planes.z[at]);
    const Doubles least = hn::Min(hn::Min(dot(x, y, z, one), dot(x, y, z, two)), dot(x, y, z, three));
    if (!hn::AllFalse(kDoubles, hn::Gt(least, hn::Load(kDoubles, &planes.most[at])))) return false;
  }
  return true;
}

void touched_here(const BoxTree& tree, const mesh::TriangleSoup& soup, const ShaftPlanes& planes,
                  std::vector<std::uint32_t>& triangles) {
  struct Waiting {
    std::uint32_t node;
    Cutting cutting;
  };
  std::array<Waiting, BoxTree::kDepth> stack;
  std::uint32_t top = 0;
  stack[top++] = {0, all_of(planes)};
  while (top > 0) {
    Waiting waiting = stack[--top];
    const BoxTree::Node& node = tree.node(waiting.node);
    if (!touches(planes, node.box, waiting.cutting)) continue;
    if (node.count > 0) {
      for (const std::uint32_t triangle : tree.items(node)) {
        if (touches(planes, soup, triangle, waiting.cutting)) triangles.push_back(triangle);
      }
      continue;
    }
    stack[top++] = {node.first, waiting.cutting};
    stack[top++] = {waiting.node + 1, waiting.cutting};
  }
}

}  // namespace
}  // namespace penumbra::visibility::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::visibility {

HWY_EXPORT(touched_here);

void touched(const BoxTree& tree, const mesh::TriangleSoup& soup, const ShaftPlanes& planes,
             std::vector<std::uint32_t>& triangles) {
  HWY_DYNAMIC_DISPATCH(touched_here)(tree, soup, planes, triangles);
}

}  // namespace penumbra::visibility
#endif
