// SPDX-License-Identifier: Apache-2.0
// Fits faces to the view of a camera: bounds of the visible receivers and their casters, warps and quadtree tiles
// (docs/map-fits.md).

#include "maps/host/face_fit.hpp"

#include "maps/host/aliasing.hpp"
#include "maps/host/base_face.hpp"
#include "maps/host/warps.hpp"
#include "visibility/receivers.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

namespace penumbra::maps {
namespace {

constexpr double kFarAway = std::numeric_limits<double>::infinity();
/// Overlap of slices as a fraction of a depth: the device selects a receiver's slice in float32.
constexpr double kOverlap = 0x1p-16;

/// Returns to_unit() with b' unchanged: for logarithmic rows, whose b' already is 0 to 1.
glm::dmat3 to_unit_across(const PlaceBounds& bounds, double margin) {
  glm::dmat3 matrix = to_unit(bounds, margin);
  matrix[1] = {0, 1, 0};
  matrix[2].y = 0;
  return matrix;
}

/// Scales the face's matrix so that k is at least the depth along the axis in all of the face: the near plane clips k.
void normalise(FittedFace& face) {
  double most = 0;
  for (const double a : {0.0, 1.0}) {
    for (const double b : {0.0, 1.0}) {
      most = std::max(most, glm::dot(face.along, glm::inverse(face.to_face) * glm::dvec3(a, b, 1)));
    }
  }
  face.to_face *= most;
}

class FaceFitter {
 public:
  FaceFitter(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis,
             const visibility::ViewSamples& samples, const FaceFitOptions& options)
      : scene_(scene), light_(light), basis_(basis), samples_(samples), options_(options) {}

  void add_side(int side, std::vector<FittedFace>& faces) {
    side_ = side;
    std::vector<BodyPoint> body =
        in_front(body_points(scene_, light_, basis_, samples_, options_.fit.body, 0, kFarAway, options_.space));
    if (body.empty()) return;
    const auto [nearest, farthest] = std::ranges::minmax(body, {}, &BodyPoint::depth);
    find_margin(body);
    const std::uint32_t slices = options_.fit.slices();
    const double near = std::max(nearest.depth, 1e-6 * farthest.depth), far = std::max(farthest.depth, near);
    const std::vector<double> depths = split_depths(options_.fit, near, far, slices);
    for (std::uint32_t i = 0; i < slices; ++i) {
      const double from = i == 0 ? 0 : depths[i], to = i + 1 == slices ? kFarAway : depths[i + 1];
      const double least = from * (1 - kOverlap), most = to * (1 + kOverlap);
      if (slices > 1 && options_.fit.body == ViewBody::frustum) {
        add_slice(
            in_front(body_points(scene_, light_, basis_, samples_, ViewBody::frustum, least, most, options_.space)),
            from, to, faces);
      } else {
        std::vector<BodyPoint> part;
        std::ranges::copy_if(body, std::back_inserter(part),
                             [&](const BodyPoint& point) { return point.depth >= least && point.depth <= most; });
        add_slice(part, from, to, faces);
      }
    }
  }

 private:
  static constexpr std::size_t kSeenPerPoint = 5;
  /// Directions e of the receivers on this side of the light's plane, and of the look-ups' taps around them.
  struct Seen {
    std::vector<glm::dvec3> points;
    double near = kFarAway, far = 0;
  };

  [[nodiscard]] glm::dvec3 turned(const glm::dvec3& x) const {
    return {glm::dot(x, basis_.u), glm::dot(x, basis_.v), glm::dot(x, basis_.n) * (side_ == 0 ? 1 : -1)};
  }
  [[nodiscard]] std::vector<BodyPoint> in_front(std::vector<BodyPoint> points) const {
    std::erase_if(points, [&](const BodyPoint& point) { return !(turned(point.p - basis_.center).z > 0); });
    return points;
  }
  [[nodiscard]] double margin() const { return static_cast<double>(options_.spare) / options_.size; }

  void find_margin(const std::vector<BodyPoint>& body) {
    beside_ = options_.beside;
    if (options_.beside == glm::dvec2(0)) return;
    double deepest = 0;
    for (const BodyPoint& point : body) deepest = std::max(deepest, turned(point.p - basis_.center).z);
    if (options_.body_reach != glm::dvec2(0)) {
      beside_ =
          glm::min(beside_, caster_margin(scene_, light_, basis_, side_ == 0 ? 1 : -1, options_.body_reach, deepest));
    }
    // Taps outside the bounds of all casters are always lit.
    casters_ = PlaceBounds();
    for (std::uint32_t i = 0; i < scene_.triangles.size(); ++i) {
      if (scene_.casts_shadow[i] == 0 || scene_.emits[i] == light_.index) continue;
      for (const glm::vec3& corner : scene_.corners(i)) {
        const glm::dvec3 e = turned(glm::dvec3(corner) - basis_.center);
        if (e.z > 0) {
          casters_.add(glm::dvec2(e) / e.z);
        } else {
          casters_.add(glm::dvec2(-kFarAway));
          casters_.add(glm::dvec2(kFarAway));
        }
      }
    }
  }

