// SPDX-License-Identifier: Apache-2.0
// Fits the maps of a light point. A light emits into a half space, but one perspective image cannot hold 180°.
// Receivers are finite, and every occluder between a receiver and the light point is seen in the receiver's direction:
// a window that holds every receiver's direction misses no shadow. Its bounds, min and max of x/z and of y/z over the
// receivers' corners, are reached on the convex hulls of the corners seen along y and along x; those hulls are the same
// for all points of the light, so that thousands of points can be fitted one by one. If a receiver reaches up to the
// light's plane, or the window becomes wider than kWidestTangent allows, the window is replaced by a hemicube (Cohen
// and Greenberg 1985): one face along the normal, [−1, 1]², and four sideways, [−1, 1] × [0, 1], upper halves of a
// cube's faces.

#include "maps/host/map_fit.hpp"

#include "base/assert.hpp"
#include "visibility/receivers.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace penumbra::maps {
namespace {

constexpr std::uint32_t kHemicubeFaces = 5;

double cross(const glm::dvec2& o, const glm::dvec2& a, const glm::dvec2& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// Andrew's monotone chain. Its decisions may be rounded: a corner that is off the hull by rounding moves a window's
/// bound by the same amount, and the window is a texel wider than its contents.
std::vector<glm::dvec2> convex_hull(std::vector<glm::dvec2> points) {
  const auto less = [](const glm::dvec2& a, const glm::dvec2& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); };
  std::sort(points.begin(), points.end(), less);
  if (points.size() < 3) return points;
  std::vector<glm::dvec2> hull;
  const auto chain = [&hull](auto first, auto last) {
    const std::size_t start = hull.size();
    for (; first != last; ++first) {
      while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), *first) <= 0) hull.pop_back();
      hull.push_back(*first);
    }
    hull.pop_back();  // first point of the other chain
  };
  chain(points.begin(), points.end());
  chain(points.rbegin(), points.rend());
  return hull;
}

struct Window {
  glm::dvec2 lower, upper;
};

void widen_to_snap(Window& window, std::uint32_t size) {
  for (int axis = 0; axis < 2; ++axis) {
    const SnappedSpan span = snapped(window.lower[axis], window.upper[axis], size);
    window.lower[axis] = span.lower;
    window.upper[axis] = span.lower + span.texel * size;
  }
}

/// Receivers, or casters, on one side of the light's plane, reduced to the data needed for fitting.
struct SideTriangles {
  bool any = false;
  bool reach_plane = false;                // some triangle crosses or touches the light's plane
  std::vector<glm::dvec2> hull_x, hull_y;  // (x, z) and (y, z), basis coordinates, z > 0
};

bool receives(const visibility::SceneFloats& scene, const visibility::Light& light, std::size_t triangle) {
  return visibility::is_receiver(scene, light, static_cast<std::uint32_t>(triangle)) &&
         scene.plane[triangle] != visibility::SceneFloats::kNoPlane;
}

/// Returns the part of a triangle in a beam, whose apex is the basis's centre.
std::vector<glm::dvec3> part_in(const visibility::Light::Beam& beam, const LightBasis& basis,
                                const std::array<glm::dvec3, 3>& corners) {
  const auto turned = [&](const glm::dvec3& x) {
    return glm::dvec3(glm::dot(x, basis.u), glm::dot(x, basis.v), glm::dot(x, basis.n));
  };
  std::vector<glm::dvec3> part(corners.begin(), corners.end()), next;
  for (const glm::dvec3& inward : {beam.a - beam.lower.x * beam.w, beam.upper.x * beam.w - beam.a,
                                   beam.b - beam.lower.y * beam.w, beam.upper.y * beam.w - beam.b}) {
    const glm::dvec3 plane = turned(inward);
    next.clear();
    for (std::size_t i = 0; i < part.size(); ++i) {
      const glm::dvec3 &from = part[i], &to = part[(i + 1) % part.size()];
      const double here = glm::dot(plane, from), there = glm::dot(plane, to);
      if (here >= 0) next.push_back(from);
      if ((here >= 0) != (there >= 0)) next.push_back(from + here / (here - there) * (to - from));
    }
    std::swap(part, next);
  }
  return part;
}

/// Returns the receivers in a beam on the side of the beam's direction.
SideTriangles receivers_in(const visibility::SceneFloats& scene, const visibility::Light& light,
                           const LightBasis& basis, const std::vector<glm::dvec3>& local) {
  SideTriangles side;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (!receives(scene, light, i)) continue;
    const visibility::Triangle& corners = scene.triangles[i];
    for (const glm::dvec3& corner :
         part_in(*light.beam, basis, {local[corners[0]], local[corners[1]], local[corners[2]]})) {
      side.any = true;
      if (!(corner.z > 0)) side.reach_plane = true;
      side.hull_x.emplace_back(corner.x, corner.z);
      side.hull_y.emplace_back(corner.y, corner.z);
    }
  }
  side.hull_x = convex_hull(std::move(side.hull_x));
  side.hull_y = convex_hull(std::move(side.hull_y));
  return side;
}

