// SPDX-License-Identifier: Apache-2.0
// Computes the area of the union of back-projected triangles, by signed edges.
//
// Each triangle, as seen from p, is clipped to the region between p and the light and oriented counter-clockwise; each
// of its edges then counts +1 or −1. Where triangles share an edge their counts add up: 0 inside a surface, ±2 on the
// silhouette of a closed one, any integer in a soup (Laine et al. 2005 for closed ones; docs/signed-crossings.md for
// any). The remaining edges bound the same depth complexity as all triangles do, and they are few; a sweep
// (area_sweep.hpp) computes the area where this complexity is zero. No assumption is made about the mesh.
//
// Reason for not using polygon Booleans: the union of n triangles has to merge every inner edge of a surface; here
// these edges cancel before any search for crossings.

#include "areas/exact_area.hpp"

#include "areas/area_sweep.hpp"
#include "areas/back_projection.hpp"
#include "areas/disk_measure.hpp"
#include "areas/form_factor_measure.hpp"
#include "areas/light_region.hpp"
#include "areas/light_shaft.hpp"
#include "areas/occluder_edges.hpp"
#include "areas/sweep_edges.hpp"
#include "areas/texture_measure.hpp"
#include "base/assert.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/lights/unshadowed_light.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <glm/common.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

namespace penumbra::areas {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::TriangleTree;

template <typename Number>
std::vector<SweepEdge<Number>> region_edges(const Region& region) {
  std::vector<SweepEdge<Number>> edges;
  for (std::size_t i = 0; i < region.size(); ++i) {
    const PlanePoint &a = region[i], &b = region[(i + 1) % region.size()];
    add_edge<Number>(
        edges, {number_of<Number>(a.s), number_of<Number>(a.t), number_of<Number>(b.s), number_of<Number>(b.t), 0, 1});
  }
  return edges;
}

bool all_inside(const GridBox& box, const HalfPlane& half_plane) {
  for (const mpz_class* s : {&box.s0, &box.s1}) {
    for (const mpz_class* t : {&box.t0, &box.t1}) {
      const mpz_class height = half_plane.at * GridBox::kGrid + half_plane.along_s * *s + half_plane.along_t * *t;
      if (height < 0) return false;
    }
  }
  return true;
}

}  // namespace

struct ExactAreaData {
  TriangleTree own_tree;  ///< used unless the caller has a tree
  WeldedScene scene;
  IntegerGrid grid;  ///< grid of all positions
  const Light* light = nullptr;
  IntegerFrame frame;  ///< unused for a sphere
  Region region;
  bool round = false;  ///< the light is the part of the region in the unit disk
  mpq_class area;      ///< of the region
  GridBox box;
  std::vector<SweepEdge<double>> edges;  ///< of the region
  std::optional<TextureColumns> texture;
  std::optional<TextureBlocks> blocks;  ///< of the same texture
};

namespace {

/// Region of the light above the horizon, with its possible occluders.
struct Question {
  const ExactAreaData& data;
  const Region& region;
  const OccluderEdges& occluders;
  FormFactorSum* form_factor;  ///< null: not requested
};

/// Returns the sweep's measure of the uncovered part; adds form factors during the sweep, if requested.
template <typename Number, typename Measure>
Number measure_uncovered(Measure measure, std::vector<SweepEdge<Number>>& edges, FormFactorSum* form_factor) {
  if (form_factor == nullptr) return AreaSweep<Number, Measure>(std::move(measure)).uncovered_area(edges);
  using Both = FormFactorMeasure<Number, Measure>;
  Number area = AreaSweep<Number, Both>(Both(std::move(measure), *form_factor)).uncovered_area(edges);
  form_factor->finish();
  return area;
}

/// Returns the visible fraction of the light's region, by area or by luminance. `edges`: the region's edges; also used
/// as workspace.
template <typename Number>
double share_left(const Question& question, std::vector<SweepEdge<Number>> edges, AreaWork& work) {
  const ExactAreaData& data = question.data;
  const std::size_t of_region = edges.size();
  question.occluders.append_to(edges);
  work = {question.occluders.triangles(), edges.size() - of_region};
  if (work.edges == 0 && &question.region == &data.region) {
    if (question.form_factor != nullptr) question.form_factor->add_whole();
    return 1;
  }
  if (data.texture) {
    const auto left = measure_uncovered<Number>(TextureMeasure<Number>(*data.texture), edges, question.form_factor);
    return std::clamp(mpq_class(mpq_class(left) / data.texture->integral()).get_d(), 0.0, 1.0);
  }
  FormFactorSum* form_factor = question.form_factor;
  if (work.edges == 0) {
    if (form_factor != nullptr) form_factor->add_whole();
    if (!data.round) return mpq_class(area_of(question.region) / data.area).get_d();
    form_factor = nullptr;
  }
  if (data.round) {
    const auto left = measure_uncovered<Number>(DiskMeasure<Number>(), edges, form_factor);
    return std::clamp(mpq_class(left).get_d() / std::numbers::pi, 0.0, 1.0);
  }
  const auto left = measure_uncovered<Number>(PlainMeasure<Number>(), edges, form_factor);
  return std::clamp(mpq_class(mpq_class(left) / data.area).get_d(), 0.0, 1.0);
}

}  // namespace

