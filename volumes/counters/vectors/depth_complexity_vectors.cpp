// SPDX-License-Identifier: Apache-2.0
// depth-complexity on a processor: edge-scatter's lists (VectorEdges), and a counter for each light sample.

#include "volumes/counters/vectors/depth_complexity_vectors.hpp"

#include "volumes/counters/vectors/count_samples.hpp"
#include "volumes/edges/vectors/vector_edges.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <array>
#include <chrono>
#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

class VectorDepthComplexity final : public VectorEdges {
 public:
  VectorDepthComplexity(visibility::MethodDescription given, Search search)
      : VectorEdges(std::move(given), "count edges", false), search_(search) {}

  void prepare_light(const visibility::Light& light) override {
    if (search_ != Search::hierarchy) {
      visibility::require_kind(light, visibility::kPlanarLights,
                               ": depth-complexity with search=kd-tree or hemicube supports only planar lights; "
                               "search=hierarchy supports every light");
    }
    structures_ = {};
    VectorEdges::prepare_light(light);
  }
  void prepare_view(const visibility::ViewSamples& samples) override {
    structures_ = {};
    VectorEdges::prepare_view(samples);
  }
  void evaluate(const visibility::Tile& tile) override {
    if (search_ != Search::hierarchy && !structures_[0]) build_structures();
    VectorEdges::evaluate(tile);
  }
  std::vector<visibility::PassTime> take_pass_times() override {
    std::vector<visibility::PassTime> times = VectorEdges::take_pass_times();
    if (search_ != Search::hierarchy) times.push_back({"search structure", std::exchange(build_milliseconds_, 0)});
    return times;
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    std::uint64_t bytes = VectorEdges::memory_bytes();
    for (const auto& structure : structures_) bytes += structure ? structure->bytes() : 0;
    return bytes;
  }

 private:
  /// Puts light samples into tiles, even if they are in rows.
  [[nodiscard]] GridShape grid_shape() const override {
    GridShape shape = VectorEdges::grid_shape();
    shape.rows = shape.columns = 0;
    return shape;
  }
  void do_occluded(const ClusterInput& input, OpenJudge& judge, std::span<SampleMask> masks) override {
    CountScratch& counting = counting_.local();
    if (search_ == Search::hierarchy) counting.candidates += input.edges.count * input.samples.size();
    count_samples(input, scratch_.local(), counting, judge, masks);
  }

  /// Builds a structure for each side of the light that has its own edges.
  void build_structures() {
    const auto begin = std::chrono::steady_clock::now();
    LightGrid back;
    back.side = -1;
    structures_[0].emplace(search_, input_for(grid()));
    if (light().two_sided) structures_[1].emplace(search_, input_for(back));
    build_milliseconds_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  }
  [[nodiscard]] EdgeSearchInput input_for(const LightGrid& side) const {
    return {scene(), light(), device_light(), edges_of(side), scale(), samples()};
  }
  const std::vector<std::uint32_t>& edge_roots(const LightGrid& grid,
                                               std::span<const GridSample> view_samples) override {
    if (search_ == Search::hierarchy) return VectorEdges::edge_roots(grid, view_samples);
    const EdgeSearch& structure = *structures_[grid.side < 0 ? 1 : 0];
    CountScratch& counting = counting_.local();
    counting.p.clear();
    counting.planes.clear();
    for (const GridSample& at : view_samples) {
      counting.p.push_back(samples().p[at.pixel]);
      counting.planes.push_back(at.plane);
      counting.candidates += structure.count(counting.p.back());
    }
    structure.find_leaves(counting.p, counting.planes, counting.leaves);
    return counting.leaves;
  }

  void count(std::map<std::string, std::uint64_t>& counters) override {
    VectorEdges::count(counters);
    for (CountScratch& counting : counting_) {
      counters["candidateEdges"] += std::exchange(counting.candidates, 0);
      counters["silhouettesCounted"] += std::exchange(counting.counted, 0);
    }
    if (!structures_[0]) return;
    counters["wedges"] = structures_[0]->wedge_count();
    counters["searchCells"] = structures_[0]->cell_count();
    counters["searchEntries"] = structures_[0]->entry_count();
  }

  Search search_;
  std::array<std::optional<EdgeSearch>, 2> structures_;  // for the light's front and back
  double build_milliseconds_ = 0;
  tbb::enumerable_thread_specific<CountScratch> counting_;
};

}  // namespace

std::unique_ptr<visibility::Method> make_depth_complexity_on_vectors(visibility::MethodDescription description,
                                                                     Search search) {
  return std::make_unique<VectorDepthComplexity>(std::move(description), search);
}

}  // namespace penumbra::volumes
