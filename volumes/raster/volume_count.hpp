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

/// How many shadow volumes of the light's centre each view sample is in.
///
/// Exact (z_fail): the count is the number of triangles that the open segment from p to `center()` meets, as
/// visibility::segment_meets_triangle says, what is coplanar with the carrier left out, and of closed parts what
/// `layers` leaves out. Any soup, camera and light.
/// Faces are rasterised and counted in 32-bit integers, so their order cannot matter and nothing wraps. Volumes may
/// come in parts (LightVolumes::parts), each cut by planes, or counted before p or beyond it as suits each pixel
/// (z_fail).
class VolumeCount {
 public:
  /// `in_parts`: volumes will come in parts; passes for them are made at once, not when they do.
  VolumeCount(const render::Device& device, CountVariant variant, Layers layers = Layers::every_triangle,
              bool in_parts = false);
  ~VolumeCount();
  VolumeCount(VolumeCount&&) noexcept;
  VolumeCount& operator=(VolumeCount&&) noexcept;

  /// Each borrows its argument until the next call. Called in this order; a later one any number of times.
  void prepare_mesh(const visibility::SceneFloats& scene);
  void prepare_light(const visibility::Light& light);
  void prepare_view(const visibility::ViewSamples& samples);

  /// After prepare_mesh: what it found.
  [[nodiscard]] const ShadowCasters& casters() const;

  /// In place of the first two, or after prepare_mesh in place of the second, where someone else finds the volumes of
  /// lights (ShadowCasters, with the same layers).
  void prepare_scene(const visibility::SceneFloats& scene);
  void prepare_light(const visibility::Light& light, LightVolumes volumes);

  /// Pixels whose light is decided without counting.
  enum class Kind : std::uint8_t {
    lit,      ///< background, the body of a light, or what receives no shadow
    dark,     ///< the centre is not above the carrier's plane, or p not in front of the light
    counted,  ///< the rest
  };

  [[nodiscard]] std::uint32_t max_tile_rows() const;
  void count(const visibility::Tile& tile);
  /// Of the tile last counted, row by row. 0 where the kind is not `counted`.
  [[nodiscard]] std::span<const std::int32_t> counts() const;
  [[nodiscard]] std::span<const Kind> kinds() const;
  /// 1 where the host counted: a sign is within rounding. So wherever p is on a triangle that has a volume.
  [[nodiscard]] std::span<const std::uint32_t> doubts() const;

  /// What the volumes belong to.
  [[nodiscard]] glm::vec3 center() const;
  /// Of the light last prepared: silhouette edges, caps.
  [[nodiscard]] const LightVolumes& volumes() const;

  /// Of the counts since prepare_light.
  struct Totals {
    std::uint64_t silhouette_edges = 0, caps = 0;
    std::uint64_t faces_on_screen = 0;  ///< sides, fans and caps that were rasterised
    std::uint64_t far_ends_on_screen = 0;
    std::uint64_t fragments = 0;        ///< that these propose, about: the areas of their boxes on the screen
    std::uint64_t updates = 0;          ///< of counts: what a stencil would be written for
    std::uint64_t toggling_parts = 0;   ///< of those that asked for it
    bool from_eye = false;              ///< z_pass_from_eye, as its name says
    std::uint64_t doubtful_pixels = 0;  ///< counted on the host, because a sign was within its error bound
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
