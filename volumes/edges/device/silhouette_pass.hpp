// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/edge_graph.hpp"
#include "mesh/predicates.hpp"
#include "mesh/silhouettes.hpp"
#include "render/buffer.hpp"
#include "render/device.hpp"
#include "visibility/method.hpp"
#include "volumes/edges/device/silhouette.shared.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace penumbra::volumes {

/// Returns a side in the format of triangles' words (silhouette.shared.h).
inline std::uint32_t bits_of(mesh::Side side) {
  return side == mesh::Side::front ? gpu::kFrontBit : side == mesh::Side::back ? gpu::kBackBit : 0;
}

/// The triangles that cast shadows, with their edges: all borrowed.
struct SilhouetteMesh {
  std::span<const glm::vec3> positions;
  std::span<const mesh::Triangle> triangles;
  const mesh::EdgeGraph* graph = nullptr;
};

/// Computes mesh::silhouette_edges on the device, for one point after another. Facings come from floats with the bound
/// of volumes/README.md (Bounds) and, where that does not suffice, from the host's exact predicate; k_e of every edge
/// follows from them. The silhouettes are then counted, their places summed, and the list written. So its length is
/// known before it is written, and it equals the host's list, in the host's order, independent of the device and its
/// schedule.
class SilhouettePass {
 public:
  /// `most_bytes`: limit of the size of any buffer; 0: the device's limit. Tests set a small limit.
  explicit SilhouettePass(const render::Device& device, std::uint64_t most_bytes = 0);
  ~SilhouettePass();
  SilhouettePass(SilhouettePass&&) noexcept;
  SilhouettePass& operator=(SilhouettePass&&) noexcept;

  /// Borrows the mesh until the next call. Returns false if it is too large for this device's buffers, above
  /// most_triangles(); then evaluate() must not be called.
  bool prepare_mesh(const SilhouetteMesh& mesh);
  [[nodiscard]] std::uint32_t most_triangles() const;

  /// Computes the silhouettes as seen from l (finite). `counted`: for each triangle, the sides on which l must be for
  /// it to count (gpu::kFrontBit, gpu::kBackBit). Submits and waits.
  void evaluate(const glm::vec3& l, std::span<const std::uint32_t> counted);

  /// Results of the last evaluate(). read_sides() returns for each triangle the side that l is on, and whether it
  /// counts: silhouette.shared.h.
  [[nodiscard]] std::vector<std::uint32_t> read_sides() const;
  [[nodiscard]] std::vector<mesh::SilhouetteEdge> read_edges() const;
  [[nodiscard]] std::uint32_t count() const;

  /// Buffers for other passes: gpu::Silhouette for each of count(); the ends of every edge, two uints; positions.
  [[nodiscard]] const render::Buffer& silhouettes() const;
  [[nodiscard]] const render::Buffer& ends() const;
  [[nodiscard]] const render::Buffer& positions() const;

  [[nodiscard]] std::uint64_t open_facings() const;  ///< facings of the last evaluate() that floats left to the host
  std::vector<visibility::PassTime> take_pass_times();
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::volumes
