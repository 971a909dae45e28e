// SPDX-License-Identifier: Apache-2.0
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

/// Rendered picture: values for every pixel, row by row from the top left, equal to the channels of the command line's
/// OUT.exr. Copies share their memory, which never changes; spans are valid while a copy exists. A picture may be read
/// by several threads at once.
class PENUMBRA_API Picture {
 public:
  using Float3 = std::array<float, 3>;

  [[nodiscard]] std::uint32_t width() const;
  [[nodiscard]] std::uint32_t height() const;
  /// Returns the names of the lights, in the order of the light indices below. Functions with a light index throw
  /// UsageError for an invalid one.
  [[nodiscard]] const std::vector<std::string>& lights() const;

  /// Returns visibility V of a light, 0 to 1 (channel V of the first light): the visible fraction of the light's area,
  /// weighted by a texture's luminance; 1 in the background.
  [[nodiscard]] std::span<const float> visibility(std::size_t light = 0) const;
  /// Return linear red, green, blue of all lights together (R G B), or of one light.
  [[nodiscard]] std::span<const Float3> beauty() const;
  [[nodiscard]] std::span<const Float3> beauty(std::size_t light) const;
  /// Returns coverage: 1 where the pixel shows a surface, 0 in the background (A).
  [[nodiscard]] std::span<const float> alpha() const;
  /// Return positions in world space (P), and relative to origin(), as used to decide visibility (Prel); 0 in the
  /// background.
  [[nodiscard]] std::span<const Float3> positions() const;
  [[nodiscard]] std::span<const Float3> relative_positions() const;
  [[nodiscard]] std::array<double, 3> origin() const;
  /// Returns geometric normals, unit length, toward the camera (N).
  [[nodiscard]] std::span<const Float3> normals() const;
  /// Returns depth along the camera's axis (Z); 1e10 in the background.
  [[nodiscard]] std::span<const float> depth() const;
  /// Returns triangle indices, mesh after mesh (id); 4294967295 in the background.
  [[nodiscard]] std::span<const std::uint32_t> ids() const;
  /// Returns the visible light samples of each pixel: words_per_mask() words a pixel, bit j mod 32 of word j / 32 is
  /// set if light sample j is visible. Empty for a method without masks, for exact areas, for a light in pieces, and if
  /// RenderOptions::masks is off.
  [[nodiscard]] std::span<const std::uint32_t> masks(std::size_t light = 0) const;
  [[nodiscard]] std::size_t words_per_mask(std::size_t light = 0) const;
  [[nodiscard]] std::size_t light_samples(std::size_t light = 0) const;

  /// Returns the name of the method used for a light.
  [[nodiscard]] const std::string& method(std::size_t light = 0) const;
  /// Returns the JSON of the command line's --stats: seconds of each phase, counters, warnings, lights.
  [[nodiscard]] const std::string& stats_json() const;

  struct State;
  /// Internal to the library.
  explicit Picture(std::shared_ptr<const State> state);

 private:
  std::shared_ptr<const State> state_;
};

}  // namespace penumbra
