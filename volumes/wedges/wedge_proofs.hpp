// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/wedges/wedge_polyhedron.hpp"
#include "volumes/wedges/wedge_validation.hpp"

/// Proofs of a single wedge. Internal to this room.
namespace penumbra::volumes {

class WedgeProofs {
 public:
  explicit WedgeProofs(const WedgesToValidate& input) : input_(input), box_(bounds_of(input.casters)) {}

  /// Adds violations of the wedge with index `wedge`, and the number of checks, to the report.
  void check(std::uint32_t wedge, ValidationReport& report) const;

 private:
  struct Job;
  void check_numbers(Job& job) const;
  void check_outcome(Job& job) const;
  void check_planes(Job& job) const;
  void check_points(Job& job) const;
  void check_polyhedron(Job& job) const;
  void check_half_spaces(Job& job, const Polyhedron& polyhedron) const;
  [[nodiscard]] bool is_proved_crop(const Job& job, const Plane& plane) const;
  [[nodiscard]] bool is_silhouette_from(const Job& job, const ExactPoint& p) const;

  const WedgesToValidate& input_;
  Box box_;
};

}  // namespace penumbra::volumes
