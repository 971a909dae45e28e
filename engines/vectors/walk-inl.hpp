// SPDX-License-Identifier: Apache-2.0
// Traversals of hierarchies with the shaft from a cluster of view samples to the light, eight children at a time, as in
// volumes/edges/device/find_edges.comp. Inside engines/vectors/ only.

#if defined(PENUMBRA_VECTORS_WALK_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_VECTORS_WALK_INL_HPP
#undef PENUMBRA_VECTORS_WALK_INL_HPP
#else
#define PENUMBRA_VECTORS_WALK_INL_HPP
#endif

#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/trees.hpp"

#include <glm/common.hpp>
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace penumbra::vectors::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kWide>;
using V = hn::Vec<D>;
constexpr std::uint32_t kLeafBit = visibility::TriangleTree::kLeafBit;

struct Point {
  V x, y, z;
};
/// Input of box tests: a cluster of view samples and the light.
struct WalkInput {
  const LightGrid& grid;
  const Cluster& cluster;
  const ClusterSample* alone = nullptr;  ///< as in EdgeInput
};

Point load(const WidePoints& points, std::size_t lane) {
  const D d;
  return {hn::Load(d, &points[0][lane]), hn::Load(d, &points[1][lane]), hn::Load(d, &points[2][lane])};
}
Point minus(const Point& p, const glm::vec3& q) {
  const D d;
  return {hn::Sub(p.x, hn::Set(d, q.x)), hn::Sub(p.y, hn::Set(d, q.y)), hn::Sub(p.z, hn::Set(d, q.z))};
}
/// Computes in a fixed order, without fused multiplications: later stages compute the same products again from equal
/// floats, and must get equal results.
V dot(const Point& p, const glm::vec3& q) {
  const D d;
  return hn::Add(hn::Add(hn::Mul(p.x, hn::Set(d, q.x)), hn::Mul(p.y, hn::Set(d, q.y))), hn::Mul(p.z, hn::Set(d, q.z)));
}
V dot(const Point& p, const Point& q) {
  return hn::Add(hn::Add(hn::Mul(p.x, q.x), hn::Mul(p.y, q.y)), hn::Mul(p.z, q.z));
}
Point absolute(const Point& p) {
  return {hn::Abs(p.x), hn::Abs(p.y), hn::Abs(p.z)};
}
V length(const Point& p) {
  return hn::Sqrt(dot(p, p));
}
V scaled(V v, float factor) {
  return hn::Mul(v, hn::Set(D(), factor));
}

std::uint32_t bits_of(hn::Mask<D> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(D(), mask, bytes);
  return bytes[0];
}
/// The smallest and the largest n · x of a box's points x. Multiplications and additions may be fused here: boxes are
/// only tested against shafts, whose bounds allow for either rounding.
struct Extent {
  V low, high;
};
HWY_INLINE Extent extent(const Point& middle, const Point& half, const glm::vec3& n, const glm::vec3& size) {
  const D d;
  const V at =
      hn::MulAdd(middle.x, hn::Set(d, n.x), hn::MulAdd(middle.y, hn::Set(d, n.y), hn::Mul(middle.z, hn::Set(d, n.z))));
  const V spread = hn::MulAdd(half.x, hn::Set(d, size.x),
                              hn::MulAdd(half.y, hn::Set(d, size.y), hn::Mul(half.z, hn::Set(d, size.z))));
  return {hn::Sub(at, spread), hn::Add(at, spread)};
}

HWY_INLINE hn::Mask<D> box_meets(const WalkInput& in, const Shaft& shaft, const Point& middle, const Point& half) {
  const D d;
  const Extent level = extent(middle, half, in.grid.axis, in.grid.axis_size);
  hn::Mask<D> met = hn::And(hn::Le(level.low, hn::Set(d, shaft.highest)), hn::Ge(level.high, hn::Set(d, shaft.lowest)));
  for (std::size_t i = 0; i < 4; ++i) {
    met = hn::And(met, hn::Le(extent(middle, half, shaft.n[i], shaft.size[i]).low, hn::Set(d, shaft.beyond[i])));
  }
  return met;
}

Point cross(const Point& p, const Point& q) {
  return {hn::Sub(hn::Mul(p.y, q.z), hn::Mul(p.z, q.y)), hn::Sub(hn::Mul(p.z, q.x), hn::Mul(p.x, q.z)),
          hn::Sub(hn::Mul(p.x, q.y), hn::Mul(p.y, q.x))};
}

