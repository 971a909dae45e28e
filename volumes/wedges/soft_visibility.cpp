// SPDX-License-Identifier: Apache-2.0
// Computes soft shadow volumes (U. Assarsson, T. Akenine-Möller 2003) at one view sample and without a raster. Beyond
// the paper: arbitrary triangle soups, by signed multiplicities; exact decisions where a rounded one would change the
// result by a whole light; another reference point where an edge ends at the light's centre; also silhouettes from the
// receiver.

#include "volumes/wedges/soft_visibility.hpp"

#include "base/assert.hpp"
#include "mesh/silhouettes.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/closed_casters.hpp"
#include "volumes/wedges/layer_areas.hpp"
#include "volumes/wedges/planar.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <iterator>

namespace penumbra::volumes {
namespace {

using mesh::Side;
using visibility::SceneFloats;

constexpr std::uint32_t kNone = 0xffffffffU;

int sign_of(Side side) {
  return static_cast<int>(side);
}

bool box_misses(const std::array<glm::vec3, 3>& corners, const glm::vec3& lower, const glm::vec3& upper) {
  const auto& [a, b, c] = corners;
  return glm::any(glm::lessThan(glm::max(a, glm::max(b, c)), lower)) ||
         glm::any(glm::greaterThan(glm::min(a, glm::min(b, c)), upper));
}

/// Returns the contribution of a triangle seen from `side` to k of one of its edges (mesh/silhouettes.hpp).
int share_of(const mesh::EdgeGraph& graph, std::uint32_t edge, std::uint32_t triangle, Side side) {
  int sum = 0;
  for (const mesh::Incidence& incidence : graph.around(edge)) {
    if (incidence.triangle == triangle) sum += incidence.reversed ? -sign_of(side) : sign_of(side);
  }
  return sum;
}

}  // namespace

SoftVisibility::SoftVisibility(const SceneFloats& scene, const visibility::Light& light, const Casters& casters,
                               Arc arc)
    : scene_(scene),
      light_(light),
      casters_(casters),
      outline_(light_outline(light)),
      arc_(arc),
      center_(visibility::center_of(light)),
      tree_(visibility::make_triangle_tree(scene)),
      caster_of_(scene.triangles.size(), kNone),
      light_sides_(visibility::light_sides(casters.view(), casters.graph, light, center_)),
      center_facings_(mesh::facings(casters.view(), casters.graph, center_)) {
  if (light.texture) texture_.emplace(*light.texture);
  for (const glm::dvec2& corner : outline_.corners) {
    lower_ = glm::min(lower_, corner);
    upper_ = glm::max(upper_, corner);
  }
  for (std::uint32_t i = 0; i < casters.triangle.size(); ++i) {
    caster_of_[casters.triangle[i]] = i;
    by_plane_.emplace_back(scene.plane[casters.triangle[i]], i);
  }
  std::ranges::sort(by_plane_);
  visibility::keep_one_layer(light_sides_, true, center_facings_);
  for (std::uint32_t edge = 0; edge < casters.graph.edges.size(); ++edge) {
    const int k = mesh::signed_multiplicity(casters.graph, edge, center_facings_);
    if (k != 0) silhouettes_.emplace_back(edge, k);
  }
}

/// Returns true if the caster is coplanar with the carrier; or if p is on the caster's plane and in its box: the caster
/// may then touch p, and appears as a line or not at all.
bool SoftVisibility::is_left_out(std::uint32_t caster, const LitPoint& sample) const {
  const std::uint32_t triangle = casters_.triangle[caster];
  if (scene_.plane[triangle] == scene_.plane[sample.carrier]) return true;
  const std::array<glm::vec3, 3> corners = scene_.corners(triangle);
  if (box_misses(corners, sample.p, sample.p)) return false;
  return mesh::side_of_plane(corners[0], corners[1], corners[2], sample.p) == Side::on;
}

/// Returns whether one triangle counts, by the rule of keep_one_layer.
bool SoftVisibility::counts_for_receiver(std::uint32_t caster, Side seen) const {
  return seen != Side::on && (light_sides_[caster] == Side::on || light_sides_[caster] == mesh::opposite(seen));
}

/// Returns the silhouettes common to all view samples, minus the contributions of the triangles left out for this
/// sample.
std::vector<SoftVisibility::Silhouette> SoftVisibility::center_silhouettes(const LitPoint& sample,
                                                                           std::span<const Silhouette> of_all) const {
  std::vector<std::uint32_t> left_out;
  const std::uint32_t plane = scene_.plane[sample.carrier];
  for (auto at = std::ranges::lower_bound(by_plane_, std::pair{plane, 0U}); at != by_plane_.end() && at->first == plane;
       ++at) {
    left_out.push_back(at->second);
  }
  tree_.for_each_near(sample.p, sample.p, [&](std::uint32_t triangle) {
    const std::uint32_t caster = caster_of_[triangle];
    if (caster != kNone && scene_.plane[triangle] != plane && is_left_out(caster, sample)) left_out.push_back(caster);
  });
  std::vector<Silhouette> changes;
  for (const std::uint32_t caster : left_out) {
    if (center_facings_[caster] == Side::on) continue;
    for (const std::uint32_t edge : casters_.graph.triangle_edges[caster]) {
      changes.emplace_back(edge, -share_of(casters_.graph, edge, caster, center_facings_[caster]));
    }
  }
  if (changes.empty()) return {of_all.begin(), of_all.end()};
  std::ranges::sort(changes);
  std::vector<Silhouette> both, result;
  both.reserve(changes.size() + of_all.size());
  std::ranges::merge(changes, of_all, std::back_inserter(both));
  result.reserve(both.size());
  for (const Silhouette& change : both) {
    if (result.empty() || result.back().first != change.first) {
      result.push_back(change);
    } else {
      result.back().second += change.second;
    }
  }
  std::erase_if(result, [](const Silhouette& silhouette) { return silhouette.second == 0; });
  return result;
}

std::vector<SoftVisibility::Silhouette> SoftVisibility::receiver_silhouettes(const LitPoint& sample) const {
  std::vector<Side> sides = mesh::facings(casters_.view(), casters_.graph, sample.p);
  visibility::keep_one_layer(light_sides_, false, sides);
  for (std::uint32_t i = 0; i < sides.size(); ++i) {
    if (sides[i] != Side::on && is_left_out(i, sample)) sides[i] = Side::on;
  }
  std::vector<Silhouette> result;
  for (std::uint32_t edge = 0; edge < casters_.graph.edges.size(); ++edge) {
    const int k = mesh::signed_multiplicity(casters_.graph, edge, sides);
    if (k != 0) result.emplace_back(edge, k);
  }
  return result;
}

std::vector<SoftVisibility::Silhouette> SoftVisibility::silhouettes(const LitPoint& sample, Viewer viewer) const {
  return viewer == Viewer::center ? center_silhouettes(sample, silhouettes_) : receiver_silhouettes(sample);
}

/// Returns the light's centre; of a sphere, the centre of the disk visible from p.
glm::vec3 SoftVisibility::center_from(const glm::vec3& p) const {
  if (!is_body(light_.kind)) return center_;
  return glm::vec3(visibility::light_frame_from(light_, p).center);
}

/// Returns corners that bound the light as seen from p: of a sphere, the square around its disk, in floats.
std::vector<glm::vec3> SoftVisibility::corners_from(const glm::vec3& p) const {
  if (!is_body(light_.kind)) return light_.outline;
  const auto [c, u, v] = visibility::light_frame_from(light_, p);
  return {glm::vec3(c - u - v), glm::vec3(c + u - v), glm::vec3(c + u + v), glm::vec3(c - u + v)};
}

/// Returns the centre; or, if an edge's end appears there, a point between the centre and a corner, at a quarter to
/// half of the distance. (For a sphere, this point and the centre of its disk are an ulp off the disk: they stand for
/// the points where lines from p through them meet the disk.)
glm::vec3 SoftVisibility::choose_reference(const glm::vec3& p, const LightProjection& projection,
                                           std::span<const Candidate> edges) const {
  const auto clear = [&](const glm::vec3& l) {
    const Projected at = projection(glm::dvec3(l));
    const RadialCoverage coverage(outline_, at.point());
    return std::ranges::all_of(edges, [&](const Candidate& edge) {
      return coverage.is_clear_of(edge.clipped.from, edge.clipped.from_error + at.error()) &&
             coverage.is_clear_of(edge.clipped.to, edge.clipped.to_error + at.error());
    });
  };
  const glm::vec3 center = center_from(p);
  if (clear(center)) return center;
  for (const float share : {0.25F, 0.5F, 0.3125F, 0.4375F, 0.375F}) {
    for (const glm::vec3& corner : corners_from(p)) {
      const glm::vec3 l = center + share * (corner - center);
      if (clear(l)) return l;
    }
  }
  return center;  // a vertex appears at every one of these points, so none is better
}

bool SoftVisibility::counts_at_center(std::uint32_t triangle) const {
  const std::uint32_t caster = caster_of_[triangle];
  return caster != kNone && center_facings_[caster] != Side::on;
}

bool SoftVisibility::may_appear(const LightProjection& from, std::uint32_t edge) const {
  const auto [a, b] = casters_.graph.edges[edge];
  return !from.misses(casters_.positions[a], casters_.positions[b], lower_, upper_);
}

/// Returns the sign that a triangle's edges have been given if p→l meets the triangle; otherwise 0.
std::int32_t SoftVisibility::layer_of(std::uint32_t triangle, const LitPoint& sample, const glm::vec3& l,
                                      Viewer viewer) const {
  const std::uint32_t caster = caster_of_[triangle];
  if (caster == kNone || (viewer == Viewer::center && center_facings_[caster] == Side::on)) return 0;
  const std::array<glm::vec3, 3> corners = scene_.corners(triangle);
  if (box_misses(corners, glm::min(sample.p, l), glm::max(sample.p, l)) || is_left_out(caster, sample)) return 0;
  if (!visibility::segment_meets_triangle(sample.p, l, corners, light_).meets) return 0;
  // Facings refer to this order of corners: the scene's order, which is also that of the casters.
  const Side seen = mesh::side_of_plane(corners[0], corners[1], corners[2], sample.p);
  if (viewer == Viewer::center) return -sign_of(center_facings_[caster]) * sign_of(seen);
  return counts_for_receiver(caster, seen) ? 1 : 0;
}

/// Returns D at the point l of the light.
std::int32_t SoftVisibility::layers_at(const LitPoint& sample, const glm::vec3& l, Viewer viewer) const {
  std::int32_t layers = 0;
  tree_.for_each_near(glm::min(sample.p, l), glm::max(sample.p, l),
                      [&](std::uint32_t triangle) { layers += layer_of(triangle, sample, l, viewer); });
  return layers;
}

std::vector<std::array<glm::vec3, 3>> SoftVisibility::layers(const LitPoint& sample) const {
  glm::vec3 lower = sample.p, upper = sample.p;
  for (const glm::vec3& corner : corners_from(sample.p)) {
    lower = glm::min(lower, corner);
    upper = glm::max(upper, corner);
  }
  std::vector<std::array<glm::vec3, 3>> result;
  tree_.for_each_near(lower, upper, [&](std::uint32_t triangle) {
    const std::uint32_t caster = caster_of_[triangle];
    if (caster == kNone || is_left_out(caster, sample)) return;
    const std::array<glm::vec3, 3> corners = scene_.corners(triangle);
    if (!counts_for_receiver(caster, mesh::side_of_plane(corners[0], corners[1], corners[2], sample.p))) return;
    result.push_back(corners);
  });
  return result;
}

bool SoftVisibility::something_touches_light() const {
  return std::ranges::any_of(casters_.triangle,
                             [&](std::uint32_t triangle) { return touches_light(light_, scene_.corners(triangle)); });
}

double SoftVisibility::share_above_carrier(const LitPoint& sample) const {
  const auto [a, b, c] = scene_.corners(sample.carrier);
  const glm::dvec3 n =
      static_cast<double>(sample.facing) * glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
  const auto [center, u, v] = visibility::light_frame_from(light_, sample.p);
  return share_above(outline_, glm::dot(n, center - glm::dvec3(a)), {glm::dot(n, u), glm::dot(n, v)});
}

/// Returns the area beyond the edge as a fraction of the light (with a texture: of its weight), with the sign of the
/// turn around the reference point.
double SoftVisibility::area_beyond(const Candidate& edge, int side, const RadialCoverage& coverage,
                                   const glm::dvec2& reference) const {
  if (!texture_) return coverage.beyond(edge.clipped, side) / outline_.area;
  return texture_->weight_beyond({edge.clipped.from, edge.clipped.to, side}, reference);
}

LayerSum SoftVisibility::at(const LitPoint& sample, Viewer viewer, bool at_most_one) const {
  return sum_of(sample, viewer, silhouettes(sample, viewer), {.at_most_one = at_most_one});
}

std::vector<glm::dvec2> SoftVisibility::light_samples() const {
  PENUMBRA_ASSERT(is_planar(light_.kind), "the light samples of a {} have no frame coordinates", name_of(light_.kind));
  const auto [center, u, v] = visibility::light_frame(light_);
  const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v), size = uu * vv - uv * uv;
  std::vector<glm::dvec2> places;
  places.reserve(light_.points.size());
  for (const glm::vec3& l : light_.points) {
    const glm::dvec3 from = glm::dvec3(l) - center;
    const double on_u = glm::dot(from, u), on_v = glm::dot(from, v);
    places.emplace_back((on_u * vv - on_v * uv) / size, (on_v * uu - on_u * uv) / size);
  }
  return places;
}

