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

/// How large the blocks of pixels are whose clusters have lists.
enum class Blocks : std::uint8_t {
  usual,
  small,  ///< where casters are so dense that neighbours see other edges
};

/// A method on all of the processor's cores, one region of pixels after the other, each from its lists to its bits in
/// one go. All methods share what comes before and after the lists.
class MaskMethod : public visibility::Method {
 public:
  /// `pass`: the name of its one stage in the pass times.
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
  /// openPixels, openPairs (left to exact predicates) and what count() was told.
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  std::map<std::string, std::uint64_t> take_mesh_counters() override { return std::exchange(mesh_counters_, {}); }
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 protected:
  /// The two halves of prepare_mesh: tree(), then triangles().
  void prepare_tree(const visibility::SceneFloats& scene);
  void prepare_triangles();
  /// Called once for each region, before its clusters and on the same thread. Returns how large the region's blocks
  /// are.
  virtual Blocks begin_region(const LightGrid& grid, const Cluster& all) = 0;
  /// All view samples of a cluster. Sets how many light samples are visible from each and, unless none or all are,
  /// which.
  virtual void do_cluster(const LightGrid& grid, std::span<const GridSample> samples, OpenJudge& judge,
                          std::span<SampleMask> masks) = 0;
  /// A view sample within rounding of the light's plane: true if the method has decided it by itself; false if exact
  /// predicates are to decide each of its light samples.
  virtual bool decide_open(const GridSample&) { return false; }
  /// Returns whether triangles are cut at the light's plane, which makes error bounds larger.
  virtual bool prepare_casters() = 0;
  /// The grid of cells that the light is looked at in.
  struct GridShape {
    visibility::DeviceLight frame;
    bool is_rectangle = true;             ///< LightGridInput
    std::uint32_t rows = 0, columns = 0;  ///< likewise
    std::optional<LightGridInput::Window> window = {};
    float reach = 1;  ///< times that of scene and frame
  };
  /// A cell a light sample where these are in rows; else tiles of them.
  [[nodiscard]] virtual GridShape grid_shape() const;
  /// Of a sphere or sun.
  [[nodiscard]] virtual bool asks_for_light_samples() const { return true; }
  /// Of a sphere: ConeOptions.
  [[nodiscard]] virtual bool cuts_casters() const { return false; }
  /// Runs do_cluster again for the tile last evaluated, for a result that was not asked for the first time. Counters
  /// stay.
  void repeat();
  /// Something that is made for a mesh was made, or has followed the mesh before.
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
  /// Of the light's front.
  [[nodiscard]] const LightGrid& grid() const { return grids_.front(); }
  /// How many light samples each pixel of the tile sees.
  [[nodiscard]] std::span<const std::uint32_t> visible_samples() const { return visible_; }
  /// Of the tile.
  [[nodiscard]] std::size_t first_pixel() const { return std::size_t{tile_.first_row} * samples_->width; }
  [[nodiscard]] std::size_t tile_pixel(const GridSample& at) const { return at.pixel - first_pixel(); }

 private:
  struct Buffers;
  struct AllBuffers;
  /// Those of this thread.
  [[nodiscard]] Buffers& buffers() const;
  /// Lets the last mesh's hierarchy follow. False: it does not fit this one, or not well.
  bool refit_tree();
  void do_tile();
  /// What this thread turns to view samples of a sphere or sun.
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
  double built_cost_ = 0;  // visibility::tree_cost when it was built, where frames are expected
  WideTriangleTree triangles_;
  KnownNormals normals_;
  const visibility::Light* light_ = nullptr;
  visibility::DeviceLight device_light_;
  std::vector<LightGrid> grids_;    // one a side that it emits to
  std::optional<ConeLight> cone_;   // of a sphere or sun
  std::uint64_t light_number_ = 0;  // of all that were prepared
  std::unique_ptr<AllBuffers> buffers_;
  const visibility::ViewSamples* samples_ = nullptr;
  visibility::Tile tile_;
  UnsetList<std::uint16_t> masks_;  // of the tile; set where some light samples are visible and some are not
  std::vector<std::uint32_t> visible_;
  std::atomic<std::uint64_t> open_pixels_ = 0, open_pairs_ = 0;
  double milliseconds_ = 0;
  std::map<std::string, std::uint64_t> counters_, mesh_counters_;
};

}  // namespace penumbra::vectors
