// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/wedges/wedge_casters.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Proves, by exact signs, that wedges have the properties that their type and outcome state. Uses only the planes, not
/// the construction that made them.
namespace penumbra::volumes {

enum class Invariant {
  numbers,  ///< every coefficient is finite, no normal is zero
  cover,    ///< the wedges of an edge cover the edge: whole, or split in pieces that share their ends
  outcome,  ///< `empty` has no length; `everywhere` has no planes and, if tight, no direction separates its edge from
            ///< the light
  conservative,  ///< every plane holds on the penumbra: the signs of wedge_plane.hpp, or those of a crop
  sampled,       ///< points of the penumbra (with a crop: where k_e ≠ 0) are inside, exactly
  polyhedron,    ///< cut by the box: closed, convex, oriented outward
  half_spaces,   ///< the half-space tests and the mesh of `polyhedron` agree on the points inside
  closed_loops,  ///< around every vertex, Σ k_e in = Σ k_e out; half-edge loops are closed and carry the same k_e
  coverage,      ///< silhouettes add up to the area of the light hidden by triangles (coverage_validation.hpp)
};
inline constexpr std::size_t kInvariants = 9;
const char* name_of(Invariant invariant);

struct Violation {
  Invariant invariant = Invariant::conservative;
  std::optional<std::uint32_t> wedge;  ///< index in the list; nullopt for closed_loops and coverage
  std::optional<std::uint32_t> plane;  ///< index in the wedge's planes
  glm::dvec3 point{0};                 ///< a point of the penumbra outside the wedge; for other invariants the location
                                       ///< of the flaw
  double distance = 0;                 ///< distance of `point` from the plane, outside
  std::string what;
};

struct ValidationReport {
  std::vector<Violation> violations;                ///< sorted by wedge
  std::array<std::uint64_t, kInvariants> checks{};  ///< number of single checks of each invariant
  std::uint64_t flat = 0;                           ///< wedges that only touch the box: no polyhedron to check
  std::uint64_t cropped_planes = 0;                 ///< planes proved as crops
};

struct WedgesToValidate {
  const Casters& casters;
  const CastingEdges& casting;
  const LightHull& light;
  std::span<const Wedge> wedges;
  bool tight = false;                  ///< requires that `everywhere` is unavoidable
  std::uint32_t points_per_wedge = 8;  ///< number of points of `sampled`, and also of `half_spaces`
};

/// Validates in parallel; the result does not depend on the number of threads.
ValidationReport validate(const WedgesToValidate& input);

/// Checks the silhouettes from the light's centre alone: `closed_loops`.
void check_closed_loops(const Casters& casters, const LightHull& light, ValidationReport& report);

}  // namespace penumbra::volumes
