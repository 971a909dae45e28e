// SPDX-License-Identifier: Apache-2.0
// Finds exactly coplanar triangles, for a million triangles in a fraction of a second.
//
// A plane is the ratio n.x : n.y : n.z : n·a with n = (b − a) × (c − a). Finite floats are integers times powers of
// two, and the ring of those numbers maps homomorphically onto the integers modulo p = 2⁶¹ − 1 (where 2⁻¹ exists). So
// the four numbers, computed modulo p without any rounding and divided by the first that is not zero, are *equal* for
// exactly coplanar triangles: comparing them finds all candidates. Different planes can only collide; every candidate
// is therefore verified with an exact predicate before it gets its number. The one exception, all four zero modulo p
// although the triangle has an area, is handled separately and compared with every plane.

#include "visibility/plane_ids.hpp"

#include "base/buckets.hpp"
#include "base/pages.hpp"
#include "base/parallel.hpp"
#include "visibility/pair_truth.hpp"

#include <tbb/blocked_range.h>
#include <tbb/concurrent_vector.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

namespace penumbra::visibility {
namespace {

__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

// ---- Arithmetic modulo the Mersenne prime p = 2⁶¹ − 1. Values are kept in [0, p).
constexpr std::uint64_t kPrime = (std::uint64_t{1} << 61) - 1;

/// Returns x modulo p. x: below 2¹²⁴, for example the sum of up to three products.
std::uint64_t reduce(UInt128 x) {  // 2⁶¹ ≡ 1: fold the high bits onto the low ones
  std::uint64_t r = static_cast<std::uint64_t>(x & kPrime) + static_cast<std::uint64_t>(x >> 61);  // < 2⁶⁴
  r = (r & kPrime) + (r >> 61);                                                                    // < p + 6
  return r >= kPrime ? r - kPrime : r;
}
UInt128 wide_product(std::uint64_t a, std::uint64_t b) {
  return static_cast<UInt128>(a) * b;
}
std::uint64_t mul(std::uint64_t a, std::uint64_t b) {
  return reduce(wide_product(a, b));
}
std::uint64_t sub(std::uint64_t a, std::uint64_t b) {
  return a >= b ? a - b : a + kPrime - b;
}

/// x⁻¹ = x^(p − 2), with p − 2 = 4·(2⁵⁹ − 1) + 1. From x^(2^k − 1), k squarings and one product give x^(2^(2k) − 1).
std::uint64_t inverse(std::uint64_t x) {
  const auto extend = [](std::uint64_t power, std::uint64_t times, int squarings) {
    for (int i = 0; i < squarings; ++i) power = mul(power, power);
    return mul(power, times);
  };
  const std::uint64_t k2 = extend(x, x, 1), k3 = extend(k2, x, 1), k6 = extend(k3, k3, 3), k7 = extend(k6, x, 1);
  const std::uint64_t k14 = extend(k7, k7, 7), k28 = extend(k14, k14, 14), k29 = extend(k28, x, 1);
  const std::uint64_t k58 = extend(k29, k29, 29), k59 = extend(k58, x, 1);
  return extend(k59, x, 2);
}

/// A float as mantissa · 2^exponent, mantissa odd or zero.
struct Dyadic {
  std::int64_t mantissa = 0;
  int exponent = 0;
};

Dyadic dyadic(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t fraction = bits & 0x7fffffu, biased = (bits >> 23) & 0xffu;
  std::uint32_t mantissa = biased == 0 ? fraction : fraction | 0x800000u;
  if (mantissa == 0) return {};
  int exponent = (biased == 0 ? 1 : static_cast<int>(biased)) - 150;
  const int zeros = std::countr_zero(mantissa);
  mantissa >>= zeros;
  exponent += zeros;
  return {(bits >> 31) != 0 ? -static_cast<std::int64_t>(mantissa) : static_cast<std::int64_t>(mantissa), exponent};
}

/// Rotation for each exponent: 2^e ≡ 2^(e mod 61), a rotation of a number of 61 bits.
constexpr std::array<std::uint8_t, 256> kTurn = [] {
  std::array<std::uint8_t, 256> turn{};
  for (int biased = 0; biased < 256; ++biased) {
    const int exponent = std::max(biased, 1) - 150;  // exponent of the mantissa's last bit
    turn[static_cast<std::size_t>(biased)] = static_cast<std::uint8_t>((exponent % 61 + 61) % 61);
  }
  return turn;
}();

std::uint64_t residue(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t biased = (bits >> 23) & 0xffu;
  const std::uint64_t mantissa = (bits & 0x7fffffu) | (biased == 0 ? 0u : 0x800000u);
  const unsigned turn = kTurn[biased];
  const std::uint64_t magnitude = ((mantissa << turn) & kPrime) | (mantissa >> (61U - turn));
  return (bits >> 31) != 0 && magnitude != 0 ? kPrime - magnitude : magnitude;
}

/// n and n·a modulo p. All zero: there is no ratio.
using PlaneResidues = std::array<std::uint64_t, 4>;

PlaneResidues plane_of(const std::array<glm::vec3, 3>& corners) {
  std::uint64_t q[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int axis = 0; axis < 3; ++axis) q[i][axis] = residue(corners[static_cast<std::size_t>(i)][axis]);
  }
  std::uint64_t u[3], v[3];
  for (int axis = 0; axis < 3; ++axis) {
    u[axis] = sub(q[1][axis], q[0][axis]);
    v[axis] = sub(q[2][axis], q[0][axis]);
  }
  const auto minor = [&](int i, int j) {  // adding p² ≡ 0 keeps the difference from becoming negative
    return reduce(wide_product(u[i], v[j]) + (wide_product(kPrime, kPrime) - wide_product(u[j], v[i])));
  };
  PlaneResidues plane = {minor(1, 2), minor(2, 0), minor(0, 1), 0};
  plane[3] =
      reduce(wide_product(plane[0], q[0][0]) + wide_product(plane[1], q[0][1]) + wide_product(plane[2], q[0][2]));
  return plane;
}

/// Returns the first number that is not zero, or 1.
std::uint64_t pivot_of(const PlaneResidues& plane) {
  const auto found = std::ranges::find_if(plane, [](std::uint64_t x) { return x != 0; });
  return found == plane.end() ? 1 : *found;
}

constexpr std::uint64_t kFlat = 0, kNoRatio = 1;  // reserved keys

/// Returns a key that is equal for exactly coplanar triangles; kNoRatio if the plane has none modulo p. `scale`:
/// pivot⁻¹.
std::uint64_t key_of(const PlaneResidues& plane, std::uint64_t scale) {
  if ((plane[0] | plane[1] | plane[2] | plane[3]) == 0) return kNoRatio;
  std::uint64_t key = 0x9e3779b97f4a7c15ull;
  for (const std::uint64_t x : plane) key = (key ^ (key >> 29) ^ mul(x, scale)) * 0xbf58476d1ce4e5b9ull;
  return std::max(key, kNoRatio + 1);
}

/// Computes the keys of some triangles, with a single inverse, that of the product of all pivots (Montgomery).
void find_keys(const SceneFloats& scene, std::uint32_t first, std::span<std::uint64_t> keys) {
  std::vector<PlaneResidues> planes(keys.size());
  std::vector<std::uint64_t> before(keys.size());  // the product of the pivots of all previous planes
  std::uint64_t product = 1;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::array<glm::vec3, 3> corners = scene.corners(first + static_cast<std::uint32_t>(i));
    planes[i] = plane_of(corners);
    before[i] = product;
    product = mul(product, pivot_of(planes[i]));
  }
  std::uint64_t rest = inverse(product);
  for (std::size_t i = keys.size(); i-- > 0;) {
    keys[i] = key_of(planes[i], mul(rest, before[i]));
    rest = mul(rest, pivot_of(planes[i]));
  }
}

