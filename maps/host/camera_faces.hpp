// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/caster_maps.hpp"
#include "maps/host/face_fit.hpp"
#include "render/buffer.hpp"
#include "render/commands.hpp"
#include "visibility/pass_times.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace penumbra::maps {

/// Faces fitted to a camera (face_fit.hpp): draws maps with these faces and uploads the faces for look-ups
/// (fitted.glsl).
class CameraFaces {
 public:
  struct Source {
    const visibility::SceneFloats& scene;
    const visibility::Light& light;
    const LightBasis& basis;
    const visibility::ViewSamples& samples;
    const SceneSpace& space;
  };
  /// Fits the faces, and writes the number of faces of each side to `view`, the view of the light's centre. Returns the
  /// total number.
  std::uint32_t fit(const render::Device& device, const Source& source, const FaceFitOptions& options,
                    gpu::LightView& view);

  /// Uses the given faces, sorted by side, in place of fitted ones, for the same camera.
  std::uint32_t take(const render::Device& device, const Source& source, std::vector<FittedFace> faces,
                     std::uint32_t size, gpu::LightView& view);

  /// Makes a paraboloid's circle for each side of the light's plane with maps in `view`, and writes the number of
  /// circles to `view`, as fit() does.
  std::uint32_t take_paraboloids(const render::Device& device, const LightBasis& basis, std::uint32_t size,
                                 std::uint32_t spare, gpu::LightView& view);

  /// Records all faces, the first at the beginning of `maps`, in submissions that can be timed.
  void record(const CasterMaps& casters, render::Commands& commands, std::int32_t light_index,
              const render::Buffer& maps, visibility::PassTimes& times) const;
  /// Records the layer behind the previous layer, whose faces are stored immediately before `first_face`.
  void record_behind(const CasterMaps& casters, render::Commands& commands, std::int32_t light_index,
                     const render::Buffer& maps, std::uint64_t first_face, visibility::PassTimes& times) const;

  [[nodiscard]] const std::vector<FittedFace>& faces() const { return faces_; }
  [[nodiscard]] const render::Buffer& table() const { return *table_; }
  [[nodiscard]] std::uint64_t memory_bytes() const { return table_ ? table_->bytes() : 0; }

 private:
  /// Makes the drawing data of `faces_`, and their table, which begins with `table`.
  std::uint32_t make(const render::Device& device, gpu::FaceTable table, const LightBasis& basis, std::uint32_t size,
                     gpu::LightView& view);

  std::vector<FittedFace> faces_;
  std::vector<FacePush> pushes_;
  std::unique_ptr<render::Buffer> table_;
};

}  // namespace penumbra::maps
