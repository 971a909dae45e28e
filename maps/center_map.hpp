#pragma once

#include "maps/caster_maps.hpp"
#include "maps/light_frame.hpp"
#include "maps/map_fit.hpp"
#include "maps/options.hpp"
#include "maps/receivers.hpp"
#include "render/buffer.hpp"
#include "render/commands.hpp"
#include "render/device.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace penumbra::maps {

/// What the methods that look at one map from the light's centre share: everything but the look-up. The map is rendered
/// in prepare_light; it depends on mesh and light only.
class CenterMapMethod : public visibility::Method {
 public:
  CenterMapMethod(const render::Device& device, visibility::MethodDescription description,
                  const visibility::MethodOptions& options);

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& scene) override;
  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override;
  [[nodiscard]] std::uint32_t max_tile_rows() const override;
  void evaluate(const visibility::Tile& tile) override;
  void read_visibility(std::span<float> visibility) override;
  std::vector<visibility::PassTime> take_pass_times() override { return times_.take(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 protected:
  /// The device buffers of the light's map, for look-ups.
  struct Map {
    const render::Buffer& views;  ///< one LightView
    const render::Buffer& depths;
  };
  /// Called when the map has been rendered; what is recorded runs before prepare_light returns.
  virtual void map_rendered(render::Commands& /*commands*/, const Map& /*map*/, std::uint32_t /*faces*/,
                            const visibility::Light& /*light*/, const LightFrame& /*frame*/) {}
  /// Records the look-up of one part of a tile.
  virtual void record_lookup(render::Commands& commands, const gpu::LookupPush& push, const Receivers::Part& part,
                             const Map& map, const render::Buffer& visibility) = 0;
  [[nodiscard]] virtual std::uint64_t own_memory_bytes() const { return 0; }

  [[nodiscard]] const render::Device& device() const { return *device_; }
  [[nodiscard]] const MapOptions& options() const { return options_; }

 private:
  const render::Device* device_;
  visibility::MethodDescription description_;
  MapOptions options_;
  CasterMaps casters_;
  Receivers receivers_;
  visibility::PassTimes times_;
  std::map<std::string, std::uint64_t> counters_;
  const visibility::SceneFloats* scene_ = nullptr;
  gpu::LookupPush push_{};
  std::uint32_t tile_pixels_ = 0;  ///< of the tile last evaluated
  std::unique_ptr<render::Buffer> views_, depths_, visibility_;
};

/// The shapes that methods of this family can do: all planar ones.
std::vector<visibility::LightKind> planar_lights();

}  // namespace penumbra::maps