/// Returns the children all of whose triangles face the cluster from one side: (bound cone) of docs/edge-scatter.md.
hn::Mask<D> same_side(const WalkInput& in, const WideNode& node, std::size_t lane, const Point& middle,
                      const Point& half) {
  const D d;
  const glm::vec3& box = in.cluster.half_size;
  const Point axis{hn::Load(d, &node.cone[0][lane]), hn::Load(d, &node.cone[1][lane]),
                   hn::Load(d, &node.cone[2][lane])};
  const V cosine = hn::Load(d, &node.cone[3][lane]);
  const Point to = minus(middle, in.cluster.middle);
  const Point e{hn::Add(half.x, hn::Set(d, box.x)), hn::Add(half.y, hn::Set(d, box.y)),
                hn::Add(half.z, hn::Set(d, box.z))};
  const V straight = hn::Abs(dot(axis, to)), aside = length(cross(axis, to)), zero = hn::Zero(d);
  const V sine = hn::Sqrt(hn::Max(hn::Sub(hn::Set(d, 1.0F), hn::Mul(cosine, cosine)), zero));
  const V spread = hn::Add(hn::Mul(dot(absolute(axis), e), cosine), hn::Mul(length(e), sine));
  const V least = hn::Sub(hn::Mul(straight, cosine), hn::Mul(aside, sine));
  const V slack = hn::Add(scaled(length(to), 0.0001F), hn::Set(d, 64 * kRound * in.grid.reach));
  return hn::Gt(least, hn::Add(scaled(spread, 1.01F), slack));
}

/// Returns whether objects within these extents, relative to the single view sample and at most `far` from it, appear
/// between two rows of light samples and to the right of the light's left side. (bound gaps of docs/edge-scatter.md)
hn::Mask<D> between_rows(const WalkInput& in, const Extent& across, const Extent& along, const Extent& level, V far) {
  const D d;
  const auto set = [&](float x) { return hn::Set(d, x); };
  const Placing& place = in.alone->on_grid;
  const V nearest = hn::Neg(level.high), longest = hn::Neg(level.low);
  const hn::Mask<D> bounded =
      hn::And(hn::Gt(nearest, scaled(longest, 0.25F)), hn::Gt(nearest, set(256 * kRound * in.grid.reach)));
  const V inverse = hn::Div(set(1), nearest), most = scaled(inverse, place.height);
  const V least = hn::Div(set(place.height), longest);
  const auto places = [&](const Extent& from, float foot) {
    return Extent{hn::Add(set(foot), hn::Min(hn::Mul(from.low, least), hn::Mul(from.low, most))),
                  hn::Add(set(foot), hn::Max(hn::Mul(from.high, least), hn::Mul(from.high, most)))};
  };
  const Extent x = places(across, place.foot.x), y = places(along, place.foot.y);
  const auto aside = [&](const Extent& from) { return hn::Max(hn::Abs(from.low), hn::Abs(from.high)); };
  const V foot = hn::Mul(hn::Add(aside(across), aside(along)), most);
  const V reach = hn::Add(far, set(in.grid.cut_reach > 0 ? cut_far(in.grid) : 0));
  const V error = hn::MulAdd(hn::Mul(reach, inverse), hn::MulAdd(set(place.per_reach), foot, set(place.per_ray)),
                             hn::MulAdd(set(place.per_foot), foot, set(place.fixed)));
  const V around = scaled(error, 4);
  const hn::Mask<D> right = hn::Gt(hn::Sub(x.low, around), set(-0.5F));
  const hn::Mask<D> between = hn::Gt(hn::Ceil(hn::Sub(y.low, around)), hn::Floor(hn::Add(y.high, around)));
  return hn::And(bounded, hn::And(right, between));
}
hn::Mask<D> box_between_rows(const WalkInput& in, const Point& middle, const Point& half) {
  const Point to = minus(middle, in.cluster.middle);
  const V far = dot({hn::Add(hn::Abs(to.x), half.x), hn::Add(hn::Abs(to.y), half.y), hn::Add(hn::Abs(to.z), half.z)},
                    glm::vec3(1));
  return between_rows(in, extent(to, half, in.grid.across, glm::abs(in.grid.across)),
                      extent(to, half, in.grid.along, glm::abs(in.grid.along)),
                      extent(to, half, in.grid.axis, in.grid.axis_size), far);
}

/// Returns the children (bits) whose boxes meet the shaft, and, with cones, may contain a silhouette edge.
template <bool kCones>
std::uint32_t children_met(const WalkInput& in, const Shaft& shaft, const WideNode& node) {
  const D d;
  std::uint32_t hits = 0;
  for (std::size_t lane = 0; lane < kWide; lane += hn::Lanes(d)) {
    const Point middle = load(node.middle, lane), half = load(node.half, lane);
    hn::Mask<D> met = box_meets(in, shaft, middle, half);
    if (kCones && !hn::AllFalse(d, met)) met = hn::AndNot(same_side(in, node, lane, middle, half), met);
    if (kCones && in.alone != nullptr && !hn::AllFalse(d, met))
      met = hn::AndNot(box_between_rows(in, middle, half), met);
    hits |= bits_of(met) << lane;
  }
  return hits & node.used;
}