  [[nodiscard]] Seen seen(const std::vector<BodyPoint>& body) const {
    Seen result;
    for (const BodyPoint& point : body) {
      const glm::dvec3 e = turned(point.p - basis_.center);
      result.points.push_back(e);
      result.near = std::min(result.near, point.depth);
      result.far = std::max(result.far, point.depth);
      if (beside_ == glm::dvec2(0)) continue;
      const glm::dvec2 at = glm::dvec2(e) / e.z;
      const glm::dvec2 lower = glm::max(at - beside_, glm::min(casters_.lower, at));
      const glm::dvec2 upper = glm::min(at + beside_, glm::max(casters_.upper, at));
      for (const double x : {lower.x, upper.x}) {
        for (const double y : {lower.y, upper.y}) result.points.emplace_back(x * e.z, y * e.z, e.z);
      }
    }
    return result;
  }

  void add_slice(const std::vector<BodyPoint>& body, double from, double to, std::vector<FittedFace>& faces) {
    if (body.empty()) return;
    const Seen all = seen(body);
    PlaceBounds bounds;
    for (const glm::dvec3& e : all.points) bounds.add(glm::dvec2(e) / e.z);
    const glm::dvec2 widest = glm::max(-bounds.lower, bounds.upper);
    const bool window = std::max(widest.x, widest.y) <= kWidestTangent;
    // On a hemicube, whole faces are used if taps continue on the next face, or if the body is a frustum's: its
    // polygons may pass through a face without a corner there.
    const bool whole = beside_ != glm::dvec2(0) || options_.spare > 1 || options_.fit.body == ViewBody::frustum;
    for (const BaseFace& base : std::span(kHemicube).first(window ? 1 : kHemicube.size())) {
      FittedFace face{.side = side_, .axis = base.axis, .along = base.along(), .from = from, .to = to};
      if (!window && whole) {
        PlaceBounds half;
        half.add({-1, base.axis == 2 ? -1 : 0});
        half.add({1, 1});
        face.to_face = to_unit(half, 0) * base.matrix();
        normalise(face);
        faces.push_back(face);
        continue;
      }
      std::vector<glm::dvec3> points;
      for (const glm::dvec3& e : all.points) {
        const glm::dvec3 at = base.matrix() * e;
        if (window || (at.z >= std::abs(at.x) * (1 - kOverlap) && at.z >= std::abs(at.y) * (1 - kOverlap))) {
          points.push_back(at);
        }
      }
      if (points.empty()) continue;
      const SeenBody body_here = seen_body(base, points, all);
      if (options_.fit.fit == Fit::faces) {
        add_frustum_faces(face, base, body_here, faces);
        continue;
      }
      const Fit fit = options_.fit.fit;
      const bool warps = fit != Fit::cascades && fit != Fit::tiles;
      fit_face(face, base, points, warps ? warp_of(fit, body_here, options_.fit.focus) : Warp());
      if (options_.fit.fit == Fit::tiles) {
        add_tiles(face, window ? 1 : kHemicube.size(), faces);
      } else {
        faces.push_back(face);
      }
    }
  }

  [[nodiscard]] SeenBody seen_body(const BaseFace& base, const std::vector<glm::dvec3>& points, const Seen& all) const {
    const visibility::PinholeCamera& camera = samples_.camera;
    const bool perspective = !camera.half_height;
    const glm::dmat3 matrix = base.matrix();
    return {.points = points,
            .near = std::max(all.near, 1e-6 * all.far),
            .far = all.far,
            .eye = matrix * turned(camera.eye - basis_.center),
            .forward = matrix * turned(camera.forward),
            .across = perspective ? matrix * turned(camera.screen_across()) : glm::dvec3(0),
            .upward = perspective ? matrix * turned(camera.screen_upward()) : glm::dvec3(0),
            .perspective = perspective};
  }

  /// Adds a face for each face of the frustum through which rays to receivers leave it. If a perspective is too strong
  /// for float32, the face `even`, fitted to all points without a perspective, is added last.
  void add_frustum_faces(const FittedFace& even, const BaseFace& base, const SeenBody& body,
                         std::vector<FittedFace>& faces) const {
    const std::vector<FrustumFace> frustum = frustum_faces(body);
    std::vector<std::vector<glm::dvec3>> parts(frustum.size());
    bool all_in_faces = !frustum.empty();
    const std::size_t group = beside_ == glm::dvec2(0) ? 1 : kSeenPerPoint;  // taps are in the receiver's face
    for (std::size_t i = 0; all_in_faces && i < body.points.size(); i += group) {
      const auto nearest =
          std::ranges::min_element(frustum, {}, [&](const FrustumFace& face) { return face.beyond(body.points[i]); });
      const auto points = body.points.subspan(i, group);
      std::ranges::copy(points, std::back_inserter(parts[static_cast<std::size_t>(nearest - frustum.begin())]));
    }
    for (std::size_t i = 0; i < frustum.size(); ++i) {
      if (options_.fit.body == ViewBody::frustum) {
        // Receivers' polygons may pass through a face without a corner there: the whole face is used.
        const glm::dmat3 directions = glm::inverse(frustum[i].matrix);
        parts[i].clear();
        for (const double x : {-1.0, 1.0}) {
          for (const double y : {-1.0, 1.0}) parts[i].push_back(directions * glm::dvec3(x, y, 1));
        }
      }
      if (parts[i].empty()) continue;
      if (!is_moderate(frustum[i].matrix, parts[i])) {
        all_in_faces = false;
        continue;
      }
      FittedFace face = even;
      fit_face(face, base, parts[i], {frustum[i].matrix});
      faces.push_back(face);
    }
    if (all_in_faces) return;
    FittedFace face = even;
    fit_face(face, base, body.points, Warp());
    faces.push_back(face);
  }

