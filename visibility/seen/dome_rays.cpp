// SPDX-License-Identifier: Apache-2.0
// Finds triangles that block pairs of a point and a light sample of a dome: one triangle that blocks the pair beyond
// doubt, or all triangles that may lie between (docs/instances.md).

#include "visibility/seen/dome_rays.hpp"

#include "base/assert.hpp"
#include "mesh/predicates.hpp"
#include "visibility/float_meeting.hpp"
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

/// Returns whether a direction is below the plane of the point's surface beyond doubt; such a direction needs no ray.
bool is_below(const SeenPoint& point, const glm::dvec3& direction) {
  const glm::dvec3 a = point.carrier[0], b = glm::dvec3(point.carrier[1]) - a, c = glm::dvec3(point.carrier[2]) - a;
  const glm::dvec3 normal = glm::cross(b, c);
  const double doubt = kFloatDoubt * glm::dot(wide_cross(glm::abs(b), glm::abs(c)), glm::abs(direction));
  const double up = glm::dot(normal, glm::dvec3(point.n));
  return (up > 0 ? glm::dot(normal, direction) : -glm::dot(normal, direction)) < -doubt;
}

}  // namespace

/// Follows rays in one direction from one point after the other.
class DomeRays::Walk {
 public:
  Walk(const DomeRays& rays, const glm::vec3& direction, TriangleBits& seen)
      : rays_(rays), direction_(direction), seen_(seen) {}

  void run(const SeenPoint& point) {
    if (is_below(point, direction_)) return;
    point_ = &point;
    starts_.emplace(point.p);
    if (last_ && float_rays_meet(*starts_, direction_, *last_) == FloatMeeting::surely &&
        !mesh::coplanar(point.carrier, *last_))
      return;
    candidates_.clear();
    nearest_ = TreeRay::kEndless;
    const PlacedMeshes& meshes = rays_.meshes_;
    const double around = kFloatDoubt * starts_->room;  // largest difference from the point that a method uses
    const TreeRay ray(starts_->middle, direction_, glm::dvec3(around), kFloatBeside);
    walk_nearest(
        meshes.tree(), nearest_, [&](const MiddleBox& box) { return ray.enter(box); },
        [&](std::uint32_t number) {
          const PlacedMeshes::Part& part = meshes.parts()[number];
          walk_part(part, starts_->middle, direction_, around, kFloatBeside, nearest_,
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
    const FloatMeeting meets = float_rays_meet(*starts_, direction_, corners);
    if (meets == FloatMeeting::no || mesh::coplanar(point_->carrier, corners)) return;
    const std::uint64_t bit = part.first_bit + triangle;
    if (meets == FloatMeeting::maybe || role == Role::filters) {
      candidates_.push_back(bit);
      return;
    }
    seen_.set(bit);
    last_ = corners;
    nearest_ = -1;
  }

  const DomeRays& rays_;
  const glm::dvec3 direction_;
  TriangleBits& seen_;
  const SeenPoint* point_ = nullptr;
  std::optional<RayStarts> starts_;
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
