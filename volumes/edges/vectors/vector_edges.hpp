#pragma once

#include "engines/vectors/mask_method.hpp"
#include "volumes/edges/edge_sides.hpp"
#include "volumes/edges/light_window.hpp"
#include "volumes/edges/vectors/cut.hpp"
#include "volumes/edges/vectors/edge_scratch.hpp"
#include "volumes/edges/vectors/group.hpp"
#include "volumes/edges/vectors/scene_edges.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// Inside volumes/ only.
namespace penumbra::volumes {

/// A method of signed edges on a processor: finds each cluster's edges and triangles. The rest is vectors::MaskMethod.
class VectorEdges : public vectors::MaskMethod {
 public:
  /// `exact_area`: not of light samples but of the light.
  VectorEdges(visibility::MethodDescription given, std::string pass, bool exact_area)
      : MaskMethod(std::move(given), std::move(pass)), sides_(description().name), exact_area_(exact_area) {}

  void expect_frames() override;
  void prepare_mesh(const visibility::SceneFloats& scene) override;
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 private:
  bool prepare_casters() override;
  vectors::Blocks begin_region(const LightGrid& grid, const Cluster& all) override;
  void do_cluster(const LightGrid& grid, std::span<const GridSample> view_samples, OpenJudge& judge,
                  std::span<SampleMask> masks) final;
  struct Roots {
    const std::vector<std::uint32_t>&edges, &triangles;
  };
  /// Finds all edges of a cluster (of several view samples), unless to find those of each view sample alone is less
  /// work: then false.
  bool find_edges_together(const LightGrid& grid, std::span<const GridSample> view_samples, const Cluster& cluster,
                           const Roots& roots);
  void do_each_alone(const LightGrid& grid, std::span<const GridSample> view_samples, const Cluster& cluster,
                     const Roots& roots, OpenJudge& judge, std::span<SampleMask> masks);
  void do_list(const LightGrid& grid, std::span<const GridSample> view_samples, const Cluster& cluster,
               OpenJudge& judge, std::span<SampleMask> masks);
  /// Edges that cross neither a row of light samples nor the light's left side change nothing.
  [[nodiscard]] bool skips_gaps(const LightGrid& grid) const { return !exact_area_ && !grid.tiles; }
  [[nodiscard]] static bool at_disk(const LightGrid& grid) { return grid.cones && grid.cones->near != nullptr; }
  [[nodiscard]] const CutEdges& cut_edges(const LightGrid& grid) const {
    return grid.side < 0 && !back_.tree().nodes.empty() ? back_ : *front_;
  }

  /// View samples with nothing between them and the light. Here: all light samples above the horizon are visible.
  virtual void do_unoccluded(const LightGrid& grid, std::span<const GridSample> view_samples, OpenJudge& judge,
                             std::span<SampleMask> masks);
  virtual void do_occluded(const ClusterInput& input, OpenJudge& judge, std::span<SampleMask> masks) = 0;

  visibility::LightTouch touch_;
  EdgeSides sides_;
  SceneEdges whole_;
  struct WithoutBody {
    std::int32_t light;
    CutEdges edges;
  };
  /// What casts shadow of the last light whose body is grown together with other casters.
  std::optional<WithoutBody> without_body_;
  CutEdges* front_ = &whole_.edges();  // one of these
  CutEdges back_;                      // a copy, where the light's plane cuts and it emits to both sides

 protected:
  /// Where the walk for a cluster's edges begins: subtrees that hold all that may matter to it.
  virtual const std::vector<std::uint32_t>& edge_roots(const LightGrid& grid, std::span<const GridSample> view_samples);
  /// As the grid's side of the light has them.
  [[nodiscard]] const WideEdgeTree& edges_of(const LightGrid& grid) const { return cut_edges(grid).tree(); }
  void count(std::map<std::string, std::uint64_t>& counters) override;

  LightWindow window_;  // of the light that is being prepared
  tbb::enumerable_thread_specific<EdgeScratch> scratch_;

 private:
  bool exact_area_;
};

}  // namespace penumbra::volumes
