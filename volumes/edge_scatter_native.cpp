// Edge scatter on a processor: its lists and what becomes of them. The rest is native::MaskMethod.

#include "volumes/edge_scatter_native.hpp"

#include "native/horizon.hpp"
#include "native/mask_method.hpp"
#include "volumes/edge_sides.hpp"
#include "volumes/native_scatter.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

class NativeEdgeScatter final : public native::MaskMethod {
 public:
  explicit NativeEdgeScatter(visibility::MethodDescription given)
      : MaskMethod(std::move(given), "scatter edges"), sides_(description().name) {}

  void prepare_mesh(const visibility::SceneFloats& scene) override {
    MaskMethod::prepare_mesh(scene);
    whole_ = wide_edges(sides_.prepare_mesh(scene));
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    return MaskMethod::memory_bytes() + bytes_of(whole_) + (front_ ? bytes_of(*front_) : 0) +
           (back_ ? bytes_of(*back_) : 0);
  }

 private:
  bool prepare_casters() override {
    const SidedRecords records = sides_.prepare_light(light(), light_frame(), scale());
    front_.reset();
    back_.reset();
    if (records.front) front_ = wide_edges(*records.front);
    if (records.back) back_ = wide_edges(*records.back);
    return records.cut;
  }
  [[nodiscard]] WideEdgeTree wide_edges(const std::vector<EdgeRecord>& records) const {
    const EdgeTexels texels = edge_texels(records, scale());
    return texels.depth == 0 ? WideEdgeTree{} : wide_edge_tree(texels.nodes, texels.slots);
  }
  [[nodiscard]] const WideEdgeTree& edges_of(const Frame& frame) const {
    return frame.side < 0 && back_ ? *back_ : front_ ? *front_ : whole_;
  }

  void begin_region(const Frame& frame, const Cluster& all) override {
    find_roots({frame, edges_of(frame), triangles(), all}, scratch_.local().roots);
  }

  void do_cluster(const Frame& frame, std::span<const Placed> placed, Judge& judge, std::span<Seen> seen) override {
    Scratch& scratch = scratch_.local();
    scratch.edges.count = scratch.triangles.count = 0;
    Cluster cluster;
    if (!scratch.roots.edges.empty() || !scratch.roots.triangles.empty()) {
      cluster = make_cluster(frame, placed);
      find({frame, edges_of(frame), triangles(), cluster}, scratch.roots, scratch.stack, scratch.edges,
           scratch.triangles);
      scratch.listed += scratch.edges.count;
    }
    if (scratch.edges.count + scratch.triangles.count == 0) {
      for (std::size_t i = 0; i < placed.size(); ++i) see_all(frame, placed[i], scratch.open, judge, seen[i]);
      return;
    }
    scratch.samples.clear();
    for (const Placed& at : placed) scratch.samples.push_back(complete(frame, cluster, at));
    scatter({frame, triangles(), cluster, scratch.samples, scratch.edges, scratch.triangles}, scratch, judge, seen);
  }

  void count(std::map<std::string, std::uint64_t>& counters) override {
    for (Scratch& scratch : scratch_) counters["listedEdges"] += std::exchange(scratch.listed, 0);
  }

  EdgeSides sides_;
  WideEdgeTree whole_;
  std::optional<WideEdgeTree> front_, back_;  // where `whole_` will not do
  tbb::enumerable_thread_specific<Scratch> scratch_;
};

}  // namespace

std::unique_ptr<visibility::Method> make_native_edge_scatter(visibility::MethodDescription description) {
  return std::make_unique<NativeEdgeScatter>(std::move(description));
}

}  // namespace penumbra::volumes
