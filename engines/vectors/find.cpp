// SPDX-License-Identifier: Apache-2.0
// First stage of methods on vector units: finds the edges or triangles in the leaves that a traversal visits, eight at
// a time.

#include "engines/vectors/find.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engines/vectors/find.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "engines/vectors/pack-inl.hpp"
#include "engines/vectors/walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::vectors::HWY_NAMESPACE {
namespace {

/// Returns first, first + 1, … as the bits of floats (numbers_from of vectors-inl.hpp).
V numbers_from(std::size_t first) {
  const hn::RebindToSigned<D> d;
  return hn::BitCast(D(), hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<std::int32_t>(first))));
}

hn::Mask<D> used_lanes(std::uint32_t used, std::size_t lane) {
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(used >> lane)};
  return hn::LoadMaskBits(D(), bytes);
}

/// Tests whether an object may meet the shaft: all of the object's corners have n·x ≥ least(n) for each of the shaft's
/// four planes, and lie between `low` and `high` along the axis.
struct ShaftTest {
  const Shaft& shaft;

  template <typename Least>
  hn::Mask<D> operator()(V low, V high, Least least) const {
    const D d;
    hn::Mask<D> met = hn::And(hn::Le(low, hn::Set(d, shaft.highest)), hn::Ge(high, hn::Set(d, shaft.lowest)));
    for (std::size_t i = 0; i < 4; ++i) {
      met = hn::And(met, hn::Le(least(shaft.n[i]), hn::Set(d, shaft.beyond[i])));
    }
    return met;
  }
};

/// One of an edge's triangles, relative to the cluster: p is in front of it if n · p − at > error, behind it if <
/// −error.
struct EdgeSideWide {
  Point n;
  V at, error;
  hn::Mask<D> none, positive, negative;  // positive: all of the cluster's p are in front
  hn::Mask<D> nothing;                   // no triangle, or one in the cluster's own plane
};

hn::Mask<D> equals(const WideWords& numbers, std::size_t lane, std::uint32_t number) {
  const hn::RebindToUnsigned<D> words;
  const auto equal = hn::Eq(hn::LoadU(words, &numbers[lane]), hn::Set(words, number));
  return hn::MaskFromVec(hn::BitCast(D(), hn::VecFromMask(words, equal)));
}

HWY_INLINE EdgeSideWide side_of(const EdgeInput& in, const WideEdges& leaf, std::size_t side, std::size_t lane) {
  const D d;
  const glm::vec3& box = in.cluster.half_size;
  EdgeSideWide s;
  s.n = load(leaf.n[side], lane);
  const Point anchor = minus(load(leaf.anchor[side], lane), in.cluster.middle);
  const Point size = absolute(s.n);
  s.at = dot(s.n, anchor);
  const V lengths = dot(size, absolute(anchor)), over_box = dot(size, box);
  const V ones = dot(size, glm::vec3(1));
  s.none = hn::Eq(ones, hn::Zero(d));
  const hn::Mask<D> own = equals(leaf.plane[side], lane, in.cluster.plane);
  s.error = hn::IfThenElse(s.none, hn::Set(d, -1.0F), scaled(hn::Add(lengths, over_box), 10 * kRound));
  const V spread = hn::Add(scaled(over_box, 1.001F), hn::Add(scaled(hn::Add(lengths, over_box), 32 * kRound),
                                                             scaled(ones, 4 * kRound * in.grid.reach)));
  const V f = hn::Neg(s.at);
  s.nothing = hn::Or(s.none, own);
  s.positive = hn::AndNot(s.none, hn::Gt(f, spread));
  s.negative = hn::AndNot(s.none, hn::Lt(f, hn::Neg(spread)));
  return s;
}

/// Returns whether, for the whole cluster, the edge's triangles add nothing to its signed multiplicity k_e: their terms
/// cancel or are both zero. (bound side of docs/edge-scatter.md)
hn::Mask<D> is_none(const EdgeSideWide& s, const EdgeSideWide& t) {
  return hn::Or(hn::Or(hn::And(s.positive, t.negative), hn::And(s.negative, t.positive)),
                hn::And(s.nothing, t.nothing));
}

hn::Mask<D> edge_between_rows(const EdgeInput& in, const Point& a, const Point& b) {
  const Point from_a = minus(a, in.cluster.middle), from_b = minus(b, in.cluster.middle);
  const auto along = [&](const glm::vec3& n) {
    const V at_a = dot(from_a, n), at_b = dot(from_b, n);
    return Extent{hn::Min(at_a, at_b), hn::Max(at_a, at_b)};
  };
  return between_rows({in.grid, in.cluster, in.alone}, along(in.grid.across), along(in.grid.along), along(in.grid.axis),
                      hn::Max(length(from_a), length(from_b)));
}

