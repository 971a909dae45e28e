// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/pages.hpp"
#include "engines/vectors/clusters.hpp"
#include "engines/vectors/cone_light.hpp"
#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/masks.hpp"
#include "engines/vectors/trees.hpp"
#include "visibility/method.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::vectors {

/// Size of the blocks of pixels whose clusters share lists.
enum class Blocks : std::uint8_t {
  usual,
  small,  ///< for casters so dense that neighbours see different edges
};

/// Base class of methods that run on all of the processor's cores: each region of pixels is processed from its lists to
/// its bits in one pass. Implements the steps before and after the lists for all such methods.
class MaskMethod : public visibility::Method {
 public:
  /// `pass`: name of its single stage in the pass times.
  MaskMethod(visibility::MethodDescription description, std::string pass);
  ~MaskMethod() override;

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void expect_frames() override { expects_frames_ = true; }
  void prepare_mesh(const visibility::SceneFloats& scene) override;
  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override { samples_ = &samples; }
  [[nodiscard]] std::uint32_t max_tile_rows() const override;
  void evaluate(const visibility::Tile& tile) override;
  void read_masks(std::span<std::uint32_t> masks) override;
  void read_visibility(std::span<float> visibility) override;
  std::vector<visibility::PassTime> take_pass_times() override;
  /// Returns openPixels, openPairs (left to exact predicates) and the counters added by count().
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  std::map<std::string, std::uint64_t> take_mesh_counters() override { return std::exchange(mesh_counters_, {}); }
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 protected:
  /// The two halves of prepare_mesh: tree(), then triangles().
  void prepare_tree(const visibility::SceneFloats& scene);
  void prepare_triangles();
  /// Called once for each region, before its clusters and on the same thread. Returns the size of the region's blocks.
  virtual Blocks begin_region(const LightGrid& grid, const Cluster& all) = 0;
  /// Computes all view samples of a cluster: sets the number of light samples visible from each and, unless none or all
  /// are, their bits.
  virtual void do_cluster(const LightGrid& grid, std::span<const GridSample> samples, OpenJudge& judge,
                          std::span<SampleMask> masks) = 0;
  /// Called for a view sample within rounding of the light's plane. Returns true if the method has decided it; false if
  /// exact predicates must decide each of its light samples.
  virtual bool decide_open(const GridSample&) { return false; }
  /// Returns whether triangles are cut at the light's plane, which makes error bounds larger.
  virtual bool prepare_casters() = 0;
  /// Shape of the grid of cells.
  struct GridShape {
    visibility::DeviceLight frame;
    bool is_rectangle = true;             ///< as in LightGridInput
    std::uint32_t rows = 0, columns = 0;  ///< as in LightGridInput
    std::optional<LightGridInput::Window> window = {};
    float reach = 1;  ///< factor on the reach of scene and frame
  };
  /// Returns a grid with a cell for each light sample if these are in rows; else with tiles of them.
  [[nodiscard]] virtual GridShape grid_shape() const;
  /// Returns whether the method uses the light samples of a sphere or sun.
  [[nodiscard]] virtual bool asks_for_light_samples() const { return true; }
  /// Returns ConeOptions::cuts_casters for a sphere.
  [[nodiscard]] virtual bool cuts_casters() const { return false; }
  /// Runs do_cluster again for the tile evaluated last, for a result that was not requested the first time. Counters do
  /// not change.
  void repeat();
  /// Counts that a structure of the mesh was made, or was updated from the previous mesh.
  void count_for_mesh(const char* name) { ++mesh_counters_[name]; }
  /// Adds to the counters after a tile.
  virtual void count(std::map<std::string, std::uint64_t>& counters) = 0;

  [[nodiscard]] const visibility::SceneFloats& scene() const { return *scene_; }
  [[nodiscard]] const visibility::Light& light() const { return *light_; }
  [[nodiscard]] const visibility::DeviceLight& device_light() const { return device_light_; }
  [[nodiscard]] const visibility::TriangleTree& tree() const { return tree_; }
  [[nodiscard]] WideTriangleTree& triangles() { return triangles_; }
  [[nodiscard]] const WideTriangleTree& triangles() const { return triangles_; }
  [[nodiscard]] const visibility::ViewSamples& samples() const { return *samples_; }
  [[nodiscard]] float scale() const { return scale_; }
  /// Returns the grid of the light's front.
  [[nodiscard]] const LightGrid& grid() const { return grids_.front(); }
  /// Returns the number of light samples visible from each pixel of the tile.
  [[nodiscard]] std::span<const std::uint32_t> visible_samples() const { return visible_; }
  /// Returns the index of the tile's first pixel in the view samples.
  [[nodiscard]] std::size_t first_pixel() const { return std::size_t{tile_.first_row} * samples_->width; }
  [[nodiscard]] std::size_t tile_pixel(const GridSample& at) const { return at.pixel - first_pixel(); }

 private:
  struct Buffers;
  struct AllBuffers;
  /// Returns the buffers of this thread.
  [[nodiscard]] Buffers& buffers() const;
  /// Updates the previous mesh's hierarchy to this mesh. Returns false if it does not fit this one, or not well.
  bool refit_tree();
  void do_tile();
  /// Returns this thread's grid, oriented toward view samples of a sphere or sun.
  [[nodiscard]] LightGrid& turned_grid() const;
  void do_region(const LightGrid& grid, std::uint32_t left, std::uint32_t top);
  Blocks enter_region(const LightGrid& grid, std::span<GridSample> samples);
  void do_block(const LightGrid& grid, std::span<GridSample> block, OpenJudge& judge);
  void do_turned(std::span<const GridSample> samples, OpenJudge& judge, std::span<SampleMask> masks);
  void decide_all(const GridSample& sample, OpenJudge& judge);
  [[nodiscard]] std::uint16_t* mask_of(const GridSample& at) { return &masks_[tile_pixel(at) * mask_words(grids_[0])]; }

  visibility::MethodDescription description_;
  std::string pass_;
  const visibility::SceneFloats* scene_ = nullptr;
  float scale_ = 1;
  bool expects_frames_ = false;
  visibility::TriangleTree tree_;
  double built_cost_ = 0;  // visibility::tree_cost when the hierarchy was built, if more frames are expected
  WideTriangleTree triangles_;
  KnownNormals normals_;
  const visibility::Light* light_ = nullptr;
  visibility::DeviceLight device_light_;
  std::vector<LightGrid> grids_;    // one for each emitting side
  std::optional<ConeLight> cone_;   // for a sphere or sun
  std::uint64_t light_number_ = 0;  // counts all prepared lights
  std::unique_ptr<AllBuffers> buffers_;
  const visibility::ViewSamples* samples_ = nullptr;
  visibility::Tile tile_;
  UnsetList<std::uint16_t> masks_;  // masks of the tile; set for pixels with some, but not all, light samples visible
  std::vector<std::uint32_t> visible_;
  std::atomic<std::uint64_t> open_pixels_ = 0, open_pairs_ = 0;
  double milliseconds_ = 0;
  std::map<std::string, std::uint64_t> counters_, mesh_counters_;
};

}  // namespace penumbra::vectors
