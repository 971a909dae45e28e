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

/// A side as words of triangles have it (silhouette.shared.h).
inline std::uint32_t bits_of(mesh::Side side) {
  return side == mesh::Side::front ? gpu::kFrontBit : side == mesh::Side::back ? gpu::kBackBit : 0;
}

/// The triangles that cast shadow, with their edges: all borrowed.
struct SilhouetteMesh {
  std::span<const glm::vec3> positions;
  std::span<const mesh::Triangle> triangles;
  const mesh::EdgeGraph* graph = nullptr;
};

/// mesh::silhouette_edges on the device, for one point after another. Facings from floats with the bound of
/// volumes/README.md (Bounds) and, where that does not suffice, from the host's exact predicate; k_e of every edge from
/// them; then count, prefix sum, fill. So the list is the host's, in the host's order, whatever the device and its
/// schedule; it is made as long as it must be before it is written.
class SilhouettePass {
 public:
  /// `most_bytes`: of any buffer; 0: the device's limit. Tests make it small.
  explicit SilhouettePass(const render::Device& device, std::uint64_t most_bytes = 0);
  ~SilhouettePass();
  SilhouettePass(SilhouettePass&&) noexcept;
  SilhouettePass& operator=(SilhouettePass&&) noexcept;

  /// Borrows the mesh until the next call. False, and nothing can be found, if it is too large for this device's
  /// buffers: above most_triangles().
  bool prepare_mesh(const SilhouetteMesh& mesh);
  [[nodiscard]] std::uint32_t most_triangles() const;

  /// As seen from l (finite). `counted`: for each triangle, on which of its sides l must be for it to count
  /// (gpu::kFrontBit, gpu::kBackBit). Submits and waits.
  void evaluate(const glm::vec3& l, std::span<const std::uint32_t> counted);

  /// Of the last evaluate(). For each triangle the side that l is on, and whether it counts: silhouette.shared.h.
  [[nodiscard]] std::vector<std::uint32_t> read_sides() const;
  [[nodiscard]] std::vector<mesh::SilhouetteEdge> read_edges() const;
  [[nodiscard]] std::uint32_t count() const;

  /// What other passes go on with: gpu::Silhouette for each of count(); the ends of every edge, two uints; positions.
  [[nodiscard]] const render::Buffer& silhouettes() const;
  [[nodiscard]] const render::Buffer& ends() const;
  [[nodiscard]] const render::Buffer& positions() const;

  [[nodiscard]] std::uint64_t open_facings() const;  ///< of the last evaluate(), that floats left to the host
  std::vector<visibility::PassTime> take_pass_times();
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::volumes