template <typename Counts>
SideTriangles triangles_on_side(const visibility::SceneFloats& scene, const std::vector<glm::dvec3>& local, double sign,
                                const Counts& counts) {
  SideTriangles side;
  std::vector<std::uint8_t> used(local.size(), 0);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (!counts(i)) continue;
    const visibility::Triangle& corners = scene.triangles[i];
    const auto in_front = std::count_if(corners.begin(), corners.end(), [&](auto c) { return sign * local[c].z > 0; });
    if (in_front == 0) continue;
    side.any = true;
    if (in_front < 3) side.reach_plane = true;
    for (const std::uint32_t corner : corners) used[corner] = 1;
  }
  if (!side.any || side.reach_plane) return side;
  for (std::size_t i = 0; i < local.size(); ++i) {
    if (used[i] == 0) continue;
    side.hull_x.emplace_back(local[i].x, sign * local[i].z);
    side.hull_y.emplace_back(local[i].y, sign * local[i].z);
  }
  side.hull_x = convex_hull(std::move(side.hull_x));
  side.hull_y = convex_hull(std::move(side.hull_y));
  return side;
}

/// Keeps the points of a hull in (x, z) at which x / z, seen from one point, and z have their bounds.
class Extremes {
 public:
  Extremes(double origin, double origin_z) : origin_(origin), origin_z_(origin_z) {}

  void add(const glm::dvec2& at) {
    const double quotient = (at.x - origin_) / (at.y - origin_z_);  // as in tangents()
    if (!any_ || quotient < least_) least_ = quotient, points_[0] = at;
    if (!any_ || quotient > greatest_) greatest_ = quotient, points_[1] = at;
    if (!any_ || at.y < points_[2].y) points_[2] = at;
    if (!any_ || at.y > points_[3].y) points_[3] = at;
    any_ = true;
  }
  [[nodiscard]] std::vector<glm::dvec2> points() const {
    return any_ ? std::vector<glm::dvec2>(points_.begin(), points_.end()) : std::vector<glm::dvec2>();
  }

 private:
  double origin_, origin_z_, least_ = 0, greatest_ = 0;
  std::array<glm::dvec2, 4> points_{};
  bool any_ = false;
};

/// Returns the same data as triangles_on_side(), but for triangles that are not in the scene, and for maps of one
/// point.
template <typename Counts>
SideTriangles passing_on_side(const visibility::AllTriangles& all, const LightBasis& basis, const glm::vec3& point,
                              double sign, const Counts& counts) {
  const glm::dvec3 origin = basis.local(point);
  SideTriangles side;
  Extremes along_x(origin.x, sign * origin.z), along_y(origin.y, sign * origin.z);
  all.for_each_run([&](const visibility::AllTriangles::Run& run) {
    if (!counts(run)) return;
    for (const std::array<glm::vec3, 3>& corners : run.corners) {
      const std::array<glm::dvec3, 3> local{basis.local(corners[0]), basis.local(corners[1]), basis.local(corners[2])};
      const auto in_front = std::ranges::count_if(local, [&](const glm::dvec3& at) { return sign * at.z > 0; });
      if (in_front == 0) continue;
      side.any = true;
      if (in_front < 3) side.reach_plane = true;
      if (side.reach_plane) continue;
      for (const glm::dvec3& at : local) {
        along_x.add({at.x, sign * at.z});
        along_y.add({at.y, sign * at.z});
      }
    }
  });
  if (!side.any || side.reach_plane) return side;
  side.hull_x = along_x.points();
  side.hull_y = along_y.points();
  return side;
}

/// Returns the same data as triangles_on_side() for the receivers seen by a camera: none of them reaches the light's
/// plane.
SideTriangles body_on_side(std::span<const BodyPoint> body, const LightBasis& basis, double sign) {
  SideTriangles side;
  for (const BodyPoint& point : body) {
    const glm::dvec3 at = basis.local(point.p);
    if (!(sign * at.z > 0)) continue;
    side.any = true;
    side.hull_x.emplace_back(at.x, sign * at.z);
    side.hull_y.emplace_back(at.y, sign * at.z);
  }
  side.hull_x = convex_hull(std::move(side.hull_x));
  side.hull_y = convex_hull(std::move(side.hull_y));
  return side;
}