void add_edges(const EdgeInput& in, std::uint32_t number, EdgeTable& out) {
  const D d;
  const WideEdges& leaf = in.tree.leaves[number];
  out.reserve(out.count + kWide);
  for (std::size_t lane = 0; lane < kWide; lane += hn::Lanes(d)) {
    const Point a = load(leaf.a, lane), b = load(leaf.b, lane);
    const V level_a = dot(a, in.grid.axis), level_b = dot(b, in.grid.axis);
    hn::Mask<D> met =
        hn::And(used_lanes(leaf.used, lane),
                ShaftTest{in.cluster.whole}(hn::Min(level_a, level_b), hn::Max(level_a, level_b),
                                            [&](const glm::vec3& n) { return hn::Min(dot(a, n), dot(b, n)); }));
    if (in.alone != nullptr && !hn::AllFalse(d, met)) met = hn::AndNot(edge_between_rows(in, a, b), met);
    if (hn::AllFalse(d, met)) continue;
    const EdgeSideWide s = side_of(in, leaf, 0, lane), t = side_of(in, leaf, 1, lane);
    const hn::Mask<D> kept = hn::AndNot(is_none(s, t), met);
    const std::size_t more = hn::CountTrue(d, kept);
    if (more == 0) continue;
    const auto row = out.row(out.count);
    const auto store = [&](std::size_t field, V v) { pack(v, kept, d, row[field]); };
    const Point from_a = minus(a, in.cluster.middle), from_b = minus(b, in.cluster.middle);
    store(kAx, dot(from_a, in.grid.across));
    store(kAy, dot(from_a, in.grid.along));
    store(kAh, dot(from_a, in.grid.axis));
    store(kBx, dot(from_b, in.grid.across));
    store(kBy, dot(from_b, in.grid.along));
    store(kBh, dot(from_b, in.grid.axis));
    for (std::size_t side = 0; side < 2; ++side) {
      const EdgeSideWide& its = side == 0 ? s : t;
      const std::size_t first = side == 0 ? kNormal1X : kNormal2X;
      store(first, its.n.x);
      store(first + 1, its.n.y);
      store(first + 2, its.n.z);
      store(first + kOffset1 - kNormal1X, its.at);
      store(first + kOffsetError1 - kNormal1X, its.error);
      const hn::RebindToUnsigned<D> words;
      store(first + kPlane1 - kNormal1X, hn::BitCast(d, hn::LoadU(words, &leaf.plane[side][lane])));
    }
    store(kFar, hn::Max(length(from_a), length(from_b)));
    store(kEdgeSlot, numbers_from(number * kWide + lane));
    out.count += more;
  }
}

/// Returns whether all of the cluster's p are outside of a triangle's closed part and behind the triangle (wound
/// inward): another triangle of the part then hides everything that it hides. (docs/view-sample.md, Closed casters)
hn::Mask<D> seen_from_outside(const TriangleInput& in, const WideTriangles& leaf, std::size_t lane) {
  const D d;
  const hn::RebindToUnsigned<D> words;
  const Point a = load(leaf.corner[0], lane), b = load(leaf.corner[1], lane), c = load(leaf.corner[2], lane);
  const Point e1{hn::Sub(b.x, a.x), hn::Sub(b.y, a.y), hn::Sub(b.z, a.z)};
  const Point e2{hn::Sub(c.x, a.x), hn::Sub(c.y, a.y), hn::Sub(c.z, a.z)};
  const auto minor = [](V p, V q, V r, V s) { return hn::Sub(hn::Mul(p, q), hn::Mul(r, s)); };
  const Point n{minor(e1.y, e2.z, e1.z, e2.y), minor(e1.z, e2.x, e1.x, e2.z), minor(e1.x, e2.y, e1.y, e2.x)};
  const V sizes = hn::Mul(dot(absolute(e1), glm::vec3(1)), dot(absolute(e2), glm::vec3(1)));
  const V least = hn::Sub(dot(n, minus(a, in.cluster.middle)), dot(absolute(n), in.cluster.half_size));
  const auto bits = hn::And(hn::LoadU(words, &leaf.closed[lane]), hn::Set(words, in.outside_of));
  const auto other = hn::MaskFromVec(hn::BitCast(d, hn::VecFromMask(words, hn::Eq(bits, hn::Zero(words)))));
  return hn::AndNot(other, hn::Gt(least, scaled(sizes, 64 * kRound * in.grid.reach)));
}