ExactArea::ExactArea(const SceneFloats& scene) : ExactArea(scene, TriangleTree()) {
  data_->own_tree = make_triangle_tree(scene);
  data_->scene.tree = &data_->own_tree;
}

ExactArea::ExactArea(const SceneFloats& scene, const TriangleTree& tree) : data_(std::make_unique<ExactAreaData>()) {
  data_->scene = welded(scene, tree);
  using Range = tbb::blocked_range<std::size_t>;
  data_->grid = tbb::parallel_reduce(
      Range(0, scene.positions.size(), 4096), IntegerGrid(),
      [&](const Range& range, IntegerGrid grid) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) grid.include(scene.positions[i]);
        return grid;
      },
      [](IntegerGrid a, const IntegerGrid& b) {
        a.include(b);
        return a;
      });
}

ExactArea::~ExactArea() = default;
ExactArea::ExactArea(ExactArea&&) noexcept = default;
ExactArea& ExactArea::operator=(ExactArea&&) noexcept = default;

void ExactArea::set_light(const Light& light) {
  data_->light = &light;
  if (!is_body(light.kind)) data_->frame = integer_frame(light, {});
  data_->region = light_region(light);
  data_->round = visibility::is_round(light.kind);
  data_->area = area_of(data_->region);
  data_->box = box_around(data_->region);
  data_->edges = region_edges<double>(data_->region);
  data_->texture.reset();
  data_->blocks.reset();
  if (!light.texture) return;
  data_->texture.emplace(*light.texture);
  data_->blocks.emplace(*light.texture);
}

double ExactArea::visibility(const Receiver& receiver, SweepArithmetic arithmetic, AreaWork* work) const {
  AreaWork ignored;
  return visible_share(receiver, arithmetic, work != nullptr ? *work : ignored, nullptr);
}

ExactView ExactArea::view(const Receiver& receiver, SweepArithmetic arithmetic) const {
  PENUMBRA_ASSERT(data_->light != nullptr, "set_light comes first");
  const visibility::UnshadowedLight seen(*data_->light, receiver.p, receiver.n);
  FormFactorSum form_factor(seen, data_->blocks);
  ExactView view;
  view.visibility = visible_share(receiver, arithmetic, view.work, &form_factor);
  if (static_cast<float>(view.visibility) == 1 && view.work.edges != 0) {  // occluders near the light hide none of it
    FormFactorSum whole(seen, data_->blocks);
    whole.add_whole();
    view.form_factor = whole.sum();
  } else {
    view.form_factor = glm::max(form_factor.sum(), glm::dvec3(0));
  }
  return view;
}

/// Returns whether the sun's only direction is visible, for a sun of one direction.
bool ExactArea::sees_direction(const Receiver& receiver) const {
  const Light& light = *data_->light;
  const SceneFloats& scene = *data_->scene.scene;
  return above_horizon(light, scene.corners(receiver.carrier), receiver.facing, light.center) &&
         !data_->scene.tree->any_along_ray(
             glm::dvec3(receiver.p), glm::dvec3(light.center), [&](std::uint32_t triangle) {
               return may_occlude(scene, light, receiver.carrier, triangle) &&
                      segment_meets_triangle(receiver.p, light.center, scene.corners(triangle), light).meets;
             });
}

double ExactArea::visible_share(const Receiver& receiver, SweepArithmetic arithmetic, AreaWork& work,
                                FormFactorSum* form_factor) const {
  PENUMBRA_ASSERT(data_->light != nullptr, "set_light comes first");
  const Light& light = *data_->light;
  work = {};
  if (!in_front_of_light(light, receiver.p)) return 0;
  if (light.sun && light.sun->tangent == 0) {
    const bool sees = sees_direction(receiver);
    if (sees && form_factor != nullptr) form_factor->add_whole();
    return sees ? 1 : 0;
  }
  const IntegerFrame frame = is_body(light.kind) ? integer_frame(light, receiver.p) : data_->frame;
  IntegerGrid grid = data_->grid;
  grid.include(frame.grid);
  grid.include(receiver.p);
  BackProjection projection(frame, grid, receiver.p);
  if (projection.on_plane()) return 0;

  // `whole`: the horizon does not cut the region. Most view samples see all of it.
  const HalfPlane above = projection.above_plane(data_->scene.scene->corners(receiver.carrier), receiver.facing);
  const bool whole = all_inside(data_->box, above);
  const Region cut = whole ? Region() : clip(data_->region, above);
  if (!whole && area_of(cut) <= 0) return 0;
  const Region& region = whole ? data_->region : cut;
  const GridBox box = whole ? data_->box : box_around(cut);
  projection.set_box(box);
  const LightShaft shaft(frame, projection.mirrored(), receiver.p, box);
  const OccluderEdges occluders(data_->scene, light, receiver, projection, shaft);
  const Question question{*data_, region, occluders, form_factor};
  if (arithmetic == SweepArithmetic::rational) return share_left(question, region_edges<mpq_class>(region), work);
  return share_left(question, whole ? data_->edges : region_edges<double>(region), work);
}

std::uint64_t ExactArea::memory_bytes() const {
  const TriangleTree& tree = data_->own_tree;
  return tree.nodes.size() * sizeof(TriangleTree::Node) + tree.leaves.size() * sizeof(TriangleTree::Leaf) +
         data_->scene.corner.size() * sizeof(std::uint32_t);
}

}  // namespace penumbra::areas
