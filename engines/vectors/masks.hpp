#pragma once

#include "engines/vectors/frame.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

/// Which light samples a view sample sees, and what is not certain of that.
namespace penumbra::native {

/// Sixteen light samples each: bit column · padded_rows + row.
inline std::size_t mask_words(const Frame& frame) {
  return std::size_t{frame.columns} * frame.padded_rows / 16;
}

/// What float arithmetic left open of a view sample.
struct Open {
  bool pixel = false;                        ///< all of it
  bool corner = false;                       ///< how many triangles are before the light's corner
  std::vector<std::uint32_t> rows, samples;  ///< light samples: row · columns + column; some twice

  void clear() {
    pixel = corner = false;
    rows.clear();
    samples.clear();
  }
  [[nodiscard]] bool any() const { return pixel || !rows.empty() || !samples.empty(); }
};

/// Visible light samples of a view sample: how many, and, unless all or none are, which.
struct Seen {
  std::uint16_t* mask = nullptr;
  std::uint32_t visible = 0;
};

/// The light point centre + s u + t v is above the carrier's plane where A s + B t + C > 0.
struct HorizonLine {
  glm::dvec3 above{0};  ///< (A, B, C), in double
  glm::dvec3 error{0};  ///< what they are off by at most
};

/// Decides what is open by exact predicates.
class Judge {
 public:
  virtual ~Judge() = default;
  /// How many triangles are before a light sample.
  virtual std::uint32_t depth(const Placed& sample, std::uint32_t light_sample) = 0;
  /// The same for exactly the point centre + s u + t v of the light's plane. Nothing: double does not know which
  /// triangles to ask.
  virtual std::optional<std::uint32_t> depth_in_plane(const Placed& sample, const glm::dvec2& st) = 0;
  virtual HorizonLine horizon(const Placed& sample) = 0;
  /// The triangle's normal, of any length, turned to the side that p is on; 0: p is in its plane, or the triangle is so
  /// thin that double does not know its normal.
  virtual glm::dvec3 normal_towards(const Placed& sample, std::uint32_t triangle) = 0;
  virtual void decide(const Placed& sample, const Open& open, Seen& seen) = 0;
};

}  // namespace penumbra::native
