#pragma once

#include "visibility/view_samples.hpp"
#include "volumes/penumbra_wedge.hpp"
#include "volumes/wedge_plane.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::volumes {

/// A convex polygon on the screen, in pixels from the picture's upper left; its corners in order.
struct Footprint {
  static constexpr std::size_t kMost = 8;
  std::array<glm::vec2, kMost> corners;
  std::size_t size = 0;
};

/// Where receivers lie: what wedges, which have no caps, are cut by.
struct Receivers {
  Box bounds;
  double nearest = 0;  ///< along the view axis, less than every receiver's; positive
};

/// Of all pixels that are not background; nothing if there is none.
std::optional<Receivers> receivers_of(const visibility::ViewSamples& samples);

/// Where on the screen the receivers in a wedge may be. It only proposes: shaders decide.
class FootprintFinder {
 public:
  FootprintFinder(const visibility::PinholeCamera& camera, const Receivers& receivers);

  /// Holds every pixel whose centre is within an eighth of a pixel of where a receiver in one of the wedges appears
  /// (pieces of one edge; `split` ones are passed over). Nothing: no pixel. The eye may be inside.
  [[nodiscard]] std::optional<Footprint> around(std::span<const Wedge> pieces) const;

 private:
  using Loop = std::vector<glm::dvec3>;
  [[nodiscard]] std::vector<Loop> box() const;

  visibility::PinholeCamera camera_;
  Receivers receivers_;
  double reach_ = 0;  // the largest coordinate in the bounds
};

}  // namespace penumbra::volumes
