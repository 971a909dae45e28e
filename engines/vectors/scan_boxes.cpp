// SPDX-License-Identifier: Apache-2.0
// Pixels that a triangle may cover, as derived in scan_conversion.cpp, in float, a vector of triangles at a time; most
// triangles of a large mesh lie between the pixels' centres. Cases that float cannot decide are left to
// scan_conversion.cpp (kOpen).
//
// Legend: p corner, in units that make the scene no longer than 1; d = p − eye; R = max |d| of the three corners; u, v,
// z = d along right, down and forward; q = u / z (or v / z); all sizes of vectors are sums of components' sizes.
//   d       p − (float32 of the eye) − rest: two roundings of at most its own size, and the part of the eye that two
//           floats omit, below 2⁻⁴⁷: together 2⁻²³ |d| + 2⁻⁴⁷
//   u, v, z error of d, rounding of the axes, a product and two sums: 6 · 2⁻²⁴ R + 2⁻⁴⁷, less than η = 2⁻²¹ R + 2⁻⁴⁵
//   q       computed with z > 256 η, it is off by at most η (1 + |u / z|) / z ≤ 1.005 η (1 + |q|) / z, which η's slack
//           of a third covers
//   pixels  scale · q, then the middle, the margin and a half: nine roundings of 2⁻²⁴, none of more than
//           X + |middle| + 2, where X = max |scale q|. With error(q):
//           ε = η (scale + X) / z + 2⁻²⁰ (X + |middle| + 1). The rays' own places and the camera's axes are
//           doubles, off by far less than this second part.
//   D       (e₁ × e₂) · d, e₁ and e₂ edges: each a rounding, then products, difference, product, two sums:
//           7 · 2⁻²⁴ T R, T = |e₁| |e₂|, and T times the error of d: 2⁻²³ R + 2⁻⁴⁷. Less than 2 η T;
//           underflow adds below 2⁻¹⁴⁰.

#include "engines/vectors/scan_boxes.hpp"

