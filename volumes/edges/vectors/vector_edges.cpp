// SPDX-License-Identifier: Apache-2.0
// Lists of edges and triangles for regions and clusters of view samples, by traversals of their hierarchies.

#include "volumes/edges/vectors/vector_edges.hpp"

#include "engines/vectors/horizon.hpp"

#include <limits>
#include <utility>

namespace penumbra::volumes {
namespace {

/// Number of leaves of triangles between a region and the light's corner above which neighbouring pixels see different
/// edges.
constexpr std::size_t kDense = 1024;
constexpr std::size_t kEdgeGroup = 16, kDenseEdgeGroup = 8;  // view samples in a group
constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

/// Returns the number of edges that a cluster of `samples` may list before a traversal for each view sample, which
/// visits about `leaves` leaves of edges, is cheaper. Measured: an edge takes 65 cycles to list and 1.5 for each view
/// sample; a traversal 8,000, and 200 for each leaf and its ancestors.
std::size_t worth_of(std::size_t samples, std::size_t leaves) {
  return samples * (16000 + 400 * leaves) / (130 + 3 * samples);
}

}  // namespace

void VectorEdges::expect_frames() {
  MaskMethod::expect_frames();
  whole_.expect_frames();
}

void VectorEdges::prepare_mesh(const visibility::SceneFloats& scene) {
  prepare_tree(scene);
  sides_.prepare_mesh(scene);
  const SceneEdges::Made made = whole_.make({scene, tree(), sides_.casters(), scale()});
  if (made == SceneEdges::Made::built) count_for_mesh("edgesBuilt");
  count_for_mesh(made == SceneEdges::Made::refit ? "edgesRefit" : "edgeTreesBuilt");
  prepare_triangles();  // made after the edges, which temporarily take the most memory
  without_body_.reset();
  front_ = &whole_.edges();
}

std::uint64_t VectorEdges::memory_bytes() const {
  return MaskMethod::memory_bytes() + whole_.memory_bytes() + bytes_of(back_.tree()) +
         (without_body_ ? bytes_of(without_body_->edges.tree()) : 0);
}

bool VectorEdges::prepare_casters() {
  LightEdges edges = sides_.prepare_light(light(), device_light(), scale());
  front_->restore();
  const auto of_body = edges.has_body ? whole_.of_body(light().index) : std::span<const EdgeSlot>();
  if (!of_body && !(without_body_ && without_body_->light == light().index)) {
    without_body_ = {light().index, CutEdges(wide_edges(sides_.records(), tree(), scale()))};
  }
  front_ = of_body ? &whole_.edges() : &without_body_->edges;
  back_ = edges.back ? CutEdges(front_->tree()) : CutEdges();
  const std::int32_t without = edges.has_body ? light().index : -1;
  for (auto* side : {&edges.front, &edges.back}) {
    if (*side) (*side)->window = window_;
  }
  const std::span<const EdgeSlot> left_out = of_body.value_or(std::span<const EdgeSlot>());
  if (edges.back) back_.cut({scene(), tree(), sides_.casters(), without, *edges.back, exact_area_}, left_out);
  if (edges.front)
    front_->cut({scene(), tree(), sides_.casters(), without, *edges.front, exact_area_}, left_out);
  else
    front_->leave_out(left_out);
  touch_ = exact_area_ || !visibility::is_planar(light().kind) ? visibility::LightTouch()
                                                               : visibility::find_touch(scene(), tree(), light());
  return edges.front.has_value() && !exact_area_;  // for an exact area, cuts do not round the stored ends
}

vectors::Blocks VectorEdges::begin_region(const LightGrid& grid, const Cluster& all) {
  EdgeScratch& scratch = scratch_.local();
  find_edge_roots({grid, edges_of(grid), all}, scratch.edges, scratch.walk.edge_roots);
  find_triangle_roots({grid, triangles(), all, all.corner}, scratch.triangles, scratch.walk.triangle_roots);
  scratch.walk.dense = count_leaves({grid, triangles(), all, all.corner}, scratch.walk.triangle_roots,
                                    scratch.walk.stack, kDense) == kDense;
  scratch.walk.dense_regions += scratch.walk.dense ? 1 : 0;
  scratch.walk.alone = false;
  return scratch.walk.dense ? vectors::Blocks::small : vectors::Blocks::usual;
}

void VectorEdges::do_cluster(const LightGrid& grid, std::span<const GridSample> view_samples, OpenJudge& judge,
                             std::span<SampleMask> masks) {
  EdgeScratch& scratch = scratch_.local();
  const Roots roots{edge_roots(grid, view_samples), scratch.walk.triangle_roots};
  if (roots.edges.empty() && roots.triangles.empty() && !at_disk(grid))
    return do_unoccluded(grid, view_samples, judge, masks);
  const Cluster cluster = make_cluster(grid, view_samples);
  if (!find_edges_together(grid, view_samples, cluster, roots))
    return do_each_alone(grid, view_samples, cluster, roots, judge, masks);
  find_triangles({grid, triangles(), cluster, cluster.corner}, roots.triangles, scratch.walk.stack, scratch.triangles);
  scratch.samples.clear();
  if (scratch.edges.count + scratch.triangles.count > 0 || at_disk(grid)) {
    for (const GridSample& at : view_samples) scratch.samples.push_back(complete(grid, cluster, at));
  }
  do_list(grid, view_samples, cluster, judge, masks);
}

bool VectorEdges::find_edges_together(const LightGrid& grid, std::span<const GridSample> view_samples,
                                      const Cluster& cluster, const Roots& roots) {
  EdgeScratch& scratch = scratch_.local();
  const EdgeInput input{grid, edges_of(grid), cluster};
  scratch.walk.stack = roots.edges;
  scratch.edges.count = 0;
  const std::size_t count = view_samples.size();
  if (find_more_edges(input, scratch.walk.stack, scratch.edges, count > 1 ? worth_of(count, 0) : kAll)) return true;
  if (scratch.walk.alone) return false;
  const auto middle = view_samples.subspan(count / 2, 1);
  const Cluster one = make_cluster(grid, middle);
  const ClusterSample at = complete(grid, one, middle[0]);
  const std::size_t leaves = count_edge_leaves({grid, input.tree, one, skips_gaps(grid) ? &at : nullptr}, roots.edges,
                                               scratch.walk.probe_stack);
  if (find_more_edges(input, scratch.walk.stack, scratch.edges, worth_of(count, leaves))) return true;
  scratch.walk.alone = true;
  return false;
}

void VectorEdges::do_each_alone(const LightGrid& grid, std::span<const GridSample> view_samples, const Cluster& cluster,
                                const Roots& roots, OpenJudge& judge, std::span<SampleMask> masks) {
  EdgeScratch& scratch = scratch_.local();
  scratch.walk.alone_samples += view_samples.size();
  scratch.walk.narrow_edge_roots = roots.edges;
  scratch.walk.narrow_triangle_roots = roots.triangles;
  narrow_edge_roots({grid, edges_of(grid), cluster}, scratch.walk.narrow_edge_roots);
  narrow_triangle_roots({grid, triangles(), cluster, cluster.corner}, scratch.walk.narrow_triangle_roots);
  for (std::size_t i = 0; i < view_samples.size(); ++i) {
    const auto one = view_samples.subspan(i, 1);
    const Cluster own = make_cluster(grid, one);
    scratch.samples.clear();
    scratch.samples.push_back(complete(grid, own, one[0]));
    const ClusterSample* at = skips_gaps(grid) ? scratch.samples.data() : nullptr;
    find_edges({grid, edges_of(grid), own, at}, scratch.walk.narrow_edge_roots, scratch.walk.stack, scratch.edges);
    find_triangles({grid, triangles(), own, own.corner}, scratch.walk.narrow_triangle_roots, scratch.walk.stack,
                   scratch.triangles);
    do_list(grid, one, own, judge, masks.subspan(i, 1));
  }
}

void VectorEdges::do_list(const LightGrid& grid, std::span<const GridSample> view_samples, const Cluster& cluster,
                          OpenJudge& judge, std::span<SampleMask> masks) {
  EdgeScratch& scratch = scratch_.local();
  scratch.walk.listed += scratch.edges.count;
  if (scratch.edges.count + scratch.triangles.count == 0 && !at_disk(grid))
    return do_unoccluded(grid, view_samples, judge, masks);
  do_occluded({grid, touch_, edges_of(grid), triangles(), cluster, scratch.samples, scratch.edges, scratch.triangles,
               scratch.walk.dense ? kDenseEdgeGroup : kEdgeGroup, exact_area_, cut_edges(grid).ends(),
               front_->plane_of_light()},
              judge, masks);
}

const std::vector<std::uint32_t>& VectorEdges::edge_roots(const LightGrid&, std::span<const GridSample>) {
  return scratch_.local().walk.edge_roots;
}

void VectorEdges::do_unoccluded(const LightGrid& grid, std::span<const GridSample> view_samples, OpenJudge& judge,
                                std::span<SampleMask> masks) {
  Open& open = scratch_.local().open;
  for (std::size_t i = 0; i < view_samples.size(); ++i) {
    reset_open(grid, touch_, view_samples[i], open);
    see_all(grid, view_samples[i], open, judge, masks[i]);
  }
}

void VectorEdges::count(std::map<std::string, std::uint64_t>& counters) {
  if (!touch_.samples.empty()) counters["touchedSamples"] = touch_.samples.size();
  for (EdgeScratch& scratch : scratch_) {
    counters["listedEdges"] += std::exchange(scratch.walk.listed, 0);
    counters["samplesAlone"] += std::exchange(scratch.walk.alone_samples, 0);
    counters["denseRegions"] += std::exchange(scratch.walk.dense_regions, 0);
  }
}

}  // namespace penumbra::volumes
