// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/assert.hpp"
#include "base/error.hpp"
#include "maps/host/aliasing.hpp"
#include "maps/host/camera_faces.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/receivers.hpp"
#include "render/compute_pass.hpp"
#include "visibility/all_triangles.hpp"
#include "visibility/changed_defaults.hpp"
#include "visibility/lights/light_parts.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// Class of methods made from a recipe. Included by map_method.cpp and map_look_ups.cpp only.
namespace penumbra::maps {

/// A method of maps from a recipe: maps of the current light, made when it is prepared or when there are view samples.
class MapMethod final : public visibility::Method,
                        public visibility::PassesTriangles,
                        public visibility::ChangesDefaults,
                        public SeesScene {
 public:
  MapMethod(const render::Device& device, MapRecipe recipe, const MapOptions& options)
      : device_(&device),
        recipe_(std::move(recipe)),
        options_(options),
        casters_(device, options.size, options.rasteriser),
        constants_(constants_for(1)),
        look_up_(make_look_up()),
        sort_(make_sort()) {
    PENUMBRA_ASSERT(!options_.fit.sees_camera() || recipe_.points == MapPoints::centre,
                    "{}: only maps from centres are fitted to a camera", recipe_.description.name);
    PENUMBRA_ASSERT(!options_.fit.has_faces() || recipe_.sub_lights == 1, "{}: maps of sub-lights are windows",
                    recipe_.description.name);
    if (const std::uint32_t least = 2 * recipe_.beside_texels + 4; options_.fit.has_faces() && options_.size < least) {
      throw UsageError(
          "method {}: size={} leaves no room for the taps outside of a map's borders; take size={} or more",
          recipe_.description.name, options_.size, least);
    }
    casters_.set_offset(options_.offset_factor, options_.offset_units);
    if (options_.depth != DepthUse::first) recipe_.layers.count = std::max(recipe_.layers.count, 2u);
    PENUMBRA_ASSERT(recipe_.points == MapPoints::centre || total_layers() == 1, "{}: layers of a light sample's map",
                    recipe_.description.name);
    PENUMBRA_ASSERT(recipe_.sub_lights == 1 || (recipe_.points == MapPoints::centre && !gives_masks()),
                    "{}: means over sub-lights are V, from maps of their centres", recipe_.description.name);
  }

  [[nodiscard]] const visibility::MethodDescription& description() const override { return recipe_.description; }
  void want_pixels(std::span<const std::uint32_t> pixels) override { receivers_.want(pixels); }
  void pass(const visibility::AllTriangles* all) override { all_ = all; }
  void see_through(const SceneSpace& space) override { space_ = space; }
  void prepare_mesh(const visibility::SceneFloats& scene) override;
  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override;
  [[nodiscard]] std::uint32_t max_tile_rows() const override;
  void evaluate(const visibility::Tile& tile) override;
  void read_masks(std::span<std::uint32_t> masks) override;
  void read_visibility(std::span<float> visibility) override;

  std::vector<visibility::PassTime> take_pass_times() override { return times_.take(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override;
  [[nodiscard]] visibility::MethodOptions changed_defaults() const override { return recipe_.changed_defaults; }
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 private:
  [[nodiscard]] bool gives_masks() const { return recipe_.description.output == visibility::Output::mask; }
  /// Returns the number of result words of a pixel: its mask, or V.
  [[nodiscard]] std::uint32_t words_per_pixel() const { return gives_masks() ? light_->words_per_mask() : 1; }
  [[nodiscard]] bool sorts_out() const { return !recipe_.sort_out.empty(); }
  /// Returns the size in bytes of the results of `pixels` pixels. Workgroups that loop need two more words a pixel,
  /// which mark workgroups whose loops were ended, for this pass and the next, and CutLoops; a list of workgroups needs
  /// one more word a pixel, and GroupList.
  [[nodiscard]] std::uint64_t result_bytes(std::uint64_t pixels) const {
    if (!recipe_.group_a_receiver) return pixels * words_per_pixel() * sizeof(std::uint32_t);
    const std::uint64_t words = words_per_pixel() + (sorts_out() ? 3 : 2);
    return pixels * words * sizeof(std::uint32_t) + (sorts_out() ? sizeof(gpu::GroupList) : 0) + sizeof(gpu::CutLoops);
  }
  /// Returns the number of light points whose maps are looked up one after the other for the same bits or V.
  [[nodiscard]] std::uint32_t point_count() const {
    return recipe_.points == MapPoints::centre ? 1 : static_cast<std::uint32_t>(fitted_.views.size());
  }
  /// Returns the basis of a part of the light: the axes of the whole light, used by maps and look-ups, around the
  /// part's centroid.
  [[nodiscard]] LightBasis basis_of(const visibility::Light& part) const {
    LightBasis basis = basis_;
    basis.center = visibility::center_of(part);
    return basis;
  }
  [[nodiscard]] std::uint32_t total_layers() const { return recipe_.layers.count + (recipe_.layers.farthest ? 1 : 0); }

  /// Returns the specialization constants of the look-up, for a light whose maps have `faces` faces (most have one).
  [[nodiscard]] std::vector<std::uint32_t> constants_for(std::uint32_t faces) const;
  [[nodiscard]] render::ComputePass make_look_up() const;
  [[nodiscard]] std::optional<render::ComputePass> make_sort() const;

  /// Returns the number of workgroups for packets of pixels.
  [[nodiscard]] std::uint64_t packets(const Receivers::Part& part) const {
    const std::uint32_t width = std::max(receivers_.width(), 1U), rows = part.count / width;
    return std::uint64_t{(width + recipe_.packet_width - 1) / recipe_.packet_width} *
           ((rows + recipe_.packet_height - 1) / recipe_.packet_height);
  }

  /// Fits the maps: to all receivers, or to the view of the camera.
  void fit_maps();
  void fit_to_camera(FitOptions fit, std::span<const glm::vec3> centres);
  void make_maps();
  /// Allocates the light's maps, and renders those of its centre.
  void make_fitted_maps();
  /// Cuts the fitted faces while a cut changes the picture.
  void query_tiles();
  [[nodiscard]] std::vector<float> whole_picture();
  void take_tile(const visibility::Tile& tile);
  void find_aliasing();
  /// Records maps of light points first … first + count − 1, in submissions that can be timed.
  void render_maps(render::Commands& commands, std::uint32_t first, std::uint32_t count);
  /// Records the layers behind the nearest surfaces in the maps of the centre of a part of the light.
  void render_layers(render::Commands& commands, std::uint32_t part);
  /// Renders the maps of the centre of a part of the light, and makes the products.
  void make_centre_maps(std::uint32_t part);
  /// Computes V of a tile from the maps of the light's parts, one after the other.
  void add_up_parts(const visibility::Tile& tile);
  /// Runs all look-ups, and repeats workgroups whose loops were ended by the device, with fewer rows of a map at a
  /// time.
  void ask_all(const visibility::Tile& tile);
  /// Returns the push constants of look-ups of a part of a tile, without the range of rows.
  [[nodiscard]] gpu::LookupPush push_of(const Receivers::Part& part, std::uint32_t first, std::uint32_t count) const;
  [[nodiscard]] std::vector<render::BufferReference> buffers_of(const Receivers::Part& part) const;
  /// Runs the sorting pass, which excludes workgroups of a tile that have nothing to look at, and stores the number of
  /// the others.
  void sort_out(const visibility::Tile& tile);
  /// Records the look-ups of a tile in the maps of `count` light points, `rows_at_once` rows of a map at a time.
  void ask(render::Commands& commands, const visibility::Tile& tile, std::uint32_t first, std::uint32_t count,
           std::uint32_t rows_at_once);

  const render::Device* device_;
  MapRecipe recipe_;
  MapOptions options_;
  CasterMaps casters_;
  std::vector<std::uint32_t> constants_;
  render::ComputePass look_up_;               ///< with the current constants
  std::optional<render::ComputePass> sort_;   ///< sorting pass, if the recipe has one
  std::vector<std::uint32_t> listed_groups_;  ///< number for each part of the tile, after sort_
  Receivers receivers_;
  visibility::PassTimes times_;
  std::map<std::string, std::uint64_t> counters_;
  const visibility::SceneFloats* scene_ = nullptr;
  SceneSpace space_;                               // space of the camera: the scene's own, or that of a sun
  const visibility::AllTriangles* all_ = nullptr;  ///< all triangles, if scene_ has only some of them; else null
  const visibility::Light* light_ = nullptr;
  const visibility::ViewSamples* samples_ = nullptr;
  LightBasis basis_;
  std::vector<visibility::LightPart>
      parts_;  ///< parts of the light with a map each; one, unless the recipe has several
  FittedViews fitted_;
  CameraFaces faces_;  ///< faces fitted to a camera, if not windows; fitted_ has their number
  Aliasing aliasing_;
  bool maps_are_old_ = false;  ///< the maps were made for another view
  std::vector<std::uint32_t> own_push_;
  std::uint32_t batch_ = 1;        ///< light points at a time
  visibility::Tile tile_{};        ///< most recent tile
  std::uint32_t tile_pixels_ = 0;  ///< number of pixels of tile_
  std::unique_ptr<render::Buffer> views_, depths_, results_;
  std::vector<double> mean_;  ///< V of tile_, if the light has several parts
};

}  // namespace penumbra::maps
