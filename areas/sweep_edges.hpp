// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "areas/area_sweep.hpp"

#include <gmpxx.h>

#include <type_traits>
#include <utility>
#include <vector>

// Edges in the number type of a sweep. Internal to areas/.

namespace penumbra::areas {

/// Returns s = S/W or t = T/W in the sweep's number type. Equal points give equal numbers, however computed: therefore
/// edges with a common end stay connected.
template <typename Number>
Number ratio_of(const mpz_class& over, const mpz_class& under);
template <>
inline mpq_class ratio_of<mpq_class>(const mpz_class& over, const mpz_class& under) {
  mpq_class value(over, under);
  value.canonicalize();
  return value;
}
template <>
inline double ratio_of<double>(const mpz_class& over, const mpz_class& under) {
  return mpq_class(over, under)
      .get_d();  // truncated toward zero from the exact quotient; needs no cancellation of common terms
}

template <typename Number>
Number number_of(const mpq_class& value) {
  if constexpr (std::is_same_v<Number, double>) return value.get_d();
  if constexpr (!std::is_same_v<Number, double>) return value;
}

template <typename Number>
void add_edge(std::vector<SweepEdge<Number>>& edges, SweepEdge<Number> edge) {
  if (edge.s0 == edge.s1) return;  // no vertical line crosses the edge
  if (edge.s0 > edge.s1) {
    std::swap(edge.s0, edge.s1);
    std::swap(edge.t0, edge.t1);
    edge.cover = -edge.cover;
    edge.region = -edge.region;
  }
  edges.push_back(std::move(edge));
}

}  // namespace penumbra::areas