// ---- Verification.

/// Converts one axis of two triangles to integers in units of the axis' smallest bit; a determinant's sign does not
/// depend on units that differ by axis. Returns false if they take more than 62 bits.
bool to_integers(const std::array<glm::vec3, 3>& carrier, const std::array<glm::vec3, 3>& other, int axis,
                 std::array<std::int64_t, 6>& out) {
  std::array<Dyadic, 6> values;
  int lowest = 1000, highest = -1000;
  for (std::size_t i = 0; i < 6; ++i) {
    values[i] = dyadic(i < 3 ? carrier[i][axis] : other[i - 3][axis]);
    if (values[i].mantissa == 0) continue;
    lowest = std::min(lowest, values[i].exponent);
    highest = std::max(highest, values[i].exponent + 24);
  }
  if (highest - lowest > 62) return false;
  for (std::size_t i = 0; i < 6; ++i) {
    out[i] = values[i].mantissa == 0 ? 0 : values[i].mantissa * (std::int64_t{1} << (values[i].exponent - lowest));
  }
  return true;
}

/// Equals coplanar(), fast for the usual result true, where filtered predicates are slow: in 128-bit integers if the
/// coordinates fit.
bool coplanar_quickly(const std::array<glm::vec3, 3>& carrier, const std::array<glm::vec3, 3>& other) {
  std::array<std::array<std::int64_t, 6>, 3> q{};
  int bits = 3;  // a determinant is a sum of six products
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!to_integers(carrier, other, static_cast<int>(axis), q[axis])) return coplanar(carrier, other);
    std::uint64_t widest = 0;
    for (std::size_t i = 1; i < 6; ++i) {
      q[axis][i] -= q[axis][0];
      widest |= static_cast<std::uint64_t>(std::abs(q[axis][i]));
    }
    bits += static_cast<int>(std::bit_width(widest));
  }
  if (bits > 126) return coplanar(carrier, other);
  const auto minor = [&](std::size_t i, std::size_t j) {
    return static_cast<Int128>(q[i][1]) * q[j][2] - static_cast<Int128>(q[j][1]) * q[i][2];
  };
  const Int128 nx = minor(1, 2), ny = minor(2, 0), nz = minor(0, 1);
  for (std::size_t i = 3; i < 6; ++i) {
    if (nx * q[0][i] + ny * q[1][i] + nz * q[2][i] != 0) return false;
  }
  return true;
}

}  // namespace