#include "base/assert.hpp"
#include "base/size1.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engines/vectors/scan_boxes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "engines/vectors/pack-inl.hpp"
#include "engines/vectors/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::vectors::HWY_NAMESPACE {
namespace {

struct Vectors {
  V x, y, z;
};

Vectors minus(const Vectors& a, const Vectors& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
Vectors minus(const Vectors& a, const glm::vec3& b) {
  return {hn::Sub(a.x, set(b.x)), hn::Sub(a.y, set(b.y)), hn::Sub(a.z, set(b.z))};
}
V along(const Vectors& a, const glm::vec3& b) {
  return hn::MulAdd(a.z, set(b.z), hn::MulAdd(a.y, set(b.y), hn::Mul(a.x, set(b.x))));
}
V sizes(const Vectors& a) {
  return hn::Add(hn::Add(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z));
}
V determinant(const Vectors& a, const Vectors& b, const Vectors& c) {
  const auto minor = [](V p, V q, V r, V s) { return hn::MulSub(p, q, hn::Mul(r, s)); };
  const V x = minor(a.y, b.z, a.z, b.y), y = minor(a.z, b.x, a.x, b.z), z = minor(a.x, b.y, a.y, b.x);
  return hn::MulAdd(z, c.z, hn::MulAdd(y, c.y, hn::Mul(x, c.x)));
}
V least(V a, V b, V c) {
  return hn::Min(hn::Min(a, b), c);
}
V most(V a, V b, V c) {
  return hn::Max(hn::Max(a, b), c);
}

/// One corner of each triangle.
struct Corner {
  Vectors p, d;
  V z, x, y;  // x, y in pixels relative to the camera's middle
};

class Finder {
 public:
  Finder(const visibility::SceneFloats& scene, const BoxCamera& camera, PixelBoxes& boxes)
      : scene_(scene), camera_(camera), boxes_(boxes) {}

  /// Finds boxes of the triangles in `asked` among the vector's triangles, numbered from `first`.
  void find(std::size_t first, const std::uint32_t* corners, M asked) const {
    hn::Vec<Words> at_a, at_b, at_c;
    hn::LoadInterleaved3(Words(), corners, at_a, at_b, at_c);
    const Corner a = corner(at_a), b = corner(at_b), c = corner(at_c);
    const V reach = most(sizes(a.d), sizes(b.d), sizes(c.d));
    const V off = hn::MulAdd(reach, set(0x1p-21F), set(0x1p-45F));  // η
    const M seen = hn::And(asked, hn::Ge(most(a.z, b.z, c.z), hn::Neg(off)));
    const V nearest = least(a.z, b.z, c.z);
    const M before = hn::Gt(nearest, hn::Mul(set(256), off));

    const V left = least(a.x, b.x, c.x), right = most(a.x, b.x, c.x), top = least(a.y, b.y, c.y),
            bottom = most(a.y, b.y, c.y);
    const V extent = hn::Max(hn::Sub(right, left), hn::Sub(bottom, top));
    const V aside = hn::Max(hn::Max(hn::Abs(left), hn::Abs(right)), hn::Max(hn::Abs(top), hn::Abs(bottom)));
    const V middle = set(std::max(std::abs(camera_.middle.x), std::abs(camera_.middle.y)) + 1);
    const V error = hn::MulAdd(hn::Div(off, nearest), hn::Add(aside, set(camera_.scale)),
                               hn::Mul(hn::Add(aside, middle), set(0x1p-20F)));  // ε

    const Vectors to_b = minus(b.p, a.p), to_c = minus(c.p, a.p);
    const V det_error = hn::Mul(hn::Mul(sizes(to_b), sizes(to_c)), hn::Add(off, off));
    const V det = hn::Sub(hn::Abs(determinant(to_b, to_c, a.d)), det_error);
    // |d| R³ is enlarged by a part in 2⁶, as R is at least 2⁻³⁸ where z > 256 η.
    const V noise = hn::Mul(hn::Mul(set(1.015625F * camera_.longest_ray), reach), hn::Mul(reach, reach));
    const M certain = hn::Gt(det, hn::MulAdd(noise, set(static_cast<float>(kScanNoise)), set(0x1p-100F)));
    // 3 E R extent / |D|, clamped to a pixel
    const V beside =
        hn::Mul(hn::Div(hn::Mul(noise, set(0x3p-50F)), hn::Max(det, set(0x1p-100F))), hn::Add(extent, set(1)));
    const V margin = hn::Add(error, hn::IfThenElse(certain, hn::Min(beside, set(1)), set(1)));

    const auto first_of = [&](V from, float at) {
      return hn::Ceil(hn::Max(hn::Sub(hn::Add(from, set(at - 0.5F)), margin), hn::Zero(D())));
    };
    const auto last_of = [&](V to, float at, float last) {
      return hn::Floor(hn::Min(hn::Add(hn::Add(to, set(at - 0.5F)), margin), set(last)));
    };
    const V from_x = first_of(left, camera_.middle.x), to_x = last_of(right, camera_.middle.x, camera_.last.x),
            from_y = first_of(top, camera_.middle.y), to_y = last_of(bottom, camera_.middle.y, camera_.last.y);
    const M holds = hn::And(hn::Le(from_x, to_x), hn::Le(from_y, to_y));
    const M known = hn::And(before, hn::Le(error, set(0.25F)));
    const M taken = hn::And(seen, hn::Or(hn::Not(before), holds));
    if (hn::AllFalse(D(), taken)) return;
    const V nothing_before = hn::Mul(hn::Sub(nearest, off), set((1 - 0x1p-7F) / camera_.unit));
    store(first, taken, known, {from_x, to_x, from_y, to_y, hn::IfThenElseZero(certain, nothing_before)});
  }

 private:
  using Words = hn::RebindToUnsigned<D>;
  struct Box {
    V left, right, top, bottom, nearest;
  };

  [[nodiscard]] Corner corner(hn::Vec<Words> which) const {
    const auto at = hn::BitCast(I(), hn::Add(hn::Add(which, which), which));
    const float* const first = &scene_.positions.front().x;
    const V unit = set(camera_.unit);
    Corner corner;
    corner.p = {hn::Mul(hn::GatherIndex(D(), first, at), unit), hn::Mul(hn::GatherIndex(D(), first + 1, at), unit),
                hn::Mul(hn::GatherIndex(D(), first + 2, at), unit)};
    corner.d = minus(minus(corner.p, camera_.eye), camera_.eye_rest);
    corner.z = along(corner.d, camera_.forward);
    const V scale = hn::Div(set(camera_.scale), corner.z);
    corner.x = hn::Mul(along(corner.d, camera_.right), scale);
    corner.y = hn::Mul(along(corner.d, camera_.down), scale);
    return corner;
  }

  void store(std::size_t first, M taken, M known, const Box& box) const {
    const I whole;
    const Words words;
    const std::size_t at = boxes_.count;
    const auto pack_whole = [&](V values, std::int32_t* to) {
      pack(hn::ConvertTo(whole, values), hn::RebindMask(whole, taken), whole, to);
    };
    pack(hn::Add(hn::Iota(words, 0), hn::Set(words, static_cast<std::uint32_t>(first))), hn::RebindMask(words, taken),
         words, &boxes_.triangle[at]);
    pack_whole(hn::IfThenElse(known, box.left, set(PixelBoxes::kOpen)), &boxes_.left[at]);
    pack_whole(box.right, &boxes_.right[at]);
    pack_whole(box.top, &boxes_.top[at]);
    pack_whole(box.bottom, &boxes_.bottom[at]);
    boxes_.count += pack(box.nearest, taken, D(), &boxes_.nearest[at]);
  }

  const visibility::SceneFloats& scene_;
  const BoxCamera& camera_;
  PixelBoxes& boxes_;
};

void find_boxes_here(const visibility::SceneFloats& scene, const BoxCamera& camera, std::size_t first, std::size_t end,
                     PixelBoxes& boxes) {
  const Finder finder(scene, camera, boxes);
  const std::size_t lanes = hn::Lanes(D());
  for (; first + lanes <= end; first += lanes) finder.find(first, scene.triangles[first].data(), first_lanes(lanes));
  if (first == end) return;
  std::array<visibility::Triangle, 16> rest{};
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = scene.triangles[std::min(first + i, end - 1)];
  finder.find(first, rest.front().data(), first_lanes(end - first));
}

}  // namespace
}  // namespace penumbra::vectors::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::vectors {

