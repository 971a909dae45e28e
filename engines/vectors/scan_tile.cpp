// SPDX-License-Identifier: Apache-2.0
// Coverage and depth of the pixels of one tile, a vector of pixels at a time, with the operations of visibility::cover
// in the same order.

#include "engines/vectors/scan_tile.hpp"

#include <glm/geometric.hpp>

#include <bit>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engines/vectors/scan_tile.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace penumbra::vectors::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Pixels = hn::CappedTag<double, 8>;
using Values = hn::Vec<Pixels>;

struct Rays {
  Values x, y, z;
};

Values along(const Rays& rays, const glm::dvec3& n) {
  const Pixels d;
  const auto product = [&](Values v, double factor) { return hn::Mul(v, hn::Set(d, factor)); };
  return hn::Add(hn::Add(product(rays.x, n.x), product(rays.y, n.y)), product(rays.z, n.z));
}

/// One row of rays, evaluated for vectors of columns.
struct RayRow {
  const visibility::PinholeCamera& view;
  glm::dvec3 upward;  // the row's part of the direction along `up`

  Values axis(Values across, int i) const {
    const Pixels d;
    const Values offset = hn::Add(hn::Mul(across, hn::Set(d, view.right[i])), hn::Set(d, upward[i]));
    return hn::Add(hn::Set(d, view.middle[i]), hn::Mul(offset, hn::Set(d, view.tan_half_fov)));
  }
  Rays at(Values across) const { return {axis(across, 0), axis(across, 1), axis(across, 2)}; }
};

/// A triangle's planes as visibility::cover uses them.
struct Planes {
  Planes(const visibility::PinholeCamera& view, const std::array<glm::vec3, 3>& corners) {
    const glm::dvec3 first = corners[0], second = corners[1], third = corners[2];
    const glm::dvec3 a = first - view.eye, b = second - view.eye, c = third - view.eye;
    ab = glm::cross(a, b);
    bc = glm::cross(b, c);
    ac = glm::cross(a, c);
    normal = glm::cross(second - first, third - first);
    eye_height = glm::dot(normal, view.eye - first);
  }
  glm::dvec3 ab, bc, ac, normal;
  double eye_height;
};

class Painter {
 public:
  Painter(const visibility::SceneFloats& scene, const ScanCamera& camera, const ScanTile& tile)
      : scene_(scene), camera_(camera), tile_(tile) {}

  void paint(const TileEntry& entry) const {
    const Planes planes(camera_.view, scene_.corners(entry.triangle));
    for (std::uint32_t y = entry.top; y <= entry.bottom; ++y) {
      const RayRow row{camera_.view, camera_.upward[tile_.first_y + y] * camera_.view.up};
      const Pixels d;
      for (std::uint32_t x = entry.left; x <= entry.right; x += static_cast<std::uint32_t>(hn::Lanes(d))) {
        const std::size_t left = entry.right + std::size_t{1} - x;
        take(entry.triangle, planes, row.at(hn::LoadU(d, &camera_.across[tile_.first_x + x])),
             std::size_t{y} * kScanTile + x, hn::FirstN(d, left));
      }
    }
  }

 private:
  void take(std::uint32_t triangle, const Planes& planes, const Rays& rays, std::size_t slot,
            hn::Mask<Pixels> asked) const {
    const Pixels d;
    const hn::RebindToSigned<Pixels> words;
    const Values zero = hn::Zero(d);
    const Values ab = along(rays, planes.ab), bc = along(rays, planes.bc), ac = along(rays, planes.ac);
    const auto left = hn::And(hn::And(hn::Ge(ab, zero), hn::Ge(bc, zero)), hn::Le(ac, zero));
    const auto right = hn::And(hn::And(hn::Le(ab, zero), hn::Le(bc, zero)), hn::Ge(ac, zero));
    const auto covered = hn::And(asked, hn::Xor(left, right));  // all zero: edge-on or without area
    if (hn::AllFalse(d, covered)) return;
    const Values t = hn::Div(hn::Set(d, planes.eye_height), hn::Neg(along(rays, planes.normal)));
    const auto met =
        hn::And(covered, hn::And(hn::Gt(t, zero), hn::Lt(t, hn::Set(d, std::numeric_limits<double>::infinity()))));
    const Values before = hn::LoadU(d, &tile_.nearest[slot]);
    const auto nearer = hn::And(met, hn::Lt(t, before));
    hn::BlendedStore(t, nearer, d, &tile_.nearest[slot]);
    hn::BlendedStore(hn::Set(words, static_cast<std::int64_t>(triangle)),
                     hn::MaskFromVec(hn::BitCast(words, hn::VecFromMask(d, nearer))), words, &tile_.carrier[slot]);
    const auto equal = hn::And(met, hn::Eq(t, before));
    if (!hn::AllFalse(d, equal)) settle(triangle, slot, equal);
  }

  /// Settles ties: of triangles that meet a ray at the same t the one whose sorted vertices come first wins.
  void settle(std::uint32_t triangle, std::size_t slot, hn::Mask<Pixels> equal) const {
    std::uint8_t lanes[8] = {};
    hn::StoreMaskBits(Pixels(), equal, lanes);
    for (std::uint32_t left = lanes[0]; left != 0; left &= left - 1) {
      std::int64_t& carrier = tile_.carrier[slot + static_cast<std::size_t>(std::countr_zero(left))];
      const auto other = static_cast<std::uint32_t>(carrier);
      if (scene_.comes_before(triangle, other) || (triangle < other && !scene_.comes_before(other, triangle)))
        carrier = triangle;
    }
  }

  const visibility::SceneFloats& scene_;
  const ScanCamera& camera_;
  const ScanTile& tile_;
};

double scan_tile_here(const visibility::SceneFloats& scene, const ScanCamera& camera,
                      std::span<const TileEntry> entries, const ScanTile& tile) {
  const Painter painter(scene, camera, tile);
  for (const TileEntry& entry : entries) painter.paint(entry);
  const Pixels d;
  Values farthest = hn::Set(d, -std::numeric_limits<double>::infinity());
  for (std::size_t slot = 0; slot < kScanSlots; slot += hn::Lanes(d))
    farthest = hn::Max(farthest, hn::LoadU(d, &tile.nearest[slot]));
  return hn::GetLane(hn::MaxOfLanes(d, farthest));
}

}  // namespace
}  // namespace penumbra::vectors::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::vectors {

HWY_EXPORT(scan_tile_here);

ScanCamera::ScanCamera(const visibility::PinholeCamera& camera) : view(camera) {
  constexpr std::size_t kWidest = 8;  // lanes of Pixels
  across.resize(camera.width + kWidest);
  upward.resize(camera.height);
  for (std::uint32_t x = 0; x < camera.width; ++x) across[x] = camera.across(x);
  for (std::uint32_t y = 0; y < camera.height; ++y) upward[y] = camera.upward(y);
}

double scan_tile(const visibility::SceneFloats& scene, const ScanCamera& camera, std::span<const TileEntry> entries,
                 const ScanTile& tile) {
  return HWY_DYNAMIC_DISPATCH(scan_tile_here)(scene, camera, entries, tile);
}

}  // namespace penumbra::vectors
#endif