std::vector<std::uint32_t> plane_ids(const SceneFloats& scene) {
  const std::size_t count = scene.triangles.size();
  std::vector<std::uint32_t> plane;
  resize_on_all_cores(plane, count);
  UnsetList<std::uint64_t> keys(count);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1024), [&](const auto& range) {
    find_keys(scene, static_cast<std::uint32_t>(range.begin()), std::span(keys).subspan(range.begin(), range.size()));
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const auto [a, b, c] = scene.corners(static_cast<std::uint32_t>(i));
      if (collinear(a, b, c)) keys[i] = kFlat;
    }
  });

  // Compares each triangle with the first one of its key. What remains are keys that collided (about one pair in 2⁶⁴)
  // and planes without a key (contrived): each such triangle is compared with every plane that could be its own, in
  // order of triangles.
  const std::vector<std::uint32_t> first = first_of_same(
      count, [&](std::size_t i) { return keys[i]; }, [&](std::size_t i, std::size_t j) { return keys[i] == keys[j]; });
  tbb::concurrent_vector<std::uint32_t> collided, keyless;
  for_each_index(count, [&](std::size_t i) {
    const auto triangle = static_cast<std::uint32_t>(i);
    plane[i] = SceneFloats::kNoPlane;
    if (keys[i] == kFlat) return;
    if (keys[i] == kNoRatio) {
      keyless.push_back(triangle);
    } else if (first[i] == triangle || coplanar_quickly(scene.corners(first[i]), scene.corners(triangle))) {
      plane[i] = first[i];
    } else {
      collided.push_back(triangle);
    }
  });
  std::sort(keyless.begin(), keyless.end());
  std::sort(collided.begin(), collided.end());
  for (const auto* leftovers : {&collided, &keyless}) {
    for (const std::uint32_t triangle : *leftovers) {
      std::uint32_t giver = 0;  // plane[i] == i: the plane has the number of triangle i
      while (giver < count && (plane[giver] != giver || !coplanar(scene.corners(giver), scene.corners(triangle)))) {
        ++giver;
      }
      plane[triangle] = giver < count ? giver : triangle;
    }
  }
  return plane;
}

}  // namespace penumbra::visibility
