// SPDX-License-Identifier: Apache-2.0
// Finds what pixels see of placed meshes: along each ray the nearest opaque triangle, decided by visibility::cover, and
// the translucent triangles in front of it (docs/instances.md).

#include "visibility/seen/view_rays.hpp"

#include "mesh/predicates.hpp"
#include "visibility/seen/tree_ray.hpp"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <optional>

namespace penumbra::visibility {

namespace {

/// Margin in pixels: a pixel that cover() assigns to a triangle by rounding is outside the triangle by less than
/// this. For a triangle that is not seen edge-on the distance is 2⁻⁴⁹ R² / s, where R is the triangle's distance and
/// s its shortest edge. Pixel boxes as in visibility/tree/view_walk.cpp would be a metre wide at the far end of a
/// forest, and hold every leaf of a tree.
constexpr double kPixels = 0x1p-4;

}  // namespace

/// Traversal of one pixel's ray, nearest nodes first.
class ViewRays::Walk {
 public:
  Walk(const ViewRays& rays, const ViewRay& ray) : rays_(rays), ray_(ray) {
    const PinholeCamera& camera = rays.camera_;
    pixel_ = kPixels * 2 * (camera.half_height ? 0 : camera.tan_half_fov) / camera.picture_height();
    everywhere_ = kPixels * 2 * camera.half_height.value_or(0) / camera.picture_height();
  }

  void run(std::vector<std::uint64_t>& bits, std::vector<SeenPoint>& points) {
    const PlacedMeshes& meshes = rays_.meshes_;
    const TreeRay ray(ray_.start, ray_.direction, glm::dvec3(everywhere_), pixel_);
    walk_nearest(
        meshes.tree(), nearest_, [&](const MiddleBox& box) { return ray.enter(box); },
        [&](std::uint32_t number) {
          const PlacedMeshes::Part& part = meshes.parts()[number];
          walk_part(part, ray_.start, ray_.direction, everywhere_, pixel_, nearest_,
                    [&](std::uint32_t triangle) { take(part, triangle); });
        });
    for (const Met& met : met_) {
      if (met.t > nearest_) continue;
      bits.push_back(met.bit);
      const glm::vec3 p = glm::vec3(ray_.start + met.t * ray_.direction) + 0.0f;
      if (!std::isfinite(p.x + p.y + p.z)) continue;
      const glm::dvec3 a = met.corners[0], b = met.corners[1], c = met.corners[2];
      glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
      if (glm::dot(n, ray_.direction) > 0) n = -n;
      points.push_back({p, glm::vec3(n), met.corners});
    }
  }

 private:
  void take(const PlacedMeshes::Part& part, std::uint32_t triangle) {
    const std::array<glm::vec3, 3> corners = rays_.meshes_.corners(part, triangle);
    const std::optional<double> t = cover(ray_, corners);
    if (!t || *t > nearest_ || mesh::collinear(corners[0], corners[1], corners[2])) return;
    met_.push_back({*t, part.first_bit + triangle, corners});
    if (rays_.is_solid_[rays_.meshes_.object(part, triangle)] != 0) nearest_ = *t;
  }

  const ViewRays& rays_;
  const ViewRay& ray_;
  double pixel_ = 0, everywhere_ = 0;
  double nearest_ = TreeRay::kEndless;  // distance of the nearest opaque triangle
  std::vector<Met> met_;
};

ViewRays::ViewRays(const PlacedMeshes& meshes, const PinholeCamera& camera) : meshes_(meshes), camera_(camera) {
  for (const scenes::Object& object : meshes.scene().objects)
    is_solid_.push_back(object.alpha.mode == scenes::Alpha::Mode::opaque ? 1 : 0);
}

void ViewRays::look(std::uint32_t x, std::uint32_t y, std::vector<std::uint64_t>& bits,
                    std::vector<SeenPoint>& points) const {
  const ViewRay ray = camera_.ray(x, y);
  Walk(*this, ray).run(bits, points);
}

}  // namespace penumbra::visibility
