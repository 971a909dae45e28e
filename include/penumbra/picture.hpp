#pragma once

#include <penumbra/export.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

/// What was rendered: for every pixel, row by row from the top left. The numbers are those of the channels of the
/// command line's OUT.exr. Copies share their memory, which never changes; spans are valid while a copy lives. A
/// picture may be read by several threads at once.
class PENUMBRA_API Picture {
 public:
  using Float3 = std::array<float, 3>;

  [[nodiscard]] std::uint32_t width() const;
  [[nodiscard]] std::uint32_t height() const;
  /// Names of the lights, in the order that numbers of lights below have. Those functions throw UsageError for a number
  /// that no light has.
  [[nodiscard]] const std::vector<std::string>& lights() const;

  /// Visibility V of a light, 0 to 1 (channel V of the first light): the share of the light's area that is seen,
  /// weighted by a texture's luminance; 1 in the background.
  [[nodiscard]] std::span<const float> visibility(std::size_t light = 0) const;
  /// Linear red green blue of all lights together (R G B), or of one.
  [[nodiscard]] std::span<const Float3> beauty() const;
  [[nodiscard]] std::span<const Float3> beauty(std::size_t light) const;
  /// Coverage: 1 where the pixel shows a surface, 0 in the background (A).
  [[nodiscard]] std::span<const float> alpha() const;
  /// Positions in world space (P), and relative to origin() as visibility was decided (Prel); 0 in the background.
  [[nodiscard]] std::span<const Float3> positions() const;
  [[nodiscard]] std::span<const Float3> relative_positions() const;
  [[nodiscard]] std::array<double, 3> origin() const;
  /// Geometric normals, unit length, toward the camera (N).
  [[nodiscard]] std::span<const Float3> normals() const;
  /// Depth along the camera's axis (Z); 1e10 in the background.
  [[nodiscard]] std::span<const float> depth() const;
  /// Triangle numbers, mesh after mesh (id); 4294967295 in the background.
  [[nodiscard]] std::span<const std::uint32_t> ids() const;
  /// Which light samples each pixel sees: words_per_mask() words a pixel, bit j mod 32 of word j / 32 is set if light
  /// sample j is visible. Empty of a method without masks, of exact areas, of a light in pieces, and where
  /// RenderOptions::masks is off.
  [[nodiscard]] std::span<const std::uint32_t> masks(std::size_t light = 0) const;
  [[nodiscard]] std::size_t words_per_mask(std::size_t light = 0) const;
  [[nodiscard]] std::size_t light_samples(std::size_t light = 0) const;

  /// The name of the method that a light was done by.
  [[nodiscard]] const std::string& method(std::size_t light = 0) const;
  /// What the command line's --stats writes, as JSON: seconds of each phase, counters, warnings, lights.
  [[nodiscard]] const std::string& stats_json() const;

  struct State;
  /// For the library's own sources.
  explicit Picture(std::shared_ptr<const State> state);

 private:
  std::shared_ptr<const State> state_;
};

}  // namespace penumbra