void add_triangles(const TriangleInput& in, std::uint32_t number, TriangleTable& out) {
  const D d;
  const WideTriangles& leaf = in.tree.leaves[number];
  out.reserve(out.count + kWide);
  const hn::RebindToUnsigned<D> words;
  for (std::size_t lane = 0; lane < kWide; lane += hn::Lanes(d)) {
    const Point a = load(leaf.corner[0], lane), b = load(leaf.corner[1], lane), c = load(leaf.corner[2], lane);
    const V la = dot(a, in.grid.axis), lb = dot(b, in.grid.axis), lc = dot(c, in.grid.axis);
    const hn::Mask<D> met =
        ShaftTest{in.shaft}(hn::Min(la, hn::Min(lb, lc)), hn::Max(la, hn::Max(lb, lc)),
                            [&](const glm::vec3& n) { return hn::Min(dot(a, n), hn::Min(dot(b, n), dot(c, n))); });
    const hn::Mask<D> never =
        hn::Or(equals(leaf.emits, lane, in.grid.light), equals(leaf.plane, lane, in.cluster.plane));
    hn::Mask<D> kept = hn::And(used_lanes(leaf.used, lane), hn::AndNot(never, met));
    if (in.outside_of != 0 && !hn::AllFalse(d, kept)) kept = hn::AndNot(seen_from_outside(in, leaf, lane), kept);
    const std::size_t more = hn::CountTrue(d, kept);
    if (more == 0) continue;
    const auto row = out.row(out.count);
    const auto store = [&](std::size_t field, V v) { pack(v, kept, d, row[field]); };
    V far = hn::Zero(d);
    std::size_t field = kCornerA;
    for (const Point& corner : {a, b, c}) {
      const Point from = minus(corner, in.cluster.middle);
      store(field, dot(from, in.grid.across));
      store(field + 1, dot(from, in.grid.along));
      store(field + 2, dot(from, in.grid.axis));
      far = hn::Max(far, length(from));
      field += 3;
    }
    store(kTrianglePlane, hn::BitCast(d, hn::LoadU(words, &leaf.plane[lane])));
    store(kTriangleFar, far);
    store(kTriangleSlot, numbers_from(number * kWide + lane));
    out.count += more;
  }
}

/// Removes leaves from `roots` for which `add` puts nothing into the table.
template <typename Out, typename Add>
void drop_idle_leaves(std::vector<std::uint32_t>& roots, Out& table, Add add) {
  std::erase_if(roots, [&](std::uint32_t root) {
    if ((root & kLeafBit) == 0) return false;
    table.count = 0;
    add(root & ~kLeafBit, table);
    return table.count == 0;
  });
}

void find_edge_roots_here(const EdgeInput& in, EdgeTable& table, std::vector<std::uint32_t>& roots) {
  const WalkInput walk_input{in.grid, in.cluster};
  descend<true>(walk_input, in.cluster.whole, in.tree, roots);
  drop_idle_leaves(roots, table, [&](std::uint32_t leaf, EdgeTable& out) { add_edges(in, leaf, out); });
}

bool find_more_edges_here(const EdgeInput& in, std::vector<std::uint32_t>& stack, EdgeTable& edges, std::size_t most) {
  go_on<true>({in.grid, in.cluster, in.alone}, in.cluster.whole, in.tree, stack, [&](std::uint32_t leaf) {
    add_edges(in, leaf, edges);
    return edges.count <= most;
  });
  return edges.count <= most;
}

void find_edges_here(const EdgeInput& in, const std::vector<std::uint32_t>& roots, std::vector<std::uint32_t>& stack,
                     EdgeTable& edges) {
  edges.count = 0;
  walk<true>({in.grid, in.cluster, in.alone}, in.cluster.whole, in.tree, roots, stack,
             [&](std::uint32_t leaf) { add_edges(in, leaf, edges); });
}

std::size_t count_edge_leaves_here(const EdgeInput& in, const std::vector<std::uint32_t>& roots,
                                   std::vector<std::uint32_t>& stack) {
  std::size_t leaves = 0;
  stack = roots;
  go_on<true>({in.grid, in.cluster, in.alone}, in.cluster.whole, in.tree, stack, [&](std::uint32_t) {
    ++leaves;
    return true;
  });
  return leaves;
}