/// Returns the bounds of (coordinate − origin) / z; infinite if the light point is not below the whole hull.
std::pair<double, double> tangents(const std::vector<glm::dvec2>& hull, double origin, double origin_z) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double lower = kInfinity, upper = -kInfinity;
  for (const glm::dvec2& corner : hull) {
    const double z = corner.y - origin_z;  // light points are stored in float32: on their plane up to rounding
    if (!(z > 0)) return {-kInfinity, kInfinity};
    lower = std::min(lower, (corner.x - origin) / z);
    upper = std::max(upper, (corner.x - origin) / z);
  }
  return {lower, upper};
}

/// Required contents of a window.
struct Contents {
  const SideTriangles& receivers;
  const SideTriangles& casters;  ///< casters to include, up to the distance `beside` from the receivers' directions
  glm::dvec2 beside;
  bool or_hemicube;  ///< a hemicube replaces a window that is too wide because of its casters
};

/// Returns the largest distance from a receiver's direction at which a caster can shade the receiver, for a light with
/// extent `reach`.
glm::dvec2 beside_of(const glm::dvec2& reach, const SideTriangles& receivers, const SideTriangles& casters) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (reach == glm::dvec2(0) || !casters.any || receivers.reach_plane) return glm::dvec2(0);
  if (casters.reach_plane) return glm::dvec2(kInfinity);
  double nearest = kInfinity, deepest = 0;
  for (const glm::dvec2& corner : casters.hull_x) nearest = std::min(nearest, corner.y);
  for (const glm::dvec2& corner : receivers.hull_x) deepest = std::max(deepest, corner.y);
  return reach * std::max(0.0, 1 / nearest - 1 / deepest);
}

/// Returns the window of one light point with a margin of one texel on every side; nullopt if the window would be too
/// wide.
std::optional<Window> fit_window(const Contents& contents, const glm::dvec3& origin, double sign, std::uint32_t size) {
  const auto& [receivers, casters, beside, or_hemicube] = contents;
  if (receivers.reach_plane) return std::nullopt;
  Window window{};
  for (int axis = 0; axis < 2; ++axis) {
    const double origin_z = sign * origin.z;
    auto [lower, upper] = tangents(axis == 0 ? receivers.hull_x : receivers.hull_y, origin[axis], origin_z);
    if (!(std::max(-lower, upper) <= kWidestTangent)) return std::nullopt;
    if (casters.any && beside[axis] > 0) {
      // Casters that reach the light's plane are seen in every direction.
      constexpr double kInfinity = std::numeric_limits<double>::infinity();
      const auto [first, last] = casters.reach_plane
                                     ? std::pair(-kInfinity, kInfinity)
                                     : tangents(axis == 0 ? casters.hull_x : casters.hull_y, origin[axis], origin_z);
      lower = std::min(lower, std::max(first, lower - beside[axis]));
      upper = std::max(upper, std::min(last, upper + beside[axis]));
      if (or_hemicube && !(std::max(-lower, upper) <= kWidestTangent)) return std::nullopt;
    }
    // A receiver seen edge-on has zero width: then float32's resolution of a tangent is used.
    const double texel = std::max((upper - lower) / (size - 2), kWidestTangent * 0x1p-20);
    window.lower[axis] = lower - texel;
    window.upper[axis] = upper + texel;
  }
  return window;
}

/// Returns an upper bound of the distance of the scene's corners from x.
double farthest(const visibility::SceneFloats& scene, const glm::dvec3& x) {
  const glm::dvec3 reach = glm::max(glm::abs(glm::dvec3(scene.lower) - x), glm::abs(glm::dvec3(scene.upper) - x));
  return glm::length(reach);
}

}  // namespace

glm::dvec2 reach_of_all(const visibility::SceneFloats& scene) {
  return glm::dvec2(0x1p20 * glm::length(glm::dvec3(scene.upper) - glm::dvec3(scene.lower)));
}

