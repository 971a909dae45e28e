#pragma once

#include "app/pictures/matte_shares.hpp"
#include "base/exr.hpp"

#include <cstdint>
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

  /// One view sample a pixel: rank 0 alone, coverage 1, or 0 where there is nothing; rank 1 is empty. `of_pixel`: for
  /// each pixel an index into `names`, or Surfaces::kNothing. Equal names are one matte.
  Cryptomatte(std::string layer, std::span<const std::string> names, std::span<const std::uint32_t> of_pixel);
  /// The six that have most of each pixel; what else is in it is in no matte.
  Cryptomatte(std::string layer, const MatteShares& shares);

  /// Adds channels, which point into this object, and the attributes that the specification asks for.
  void add_to(ExrImage& image) const;

 private:
  struct Rank {
    std::vector<float> ids, coverage;
  };
  /// The numbers of names, which go into the manifest.
  std::vector<float> take_names(std::span<const std::string> names);

  std::string layer_, manifest_;
  std::vector<Rank> ranks_;     // an even number; those that are empty are 0 everywhere
  std::vector<float> nothing_;  // theirs
};

}  // namespace penumbra::app