  void fit_face(FittedFace& face, const BaseFace& base, std::span<const glm::dvec3> points, const Warp& warp) const {
    PlaceBounds bounds;
    for (const glm::dvec3& point : points) {
      const glm::dvec3 at = warp.matrix * point;
      bounds.add(glm::dvec2(at) / at.z);
    }
    face.ratio = warp.ratio;
    face.margin = warp.ratio > 0 ? margin() : 0;
    face.to_face =
        (warp.ratio > 0 ? to_unit_across(bounds, margin()) : to_unit(bounds, margin())) * warp.matrix * base.matrix();
    normalise(face);
  }

  /// Square of the quadtree over a face.
  struct Tile {
    std::uint32_t level = 0;
    glm::dvec2 first{0};  ///< in squares of this level
    /// Position of each receiver in the square, and the number of cuts of the whole face that its aliasing error
    /// requires.
    std::vector<std::pair<glm::dvec2, double>> asked;

    [[nodiscard]] double missing() const {
      double sum = 0;
      for (const auto& [at, levels] : asked) sum += std::max(0.0, levels - level);
      return sum;
    }
  };

  /// Cuts squares in four, starting where receivers lack the most cuts, as long as more maps are permitted. `bases`:
  /// number of faces that share the permitted maps.
  void add_tiles(const FittedFace& whole, std::uint32_t bases, std::vector<FittedFace>& faces) const {
    std::vector<Tile> tiles(1);
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (!visibility::is_receiver(scene_, light_, samples_, i)) continue;
      const auto receiver = seen_receiver(samples_, i, basis_, true, options_.space);
      if (!receiver || receiver->side != side_ || faces_away(samples_, i, basis_)) continue;
      const auto at = whole.place(receiver->e);
      if (!at) continue;
      const glm::dvec2 errors = aliasing_error(whole, *receiver, samples_, i, basis_, options_.size, options_.space);
      tiles.front().asked.emplace_back(*at, std::log2(std::min(std::max(errors.x, errors.y), kMostAliasing)));
    }
    const std::size_t most_tiles = std::max(options_.fit.tiles / bases, 1U);
    while (tiles.size() + 3 <= most_tiles) {
      const auto most = std::ranges::max_element(tiles, {}, &Tile::missing);
      if (!(most->missing() > 0)) break;
      const Tile parent = std::move(*most);
      tiles.erase(most);
      for (const double y : {0.0, 1.0}) {
        for (const double x : {0.0, 1.0}) {
          Tile child{parent.level + 1, 2.0 * parent.first + glm::dvec2(x, y), {}};
          const double across = std::exp2(child.level);
          for (const auto& asked : parent.asked) {
            if (glm::floor(asked.first * across) == child.first) child.asked.push_back(asked);
          }
          tiles.push_back(std::move(child));
        }
      }
    }
    for (const Tile& tile : tiles) faces.push_back(square_of(whole, tile.level, tile.first));
  }

  const visibility::SceneFloats& scene_;
  const visibility::Light& light_;
  const LightBasis& basis_;
  const visibility::ViewSamples& samples_;
  const FaceFitOptions& options_;
  int side_ = 0;
  glm::dvec2 beside_{0};
  PlaceBounds casters_;
};

}  // namespace

FittedFace square_of(const FittedFace& whole, std::uint32_t level, const glm::dvec2& first) {
  FittedFace face = whole;
  const double across = std::exp2(level);
  const glm::dmat3 zoom{{across, 0, 0}, {0, across, 0}, {-first.x, -first.y, 1}};
  face.to_face = zoom * whole.to_face;
  normalise(face);
  return face;
}

std::vector<FittedFace> fit_faces(const visibility::SceneFloats& scene, const visibility::Light& light,
                                  const LightBasis& basis, const visibility::ViewSamples& samples,
                                  const FaceFitOptions& options) {
  FaceFitter fitter(scene, light, basis, samples, options);
  std::vector<FittedFace> faces;
  fitter.add_side(0, faces);
  if (light.two_sided || is_body(light.kind)) fitter.add_side(1, faces);
  return faces;
}

}  // namespace penumbra::maps
