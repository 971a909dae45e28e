// SPDX-License-Identifier: Apache-2.0
// Finds triangles that block pairs of a point and a light sample of a dome: one triangle that blocks the pair beyond
// doubt, or all triangles that may lie between (docs/instances.md).

#include "visibility/seen/dome_rays.hpp"

#include "base/assert.hpp"
#include "mesh/predicates.hpp"
#include "visibility/seen/tree_ray.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

namespace penumbra::visibility {
namespace {

using Corners = std::array<glm::vec3, 3>;

/// Share of a sum's terms below which a sign counts as undecided. Methods that decide a pair in float32 are off by some
/// 2⁻²² of the terms (a ray of Embree: three differences, six products, their sums), so that they, too, meet what
/// surely blocks. (ray_certainly_meets, in certain_meeting.hpp, decides all that double can.)
constexpr double kDoubt = 0x1p-18;
/// Share of a box's distance by which a ray may pass beside the box and still be asked about its triangles: four times
/// what float32 rays are off at that distance, 2⁻²².
constexpr double kBeside = 0x1p-20;

/// Returns x × y with all terms added, none subtracted: the size of the terms, for x and y of absolute values.
glm::dvec3 wide_cross(const glm::dvec3& x, const glm::dvec3& y) {
  return {x.y * y.z + x.z * y.y, x.z * y.x + x.x * y.z, x.x * y.y + x.y * y.x};
}

/// Returns −1 or 1; 0 if the value may have any sign.
int sign_beyond(double value, double doubt) {
  return value > doubt ? 1 : value < -doubt ? -1 : 0;
}

enum class Meets : std::uint8_t { no, maybe, surely };

/// Returns whether a direction is below the plane of the point's surface beyond doubt; then nothing is asked about it.
bool is_below(const SeenPoint& point, const glm::dvec3& direction) {
  const glm::dvec3 a = point.carrier[0], b = glm::dvec3(point.carrier[1]) - a, c = glm::dvec3(point.carrier[2]) - a;
  const glm::dvec3 normal = glm::cross(b, c);
  const double doubt = kDoubt * glm::dot(wide_cross(glm::abs(b), glm::abs(c)), glm::abs(direction));
  const double up = glm::dot(normal, glm::dvec3(point.n));
  return sign_beyond(up > 0 ? glm::dot(normal, direction) : -glm::dot(normal, direction), doubt) < 0;
}

}  // namespace

/// A ray from a point to a light sample of a dome.
struct DomeRays::Ray {
  glm::dvec3 start, direction, wide;  ///< `wide`: absolute values of the direction
  /// Added to a corner's distance along each axis. The point that methods have may be off by a unit in the last place,
  /// 2⁻²³ of its largest coordinate; kDoubt of this is four times as much.
  double room;

  Ray(const glm::vec3& p, const glm::vec3& d) : start(p), direction(d), wide(glm::abs(direction)) {
    const glm::dvec3 far = glm::abs(start);
    room = 0x1p-3 * std::max({far.x, far.y, far.z});
  }

  [[nodiscard]] Meets meets(const Corners& corners) const {
    const glm::dvec3 a = glm::dvec3(corners[0]) - start, b = glm::dvec3(corners[1]) - start,
                     c = glm::dvec3(corners[2]) - start;
    const glm::dvec3 wide_a = glm::abs(a) + room, wide_b = glm::abs(b) + room, wide_c = glm::abs(c) + room;
    // On which side of the edge from x to y the ray passes: d · (x × y) = d · (x × (y − x)). Its terms are those of
    // d · ((y − x) × (y + x)), which Embree's robust rays compute; moving the start by δ changes it by d · ((x − y) ×
    // δ), which the room in `wide_x` and `wide_y` covers.
    const auto side = [&](const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& wide_x,
                          const glm::dvec3& wide_y) {
      const glm::dvec3 edge = y - x;
      return sign_beyond(glm::dot(direction, glm::cross(x, edge)),
                         kDoubt * glm::dot(wide, wide_cross(glm::abs(edge), wide_x + wide_y)));
    };
    const int ab = side(a, b, wide_a, wide_b), bc = side(b, c, wide_b, wide_c);
    if (ab * bc < 0) return Meets::no;
    const int ca = side(c, a, wide_c, wide_a);
    if (ab * ca < 0 || bc * ca < 0) return Meets::no;
    // The three sides add up to n · direction, n = (b − a) × (c − a): a common sign is its sign, and the ray's
    // parameter at the plane is n · a over it.
    if (ab == 0 || bc == 0 || ca == 0) return Meets::maybe;
    const glm::dvec3 to_b = b - a, to_c = c - a;
    const int before = ab * sign_beyond(glm::dot(glm::cross(to_b, to_c), a),
                                        kDoubt * glm::dot(wide_cross(glm::abs(to_b), glm::abs(to_c)), wide_a));
    return before > 0 ? Meets::surely : before < 0 ? Meets::no : Meets::maybe;
  }
};

/// Follows rays in one direction from one point after the other.
class DomeRays::Walk {
 public:
  Walk(const DomeRays& rays, const glm::vec3& direction, TriangleBits& seen)
      : rays_(rays), direction_(direction), seen_(seen) {}