/// Calls `leaf` for each leaf whose box meets the shaft in the subtrees on the stack, until a call returns false.
template <bool kCones, typename Tree, typename Leaf>
void go_on(const WalkInput& in, const Shaft& shaft, const Tree& tree, std::vector<std::uint32_t>& stack, Leaf leaf) {
  while (!stack.empty()) {
    const std::uint32_t next = stack.back();
    stack.pop_back();
    if ((next & kLeafBit) != 0) {
      if (!leaf(next & ~kLeafBit)) return;
      continue;
    }
    const WideNode& node = tree.nodes[next];
    for (std::uint32_t hits = children_met<kCones>(in, shaft, node); hits != 0; hits &= hits - 1) {
      stack.push_back(node.reference[static_cast<std::size_t>(std::countr_zero(hits))]);
    }
  }
}

/// Prefetches a node or leaf; large hierarchies do not fit any cache.
template <typename Tree>
HWY_INLINE void fetch(const Tree& tree, std::uint32_t reference) {
  if ((reference & kLeafBit) != 0) return tree.leaves.fetch(reference & ~kLeafBit);
  const auto* const lines = reinterpret_cast<const std::byte*>(&tree.nodes[reference]);
  for (std::size_t line = 0; line < sizeof(WideNode); line += 64) hwy::Prefetch(lines + line);
}

/// Calls `leaf` for each leaf whose box meets the shaft, in the order of go_on, but descends level by level, which
/// gives prefetches time.
template <bool kCones, typename Tree, typename Leaf>
void walk(const WalkInput& in, const Shaft& shaft, const Tree& tree, const std::vector<std::uint32_t>& roots,
          std::vector<std::uint32_t>& levels, Leaf leaf) {
  levels.assign(roots.rbegin(), roots.rend());
  const auto is_leaf = [](std::uint32_t reference) { return (reference & kLeafBit) != 0; };
  std::size_t begin = 0;  // where the last level begins
  for (bool ends = false; !ends;) {
    const std::size_t end = levels.size();
    ends = true;
    for (; begin < end; ++begin) {
      const std::uint32_t next = levels[begin];
      if (is_leaf(next)) {
        levels.push_back(next);
        continue;
      }
      ends = false;
      const WideNode& node = tree.nodes[next];
      for (std::uint32_t hits = children_met<kCones>(in, shaft, node); hits != 0;) {
        const auto last = static_cast<std::uint32_t>(std::bit_width(hits)) - 1;
        hits ^= 1U << last;
        levels.push_back(node.reference[last]);
        fetch(tree, levels.back());
      }
    }
  }
  for (; begin < levels.size(); ++begin) leaf(levels[begin] & ~kLeafBit);
}

/// Replaces roots by their children as long as there are not too many.
template <bool kCones, typename Tree>
void narrow(const WalkInput& in, const Shaft& shaft, const Tree& tree, std::vector<std::uint32_t>& roots) {
  constexpr std::size_t kMost = 24;
  const std::vector<std::uint32_t> before = std::exchange(roots, {});
  for (std::size_t i = 0; i < before.size(); ++i) {
    const bool is_leaf = (before[i] & kLeafBit) != 0;
    const std::uint32_t hits = is_leaf ? 0 : children_met<kCones>(in, shaft, tree.nodes[before[i]]);
    const auto count = static_cast<std::size_t>(std::popcount(hits));
    if (is_leaf || (count > 1 && roots.size() + count + (before.size() - i - 1) > kMost)) {
      roots.push_back(before[i]);
      continue;
    }
    for (std::uint32_t left = hits; left != 0; left &= left - 1)
      roots.push_back(tree.nodes[before[i]].reference[static_cast<std::size_t>(std::countr_zero(left))]);
  }
}

/// Descends level by level until there are enough roots.
template <bool kCones, typename Tree>
void descend(const WalkInput& in, const Shaft& shaft, const Tree& tree, std::vector<std::uint32_t>& roots) {
  constexpr std::size_t kEnough = 24;
  roots = tree.roots;
  for (std::size_t i = 0; i < roots.size() && roots.size() < kEnough;) {
    if ((roots[i] & kLeafBit) != 0) {
      ++i;
      continue;
    }
    const WideNode& node = tree.nodes[roots[i]];
    roots.erase(roots.begin() + static_cast<std::ptrdiff_t>(i));
    for (std::uint32_t hits = children_met<kCones>(in, shaft, node); hits != 0; hits &= hits - 1) {
      roots.push_back(node.reference[static_cast<std::size_t>(std::countr_zero(hits))]);
    }
  }
}

}  // namespace
}  // namespace penumbra::vectors::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // once for each target
