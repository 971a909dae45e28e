#pragma once

#include "mesh/predicates.hpp"
#include "mesh/triangle_soup.hpp"
#include "render/buffer.hpp"
#include "render/device.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace penumbra::volumes {

/// Facings of all triangles from all points: two bits a pair, in two planes of 32-bit words. Word (w, j), at
/// w · point_count + j, has in bit i what point j makes of triangle 32 w + i: the bit in `front` where the triangle's
/// winding runs counter-clockwise as seen from the point, in `back` where clockwise, in neither where the point is on
/// its plane or it has no area. Bits beyond the last triangle are 0.
struct FacingBits {
  std::uint32_t triangle_count = 0, point_count = 0;
  std::vector<std::uint32_t> front, back;

  [[nodiscard]] mesh::Side side(std::uint32_t triangle, std::uint32_t point) const {
    const std::size_t word = std::size_t{triangle / 32} * point_count + point;
    const std::uint32_t bit = triangle % 32;
    return static_cast<mesh::Side>(static_cast<int>(front[word] >> bit & 1U) -
                                   static_cast<int>(back[word] >> bit & 1U));
  }
};

struct FacingOptions {
  std::uint64_t most_bytes = 0;         ///< of any buffer; 0: the device's limit. Tests make it small
  std::uint32_t first_list = 1U << 16;  ///< undecided words that the list holds at first; it grows
};

/// What has been evaluated since the mesh was prepared.
struct FacingCounts {
  std::uint64_t pairs = 0;
  std::uint64_t undecided = 0;     ///< of them, pairs that floats left to the host
  std::uint64_t list_retries = 0;  ///< how often the list was too short and the pass ran again
  double device_milliseconds = 0, host_milliseconds = 0;
};

/// mesh::side_of_plane for millions of (triangle, point) pairs: float arithmetic with an error bound on the device
/// (README.md, Bounds), and the exact predicate on all of the host's cores where the bound does not suffice. Every bit
/// is exact afterwards, and there is one of each pair, which all three edges of the triangle use: sums of signed edges
/// stay whole. Deterministic: neither device nor number of threads nor order can change a bit.
class FacingPass {
 public:
  explicit FacingPass(const render::Device& device, const FacingOptions& options = {});
  ~FacingPass();
  FacingPass(FacingPass&&) noexcept;
  FacingPass& operator=(FacingPass&&) noexcept;

  /// Finite positions, indices in range; both borrowed until the next call. Any order, winding and degeneracy.
  void prepare_mesh(std::span<const glm::vec3> positions, std::span<const mesh::Triangle> triangles);

  /// How many points one evaluate() can take. Throws ResourceError when not even one.
  [[nodiscard]] std::uint32_t max_points() const;
  /// Facings from these points (finite, at most max_points()), in place of the last ones. Submits and waits.
  void evaluate(std::span<const glm::vec3> points);

  /// The planes of the last evaluate(), laid out as FacingBits; may be longer than that. Not before the first pair.
  [[nodiscard]] const render::Buffer& front() const;
  [[nodiscard]] const render::Buffer& back() const;
  [[nodiscard]] FacingBits read() const;
  [[nodiscard]] FacingCounts counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::volumes
