// SPDX-License-Identifier: Apache-2.0
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

/// A method with signed edges on a processor: finds each cluster's edges and triangles. vectors::MaskMethod does the
/// rest.
class VectorEdges : public vectors::MaskMethod {
 public:
  /// `exact_area`: computes an area of the light instead of light samples.
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
  /// Finds all edges of a cluster of several view samples. Returns false if a search for each view sample is cheaper.
  bool find_edges_together(const LightGrid& grid, std::span<const GridSample> view_samples, const Cluster& cluster,
                           const Roots& roots);
  void do_each_alone(const LightGrid& grid, std::span<const GridSample> view_samples, const Cluster& cluster,
                     const Roots& roots, OpenJudge& judge, std::span<SampleMask> masks);
  void do_list(const LightGrid& grid, std::span<const GridSample> view_samples, const Cluster& cluster,
               OpenJudge& judge, std::span<SampleMask> masks);
  /// Returns whether edges that cross neither a row of light samples nor the light's left side can be skipped.
  [[nodiscard]] bool skips_gaps(const LightGrid& grid) const { return !exact_area_ && !grid.tiles; }
  [[nodiscard]] static bool at_disk(const LightGrid& grid) { return grid.cones && grid.cones->near != nullptr; }
  [[nodiscard]] const CutEdges& cut_edges(const LightGrid& grid) const {
    return grid.side < 0 && !back_.tree().nodes.empty() ? back_ : *front_;
  }

  /// Handles view samples with no caster between them and the light. Default: all light samples above the horizon are
  /// visible.
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
  /// Casters of the last light whose body shares edges or planes with other casters.
  std::optional<WithoutBody> without_body_;
  CutEdges* front_ = &whole_.edges();  // the edges of whole_ or without_body_
  CutEdges back_;                      // a copy of *front_, if the light's plane cuts edges and the light emits to both
                                       // sides

 protected:
  /// Returns the roots of the traversal for a cluster's edges: subtrees that contain all edges that may affect it.
  virtual const std::vector<std::uint32_t>& edge_roots(const LightGrid& grid, std::span<const GridSample> view_samples);
  /// Returns the edges for the grid's side of the light.
  [[nodiscard]] const WideEdgeTree& edges_of(const LightGrid& grid) const { return cut_edges(grid).tree(); }
  void count(std::map<std::string, std::uint64_t>& counters) override;

  LightWindow window_;  // window of the light that is being prepared
  tbb::enumerable_thread_specific<EdgeScratch> scratch_;

 private:
  bool exact_area_;
};

}  // namespace penumbra::volumes
