// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/caster_maps.hpp"
#include "maps/host/light_basis.hpp"
#include "maps/host/map_fit.hpp"
#include "maps/host/map_view.shared.h"
#include "maps/host/options.hpp"
#include "maps/sampling/light_tree.hpp"
#include "render/buffer.hpp"
#include "render/compute_pass.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::maps {

/// Selection of the light points with maps in adaptive-light, and their weights.
struct AdaptiveChoices {
  std::uint32_t levels, most_maps;
  double epsilon, gamma;
  bool gamma_of_range;  ///< gamma is a fraction of the depth range of a map; else of the compared heights
  std::uint32_t taps;   ///< a look-up's texels on a side: windows hold casters up to this distance from the receivers
  LightTree::Shape form;
  PointWeights weights;
  bool share_of_map;  ///< epsilon is a fraction of a map's texels; else of all compared receivers
};

/// Positions of the comparison: receivers on the device, and their total number.
struct ComparedReceivers {
  struct Part {
    const render::Buffer* receivers;
    std::uint32_t count;
  };
  std::vector<Part> parts;
  std::uint64_t count = 0;
};

/// Maps of a light's points, refined where two maps differ (Schwärzler, sections 3.3.1 to 3.3.3), and their weights.
/// views(), weights() and the maps are complete after refine().
class AdaptiveMaps {
 public:
  AdaptiveMaps(const render::Device& device, const MapOptions& map, const AdaptiveChoices& choices);

  void set_scene(const visibility::SceneFloats& scene);
  /// Sets the light, which then has no maps yet. Borrows `light`.
  void set_light(const visibility::Light& light);
  /// Restarts the refinement, for other receivers.
  void restart();
  /// Adds light points until no cell's maps differ by more than permitted.
  void refine(const ComparedReceivers& places);
  [[nodiscard]] bool refined() const { return refined_; }
  /// Returns the surfaces of the map of the light's centre, as receivers; valid until refine() returns.
  [[nodiscard]] ComparedReceivers centre_texels();

  [[nodiscard]] std::uint32_t point_count() const { return static_cast<std::uint32_t>(views_used_.size()); }
  /// Returns the number of points whose maps are in one buffer.
  [[nodiscard]] std::uint32_t maps_per_buffer() const { return maps_per_buffer_; }
  [[nodiscard]] const render::Buffer& views() const { return *views_; }
  /// Returns the buffer with the map of this point.
  [[nodiscard]] const render::Buffer& maps_of(std::uint32_t point) const { return *maps_[point / maps_per_buffer_]; }
  [[nodiscard]] const render::Buffer& weights() const { return *weights_; }
  [[nodiscard]] float total_weight() const { return total_; }
  /// Returns the push constants common to all look-ups of this light.
  [[nodiscard]] gpu::LookupPush push() const;

  std::vector<visibility::PassTime> take_pass_times() { return times_.take(); }
  void add(const std::vector<visibility::PassTime>& times) { times_.add(times); }
  [[nodiscard]] const std::map<std::string, std::uint64_t>& counters() const { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  [[nodiscard]] std::size_t view_of(const glm::uvec2& point) const;
  [[nodiscard]] FitOptions fit_options() const;
  /// Renders the maps of points without a map.
  void add_maps();
  /// Returns, for each pair, the number of positions at which its maps differ.
  std::vector<std::uint32_t> compare(std::span<const LightTree::Pair> pairs, const ComparedReceivers& places);
  void weigh();

  const render::Device* device_;
  MapOptions map_;
  AdaptiveChoices choices_;
  CasterMaps casters_;
  render::ComputePass compare_;
  visibility::PassTimes times_;
  std::map<std::string, std::uint64_t> counters_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  LightBasis basis_;
  std::optional<LightTree> tree_;
  bool refined_ = false;
  FittedViews grid_;                        ///< views of all points that the tree can have
  std::vector<gpu::LightView> views_used_;  ///< views of the points that the tree has, in the tree's order
  std::uint32_t maps_per_buffer_ = 1;
  float total_ = 0;  ///< sum of the weights
  std::vector<std::unique_ptr<render::Buffer>> maps_;
  std::vector<render::Buffer> texels_;
  std::unique_ptr<render::Buffer> views_, weights_, counts_;
};

}  // namespace penumbra::maps
