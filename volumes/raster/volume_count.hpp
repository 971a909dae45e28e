// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/method.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"
#include "volumes/raster/light_volumes.hpp"
#include "volumes/raster/volume_faces.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace penumbra::volumes {

/// Counts the shadow volumes of the light's centre that contain each view sample.
///
/// Exact (z_fail): the count is the number of triangles that the open segment from p to `center()` meets, by
/// visibility::segment_meets_triangle, without triangles coplanar with the carrier, and without the triangles of closed
/// parts that `layers` excludes. Any soup, camera and light. Faces are rasterised and counted in 32-bit integers, so
/// their order cannot matter and nothing wraps. Volumes may come in parts (LightVolumes::parts). Each part may be cut
/// by planes, and may be counted between the eye and p, or beyond p, depending on the pixel (z_fail).
class VolumeCount {
 public:
  /// `in_parts`: volumes will come in parts; passes for them are made immediately.
  VolumeCount(const render::Device& device, CountVariant variant, Layers layers = Layers::every_triangle,
              bool in_parts = false);
  /// Counts one view sample of each tile that is wholly inside or outside each volume (shadow_tiles.hpp). The counts
  /// stay the same. Only for volumes without parts.
  void decide_whole_tiles();
  ~VolumeCount();
  VolumeCount(VolumeCount&&) noexcept;
  VolumeCount& operator=(VolumeCount&&) noexcept;

  /// Each function borrows its argument until its next call. Call them in this order; the later ones any number of
  /// times.
  void prepare_mesh(const visibility::SceneFloats& scene);
  void prepare_light(const visibility::Light& light);
  void prepare_view(const visibility::ViewSamples& samples);

  /// Returns the casters found by prepare_mesh.
  [[nodiscard]] const ShadowCasters& casters() const;

  /// For callers that find the volumes of lights themselves (ShadowCasters, with the same layers). These replace
  /// prepare_mesh and prepare_light(light), or only the latter.
  void prepare_scene(const visibility::SceneFloats& scene);
  void prepare_light(const visibility::Light& light, LightVolumes volumes);

  /// How a pixel's light is decided; only `counted` needs the count.
  enum class Kind : std::uint8_t {
    lit,      ///< background, the body of a light, or surfaces that receive no shadow
    dark,     ///< the centre is not above the carrier's plane, or p not in front of the light
    counted,  ///< all others
  };

  [[nodiscard]] std::uint32_t max_tile_rows() const;
  void count(const visibility::Tile& tile);
  /// Results for the tile counted last, row by row. The count is 0 where the kind is not `counted`.
  [[nodiscard]] std::span<const std::int32_t> counts() const;
  [[nodiscard]] std::span<const Kind> kinds() const;
  /// Returns 1 where the host counted because a sign is within rounding. This includes all p on a triangle that has a
  /// volume.
  [[nodiscard]] std::span<const std::uint32_t> doubts() const;

  /// Returns the point that the volumes belong to.
  [[nodiscard]] glm::vec3 center() const;
  /// Returns silhouette edges and caps of the light prepared last.
  [[nodiscard]] const LightVolumes& volumes() const;

  /// Totals of the counts since prepare_light.
  struct Totals {
    std::uint64_t silhouette_edges = 0, caps = 0;
    std::uint64_t faces_on_screen = 0;  ///< sides, fans and caps that were rasterised
    std::uint64_t far_ends_on_screen = 0;
    std::uint64_t fragments = 0;       ///< approximate number of proposed fragments: the areas of the screen boxes
    std::uint64_t updates = 0;         ///< updates of counts: stencil writes in other implementations
    std::uint64_t toggling_parts = 0;  ///< parts that toggle
    std::uint64_t tiles = 0, whole_tiles = 0;  ///< set by decide_whole_tiles
    std::uint64_t counted_pixels = 0;          ///< view samples that were counted
    bool from_eye = false;                     ///< z_pass_from_eye was requested and did not fall back to z_fail
    std::uint64_t doubtful_pixels = 0;         ///< counted on the host, because a sign was within its error bound
    std::uint64_t largest_count = 0;
  };
  [[nodiscard]] const Totals& totals() const;
  std::vector<visibility::PassTime> take_pass_times();
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::volumes