double SoftVisibility::visible_share(const LayerSum& sum, std::span<const glm::dvec2> points,
                                     std::span<const double> weights) {
  if (!sum.in_front) return 0;
  std::vector<std::int32_t> layers(points.size(), sum.constant);
  for (const CoveredEdge& edge : sum.edges) {
    // `first` to `last` runs counter-clockwise around the reference point. The same numbers decide for both edges that
    // share an end: a point on the ray through it belongs to the edge that begins there, and to no other.
    const bool forward = edge.side > 0;
    const glm::dvec2 first = forward ? edge.clipped.from : edge.clipped.to;
    const glm::dvec2 last = forward ? edge.clipped.to : edge.clipped.from;
    const glm::dvec2 begins = first - sum.reference_at, ends = last - sum.reference_at, along = last - first;
    for (std::size_t j = 0; j < points.size(); ++j) {
      const glm::dvec2 to = points[j] - sum.reference_at;
      if (cross2(begins, to) < 0 || !(cross2(ends, to) < 0) || !(cross2(along, points[j] - first) < 0)) continue;
      layers[j] += edge.change;
    }
  }
  double visible = 0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    if (layers[j] == 0) visible += weights.empty() ? 1 : weights[j];
  }
  return std::min(weights.empty() ? visible / static_cast<double>(points.size()) : visible, sum.above);
}