HWY_EXPORT(find_boxes_here);

Screen::Screen(const visibility::PinholeCamera& camera)
    : size(camera.width, camera.height),
      scale(camera.picture_height() / 2.0 / camera.tan_half_fov),
      middle(0.5 * size.x - glm::dot(camera.middle, camera.right) * scale,
             0.5 * camera.picture_height() - camera.first_row + glm::dot(camera.middle, camera.up) * scale),
      longest_ray(size1(camera.middle) +
                  (size.x / camera.picture_height() * size1(camera.right) + size1(camera.up)) * camera.tan_half_fov) {}

BoxCamera::BoxCamera(const visibility::SceneFloats& scene, const visibility::PinholeCamera& camera,
                     const Screen& screen) {
  const double reach = std::max({size1(glm::dvec3(scene.lower)), size1(glm::dvec3(scene.upper)), size1(camera.eye)});
  const auto fits = [](double x) { return x < 0x1p60; };
  // Gathering takes signed 32-bit indices of floats.
  const bool are_few = scene.positions.size() <= std::numeric_limits<std::int32_t>::max() / 3;
  is_usable = are_few && fits(reach) && reach > 0x1p-60 && fits(screen.scale) && fits(screen.longest_ray) &&
              fits(std::abs(screen.middle.x)) && fits(std::abs(screen.middle.y));
  if (!is_usable) return;
  unit = static_cast<float>(std::ldexp(1.0, -std::ilogb(reach) - 2));
  const glm::dvec3 at = camera.eye * static_cast<double>(unit);
  eye = at;
  eye_rest = at - glm::dvec3(eye);
  right = camera.right;
  down = -camera.up;
  forward = camera.forward;
  middle = screen.middle;
  last = screen.size - 1.0;
  scale = static_cast<float>(screen.scale);
  longest_ray = static_cast<float>(screen.longest_ray);
}

void find_boxes(const visibility::SceneFloats& scene, const BoxCamera& camera, std::size_t first, std::size_t end,
                PixelBoxes& boxes) {
  PENUMBRA_ASSERT(end - first <= PixelBoxes::kMost, "triangles {} to {}", first, end);
  boxes.count = 0;
  if (camera.is_usable) {
    HWY_DYNAMIC_DISPATCH(find_boxes_here)(scene, camera, first, end, boxes);
    return;
  }
  for (; first < end; ++first) {
    boxes.triangle[boxes.count] = static_cast<std::uint32_t>(first);
    boxes.left[boxes.count++] = PixelBoxes::kOpen;
  }
}

}  // namespace penumbra::vectors
#endif
