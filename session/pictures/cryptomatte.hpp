// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/exr.hpp"
#include "session/pictures/matte_shares.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::session {

/// Returns MurmurHash3, x86, 32 bits, seed 0 (Appleby 2011, public domain).
std::uint32_t murmur3(std::string_view text);

/// Returns the number of a name in Cryptomatte: its hash's bits as a float, made a normal number by inverting the
/// exponent's lowest bit if all its bits are equal (Friedman, Jones: "Cryptomatte specification" 1.2, 2018, section
/// "Hashing names").
float cryptomatte_id(std::string_view name);

/// Cryptomatte layer of a picture: ranks of a number and its coverage, two for each channel group `<layer>00`,
/// `<layer>01` and so on.
class Cryptomatte {
 public:
  static constexpr std::size_t kRanks = 6;  ///< for several view samples a pixel, the usual number of other renderers

  /// Function from a pixel to an index into names, or Surfaces::kNothing.
  using NameOf = std::function<std::uint32_t(std::size_t pixel)>;

  /// Makes a layer for one view sample a pixel: rank 0 alone, coverage 1, or 0 for background; rank 1 is empty.
  /// `name_of` must stay valid for the lifetime of this object. Equal names are one matte.
  Cryptomatte(std::string layer, std::span<const std::string> names, NameOf name_of);
  /// Makes a layer of the six mattes with the largest coverage in each pixel; other mattes of a pixel are left out.
  /// `shares`, which are settled, must outlive this object.
  Cryptomatte(std::string layer, const MatteShares& shares);

  /// Adds channels, which refer to this object, and the attributes required by the specification.
  void add_to(ExrImage& image) const;

 private:
  /// Computes the numbers of names for the manifest.
  void take_names(std::span<const std::string> names);
  /// Returns one of the two channels of a rank.
  [[nodiscard]] ExrValues channel(std::size_t rank, bool is_coverage) const;

  std::string layer_, manifest_;
  std::vector<float> numbers_;           // of names
  NameOf name_of_;                       // for one view sample a pixel
  const MatteShares* shares_ = nullptr;  // for several
};

}  // namespace penumbra::session
