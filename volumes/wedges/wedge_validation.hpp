#pragma once

#include "volumes/wedges/wedge_casters.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Proves, by exact signs, that wedges are what they claim to be. Looks at the planes alone, and does not depend on
/// how they were built.
namespace penumbra::volumes {

enum class Invariant {
  numbers,  ///< every coefficient is finite, no normal is zero
  cover,    ///< the wedges of an edge are the edge: whole, or split in pieces that share their ends
  outcome,  ///< `empty` has no length; `everywhere` has no planes, and no direction keeps a tight edge off the light
  conservative,  ///< every plane holds on the penumbra: the signs of wedge_plane.hpp, or those of a crop
  sampled,       ///< points of the penumbra (with a crop: where k_e ≠ 0) are inside, exactly
  polyhedron,    ///< cut by the box: closed, convex, oriented outward
  half_spaces,   ///< the half-space tests and that mesh agree on which points are inside
  closed_loops,  ///< around every vertex Σ k_e in = Σ k_e out; half-edge loops are closed and carry the same k_e
  coverage,      ///< silhouettes add up to what triangles hide of the light (coverage_validation.hpp)
};
inline constexpr std::size_t kInvariants = 9;
const char* name_of(Invariant invariant);

struct Violation {
  Invariant invariant = Invariant::conservative;
  std::optional<std::uint32_t> wedge;  ///< number in the list; nothing for closed_loops and coverage
  std::optional<std::uint32_t> plane;  ///< of the wedge
  glm::dvec3 point{0};                 ///< of the penumbra, yet outside; or where else the flaw is
  double distance = 0;                 ///< by which it is outside the plane
  std::string what;
};

struct ValidationReport {
  std::vector<Violation> violations;                ///< by wedge
  std::array<std::uint64_t, kInvariants> checks{};  ///< how many single checks were made of each
  std::uint64_t flat = 0;                           ///< wedges that only touch the box: no polyhedron to check
  std::uint64_t cropped_planes = 0;                 ///< proved as crops
};

struct WedgesToValidate {
  const Casters& casters;
  const CastingEdges& casting;
  const LightHull& light;
  std::span<const Wedge> wedges;
  bool tight = false;                  ///< `everywhere` must then be unavoidable
  std::uint32_t points_per_wedge = 8;  ///< of `sampled` and of `half_spaces`, each
};

/// Parallel; the same answer for any number of threads.
ValidationReport validate(const WedgesToValidate& input);

/// The silhouettes from the light's centre alone: `closed_loops`.
void check_closed_loops(const Casters& casters, const LightHull& light, ValidationReport& report);

}  // namespace penumbra::volumes
