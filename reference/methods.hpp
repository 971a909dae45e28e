// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/method_row.hpp"
#include "visibility/method.hpp"

#include <memory>
#include <span>

namespace penumbra::reference {

/// Returns the table of this room's methods, the best first.
std::span<const engines::MethodRow> methods();

/// Makes `raytrace`: one shadow ray for each light sample through Embree 3 in robust mode, with the truth of a pair
/// (docs/definitions.md) except that Embree's arithmetic, not an exact predicate, decides whether a triangle meets the
/// segment. Supports every kind of light. Deterministic.
std::unique_ptr<visibility::Method> make_ray_traced(const visibility::MethodOptions& options);

/// Makes `exact`: V of each view sample as the area that areas/exact_area.hpp defines, and the form factor of that
/// region. Evaluates only the pixels that the host wants (Method::want_pixels).
std::unique_ptr<visibility::Method> make_exact(const visibility::MethodOptions& options);

}  // namespace penumbra::reference