void narrow_edge_roots_here(const EdgeInput& in, std::vector<std::uint32_t>& roots) {
  narrow<true>({in.grid, in.cluster}, in.cluster.whole, in.tree, roots);
}

void narrow_triangle_roots_here(const TriangleInput& in, std::vector<std::uint32_t>& roots) {
  narrow<false>({in.grid, in.cluster}, in.shaft, in.tree, roots);
}

void find_triangle_roots_here(const TriangleInput& in, TriangleTable& table, std::vector<std::uint32_t>& roots) {
  descend<false>({in.grid, in.cluster}, in.shaft, in.tree, roots);
  drop_idle_leaves(roots, table, [&](std::uint32_t leaf, TriangleTable& out) { add_triangles(in, leaf, out); });
}

std::size_t count_leaves_here(const TriangleInput& in, const std::vector<std::uint32_t>& roots,
                              std::vector<std::uint32_t>& stack, std::size_t most) {
  std::size_t leaves = 0;
  stack = roots;
  go_on<false>({in.grid, in.cluster}, in.shaft, in.tree, stack, [&](std::uint32_t) { return ++leaves < most; });
  return leaves;
}

void find_triangles_here(const TriangleInput& in, const std::vector<std::uint32_t>& roots,
                         std::vector<std::uint32_t>& stack, TriangleTable& triangles) {
  triangles.count = 0;
  walk<false>({in.grid, in.cluster}, in.shaft, in.tree, roots, stack,
              [&](std::uint32_t leaf) { add_triangles(in, leaf, triangles); });
}

}  // namespace
}  // namespace penumbra::vectors::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::vectors {

HWY_EXPORT(find_edge_roots_here);
HWY_EXPORT(find_edges_here);
HWY_EXPORT(find_more_edges_here);
HWY_EXPORT(count_edge_leaves_here);
HWY_EXPORT(narrow_edge_roots_here);
HWY_EXPORT(narrow_triangle_roots_here);
HWY_EXPORT(find_triangle_roots_here);
HWY_EXPORT(count_leaves_here);
HWY_EXPORT(find_triangles_here);

void find_edge_roots(const EdgeInput& input, EdgeTable& edges, std::vector<std::uint32_t>& roots) {
  HWY_DYNAMIC_DISPATCH(find_edge_roots_here)(input, edges, roots);
}

void find_edges(const EdgeInput& input, const std::vector<std::uint32_t>& roots, std::vector<std::uint32_t>& stack,
                EdgeTable& edges) {
  HWY_DYNAMIC_DISPATCH(find_edges_here)(input, roots, stack, edges);
}

bool find_more_edges(const EdgeInput& input, std::vector<std::uint32_t>& stack, EdgeTable& edges, std::size_t most) {
  return HWY_DYNAMIC_DISPATCH(find_more_edges_here)(input, stack, edges, most);
}

std::size_t count_edge_leaves(const EdgeInput& input, const std::vector<std::uint32_t>& roots,
                              std::vector<std::uint32_t>& stack) {
  return HWY_DYNAMIC_DISPATCH(count_edge_leaves_here)(input, roots, stack);
}

void narrow_edge_roots(const EdgeInput& input, std::vector<std::uint32_t>& roots) {
  HWY_DYNAMIC_DISPATCH(narrow_edge_roots_here)(input, roots);
}

void narrow_triangle_roots(const TriangleInput& input, std::vector<std::uint32_t>& roots) {
  HWY_DYNAMIC_DISPATCH(narrow_triangle_roots_here)(input, roots);
}

void find_triangle_roots(const TriangleInput& input, TriangleTable& triangles, std::vector<std::uint32_t>& roots) {
  HWY_DYNAMIC_DISPATCH(find_triangle_roots_here)(input, triangles, roots);
}

std::size_t count_leaves(const TriangleInput& input, const std::vector<std::uint32_t>& roots,
                         std::vector<std::uint32_t>& stack, std::size_t most) {
  return HWY_DYNAMIC_DISPATCH(count_leaves_here)(input, roots, stack, most);
}

void find_triangles(const TriangleInput& input, const std::vector<std::uint32_t>& roots,
                    std::vector<std::uint32_t>& stack, TriangleTable& triangles) {
  HWY_DYNAMIC_DISPATCH(find_triangles_here)(input, roots, stack, triangles);
}

}  // namespace penumbra::vectors
#endif
