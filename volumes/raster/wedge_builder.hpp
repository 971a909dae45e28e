// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/method_options.hpp"
#include "visibility/pass_times.hpp"
#include "visibility/scene_floats.hpp"
#include "volumes/raster/light_volumes.hpp"
#include "volumes/wedges/penumbra_wedge.hpp"
#include "volumes/raster/wedge_raster.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace penumbra::volumes {

enum class WedgesOn { device, host };

/// Declares the option `wedges` of a method that builds them.
constexpr auto wedges_option(const char* help) {
  return visibility::ChoiceOption{
      "wedges", {{"device", WedgesOn::device}, {"host", WedgesOn::host}}, WedgesOn::device, help};
}

/// Silhouettes of a light's centre and their wedges. They are built for each light: for a moving light, in each frame.
///
/// Silhouettes of device and host are the same edges in the same order. Wedges differ in their numbers, but every plane
/// satisfies bounds_penumbra exactly in both cases. The device builds `original` wedges of four planes; the host builds
/// (build_wedges) wedges that the device cannot prove, wedges with fewer planes, and all wedges of `tight`. The host
/// handles a mesh too large for the device's buffers (SilhouettePass::most_triangles) completely.
class WedgeBuilder {
 public:
  struct Options {
    WedgesOn on = WedgesOn::device;
    Construction construction = Construction::original;
    Layers layers = Layers::one_a_solid;
    std::uint64_t most_bytes = 0;  ///< limit of the size of any buffer; 0: the device's limit. Tests set a small limit
  };
  WedgeBuilder(const render::Device& device, const Options& options);
  ~WedgeBuilder();
  WedgeBuilder(WedgeBuilder&&) noexcept;
  WedgeBuilder& operator=(WedgeBuilder&&) noexcept;

  /// Borrows the scene until the next call.
  void prepare_mesh(const visibility::SceneFloats& scene);

  struct Built {
    LightVolumes volumes;
    LightWedges wedges;
    std::uint64_t facings_on_host = 0;  ///< triangles whose side floats left open, possibly all
    std::uint64_t edges_on_host = 0;    ///< edges whose wedges the host built, possibly all
  };
  /// Builds silhouettes and wedges of a planar light.
  [[nodiscard]] Built build(const visibility::Light& light);

  std::vector<visibility::PassTime> take_pass_times();
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::volumes