FittedViews fit_views(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis,
                      std::span<const glm::vec3> points, const FitOptions& options) {
  PENUMBRA_ASSERT(options.all == nullptr || (points.size() == 1 && options.body == nullptr && !light.beam),
                  "light {}: maps of {} points of triangles that pass", light.name, points.size());
  std::vector<glm::dvec3> local(scene.positions.size());
  std::transform(scene.positions.begin(), scene.positions.end(), local.begin(),
                 [&](const glm::vec3& x) { return basis.local(x); });

  FittedViews fitted;
  fitted.views.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    fitted.views[i].point = points[i];
    // Strictly beyond all surfaces: a depth of 1 means an empty texel.
    fitted.views[i].far = static_cast<float>(std::max(farthest(scene, points[i]) * 1.0625, 1e-30));
  }
  const bool both_sides = light.two_sided || is_body(light.kind);
  for (int s = 0; s < (both_sides ? 2 : 1); ++s) {
    const double sign = s == 0 ? 1 : -1;
    const SideTriangles receivers =
        options.body != nullptr ? body_on_side(*options.body, basis, sign)
        : light.beam            ? receivers_in(scene, light, basis, local)
        : options.all != nullptr
            ? passing_on_side(*options.all, basis, points.front(), sign,
                              [&](const auto& run) { return run.receives_shadow && run.emits != light.index; })
            : triangles_on_side(scene, local, sign, [&](std::size_t i) { return receives(scene, light, i); });
    if (!receivers.any) continue;
    const bool beside = options.beside != glm::dvec2(0) || options.reach != glm::dvec2(0);
    const SideTriangles casters =
        options.all != nullptr && beside
            ? passing_on_side(*options.all, basis, points.front(), sign,
                              [&](const auto& run) { return run.casts_shadow && run.emits != light.index; })
            : triangles_on_side(scene, local, sign, [&](std::size_t i) {
                return beside && scene.casts_shadow[i] != 0 && scene.emits[i] != light.index;
              });
    glm::dvec2 margin = options.beside + beside_of(options.reach, receivers, casters);
    if (options.body_reach != glm::dvec2(0))
      margin = glm::min(margin, beside_of(options.body_reach, receivers, casters));
    const Contents contents{receivers, casters, margin, options.reach != glm::dvec2(0)};
    bool windows = !options.hemicube;  // for all points of the light or for none
    for (gpu::LightView& view : fitted.views) {
      if (!windows) break;
      std::optional<Window> window = fit_window(contents, basis.local(view.point), sign, options.size);
      if (!window) {
        windows = false;
        break;
      }
      if (options.snap) widen_to_snap(*window, options.size);
      const glm::dvec2 moved = options.jitter * (window->upper - window->lower) / static_cast<double>(options.size);
      window->lower += moved;
      window->upper += moved;
      view.side[s].lower = window->lower;
      view.side[s].upper = window->upper;
    }
    for (gpu::LightView& view : fitted.views) {
      view.side[s].first_face = fitted.faces;
      view.side[s].face_count = windows ? 1 : kHemicubeFaces;
    }
    fitted.faces += windows ? 1 : kHemicubeFaces;
  }
  return fitted;
}

glm::dvec2 caster_margin(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis,
                         double sign, const glm::dvec2& reach, double deepest) {
  std::vector<glm::dvec3> local(scene.positions.size());
  std::transform(scene.positions.begin(), scene.positions.end(), local.begin(),
                 [&](const glm::vec3& x) { return basis.local(x); });
  const SideTriangles casters = triangles_on_side(
      scene, local, sign, [&](std::size_t i) { return scene.casts_shadow[i] != 0 && scene.emits[i] != light.index; });
  SideTriangles receivers;
  receivers.hull_x.emplace_back(0, deepest);
  return beside_of(reach, receivers, casters);
}

Face face_of(const gpu::LightView& view, const LightBasis& basis, std::uint32_t face) {
  const int s = face >= view.side[0].first_face + view.side[0].face_count ? 1 : 0;
  const gpu::SideView& side = view.side[s];
  const glm::dvec3 up = s == 0 ? basis.n : -basis.n;
  if (side.face_count == 1) return {basis.u, basis.v, up, side.lower, side.upper};
  // taps.glsl selects faces and coordinates in the same order.
  const glm::dvec2 upper(1), whole(-1), half(-1, 0);
  const std::array<Face, kHemicubeFaces> hemicube{{{basis.u, basis.v, up, whole, upper},
                                                   {basis.v, up, basis.u, half, upper},
                                                   {basis.v, up, -basis.u, half, upper},
                                                   {basis.u, up, basis.v, half, upper},
                                                   {basis.u, up, -basis.v, half, upper}}};
  return hemicube[face - side.first_face];
}

gpu::CasterPush face_push(const gpu::LightView& view, const LightBasis& basis, std::uint32_t face) {
  const auto [a, b, w, lower, upper] = face_of(view, basis, face);
  // clip.x / clip.w runs from −1 to 1 while a / w runs over the window.
  const glm::dvec2 scale = 2.0 / (upper - lower), shift = (lower + upper) / (upper - lower);
  gpu::CasterPush push{};
  push.point = view.point;
  push.near = view.far * kNearOfFar;
  push.far = view.far;
  push.row_x = scale.x * a - shift.x * w;
  push.row_y = scale.y * b - shift.y * w;
  push.row_w = w;
  push.depth_row = {0, 0, 1};
  return push;
}

}  // namespace penumbra::maps