  void run(const SeenPoint& point) {
    if (is_below(point, direction_)) return;
    point_ = &point;
    ray_.emplace(point.p, direction_);
    if (last_ && ray_->meets(*last_) == Meets::surely && !mesh::coplanar(point.carrier, *last_)) return;
    candidates_.clear();
    nearest_ = TreeRay::kEndless;
    const PlacedMeshes& meshes = rays_.meshes_;
    const double around = kDoubt * ray_->room;  // by which the point that methods have may be elsewhere
    const TreeRay ray(ray_->start, ray_->direction, glm::dvec3(around), kBeside);
    walk_nearest(
        meshes.tree(), nearest_, [&](const MiddleBox& box) { return ray.enter(box); },
        [&](std::uint32_t number) {
          const PlacedMeshes::Part& part = meshes.parts()[number];
          walk_part(part, ray_->start, ray_->direction, around, kBeside, nearest_,
                    [&](std::uint32_t triangle) { take(part, triangle); });
        });
    if (nearest_ < 0) return;
    for (const std::uint64_t bit : candidates_) seen_.set(bit);
  }

 private:
  void take(const PlacedMeshes::Part& part, std::uint32_t triangle) {
    if (nearest_ < 0) return;
    const Role role = rays_.roles_[rays_.meshes_.object(part, triangle)];
    if (role == Role::none) return;
    const Corners corners = rays_.meshes_.corners(part, triangle);
    const Meets meets = ray_->meets(corners);
    if (meets == Meets::no || mesh::coplanar(point_->carrier, corners)) return;
    const std::uint64_t bit = part.first_bit + triangle;
    if (meets == Meets::maybe || role == Role::filters) {
      candidates_.push_back(bit);
      return;
    }
    seen_.set(bit);
    last_ = corners;
    nearest_ = -1;
  }

  const DomeRays& rays_;
  const glm::vec3 direction_;
  TriangleBits& seen_;
  const SeenPoint* point_ = nullptr;
  std::optional<Ray> ray_;
  double nearest_ = TreeRay::kEndless;  // below 0: a triangle surely blocks
  std::vector<std::uint64_t> candidates_;
  std::optional<Corners> last_;  // blocked an earlier ray; its bit is set
};

DomeRays::DomeRays(const PlacedMeshes& meshes, const Light& dome) : meshes_(meshes), dome_(dome) {
  PENUMBRA_ASSERT(dome.dome && !dome.points.empty(), "light {}: {} light samples of no dome", dome.name,
                  dome.points.size());
  const std::vector<scenes::Object>& objects = meshes.scene().objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const bool casts = objects[i].casts_shadow && (dome.unshaded_by.empty() || dome.unshaded_by[i] == 0);
    roles_.push_back(!casts                                                 ? Role::none
                     : objects[i].alpha.mode == scenes::Alpha::Mode::opaque ? Role::blocks
                                                                            : Role::filters);
  }
}

void DomeRays::add(std::span<const SeenPoint> points, TriangleBits& seen) const {
  for (const glm::vec3& direction : dome_.points) {
    Walk walk(*this, direction, seen);
    for (const SeenPoint& point : points) walk.run(point);
  }
}

}  // namespace penumbra::visibility