LayerSum SoftVisibility::at_center(const LitPoint& sample, std::span<const Silhouette> edges,
                                   const CenterCount& count) const {
  return sum_of(sample, Viewer::center, center_silhouettes(sample, edges), count);
}

LayerSum SoftVisibility::sum_of(const LitPoint& sample, Viewer viewer, std::span<const Silhouette> edges,
                                const CenterCount& count) const {
  LayerSum result;
  const bool no_disk = is_body(light_.kind) &&  // p is outside by less than double precision resolves
                       visibility::light_frame_from(light_, sample.p).u == glm::dvec3(0);
  result.in_front = visibility::in_front_of_light(light_, sample.p) && !no_disk;
  if (!result.in_front) return result;
  const LightProjection projection(light_, sample.p);
  std::vector<Candidate> candidates;
  for (const auto& [edge, k] : edges) {
    if (!may_appear(projection, edge)) continue;
    const auto [a, b] = casters_.graph.edges[edge];
    const auto clipped = clip_to_light(outline_, projection(casters_.positions[a]), projection(casters_.positions[b]));
    if (clipped) candidates.push_back({edge, k, *clipped});
  }

  result.reference = choose_reference(sample.p, projection, candidates);
  result.reference_at = projection(glm::dvec3(result.reference)).point();
  result.moved = result.reference != center_from(sample.p);
  result.constant = count.layers && !result.moved ? *count.layers : layers_at(sample, result.reference, viewer);
  if (count.at_most_one) result.constant = std::min(result.constant, 1);
  const RadialCoverage coverage(outline_, result.reference_at, arc_);
  // k counts triangles that the viewer sees counter-clockwise. Triangles between c and p have the opposite orientation
  // as seen from c.
  const int sense = viewer == Viewer::center ? -projection.turn() : projection.turn();
  for (const Candidate& candidate : candidates) {
    const auto [a, b] = casters_.graph.edges[candidate.edge];
    const int side =
        -projection.turn() * visibility::edge_side(sample.p, result.reference, glm::vec3(casters_.positions[a]),
                                                   glm::vec3(casters_.positions[b]), light_);
    const double area = -sense * candidate.multiplicity * area_beyond(candidate, side, coverage, result.reference_at);
    result.edges.push_back({candidate.edge, candidate.multiplicity, static_cast<std::int8_t>(side), candidate.clipped,
                            area, -sense * candidate.multiplicity * side});
    result.sum += area;
  }
  result.blocked = result.constant + result.sum;
  result.above = share_above_carrier(sample);
  result.visibility = std::clamp(1 - result.blocked, 0.0, result.above);
  return result;
}

}  // namespace penumbra::volumes
