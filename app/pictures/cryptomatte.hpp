#pragma once

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

/// One Cryptomatte layer of a picture with one view sample a pixel: rank 0 alone, `<layer>00.R` the name's number, `.G`
/// its coverage (1, or 0 where there is nothing), `.B` and `.A` an empty rank 1.
class Cryptomatte {
 public:
  static constexpr std::uint32_t kNothing = 0xffffffffu;

  /// `of_pixel`: for each pixel an index into `names`, or kNothing. Equal names are one matte.
  Cryptomatte(std::string layer, std::span<const std::string> names, std::span<const std::uint32_t> of_pixel);

  /// Adds channels, which point into this object, and the attributes that the specification asks for.
  void add_to(ExrImage& image) const;

 private:
  std::string layer_;
  std::string manifest_;
  std::vector<float> ids_, coverage_, nothing_;
};

}  // namespace penumbra::app
