#pragma once

#include "app/pictures/matte_shares.hpp"
#include "base/exr.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::app {

/// MurmurHash3, x86, 32 bits, seed 0 (Appleby 2011, public domain).
std::uint32_t murmur3(std::string_view text);

/// The number by which a name is known in Cryptomatte: its hash's bits as a float, made a normal number by turning the
/// exponent's lowest bit where all its bits are equal (Friedman, Jones: "Cryptomatte specification" 1.2, 2018, section
/// "Hashing names").
float cryptomatte_id(std::string_view name);

/// One Cryptomatte layer of a picture: ranks of a number and its coverage, two a channel group `<layer>00`, `<layer>01`
/// and so on.
class Cryptomatte {
 public:
  static constexpr std::size_t kRanks = 6;  ///< of several view samples a pixel, as other renderers have them

  /// Of a pixel an index into names, or Surfaces::kNothing.
  using NameOf = std::function<std::uint32_t(std::size_t pixel)>;

  /// One view sample a pixel: rank 0 alone, coverage 1, or 0 where there is nothing; rank 1 is empty. `name_of` must
  /// stay valid as long as this. Equal names are one matte.
  Cryptomatte(std::string layer, std::span<const std::string> names, NameOf name_of);
  /// The six that have most of each pixel; what else is in it is in no matte.
  Cryptomatte(std::string layer, const MatteShares& shares);

  /// Adds channels, which know this object, and the attributes that the specification asks for.
  void add_to(ExrImage& image) const;

 private:
  struct Rank {
    std::vector<float> ids, coverage;  // of each pixel
  };
  /// The numbers of names, which go into the manifest.
  void take_names(std::span<const std::string> names);
  /// One of the two channels of a rank.
  [[nodiscard]] ExrValues channel(std::size_t rank, bool is_coverage) const;

  std::string layer_, manifest_;
  std::vector<float> numbers_;  // of names
  NameOf name_of_;              // of one view sample a pixel
  std::vector<Rank> ranks_;     // of several; an even number; those that are empty are 0 everywhere
};

}  // namespace penumbra::app
