#pragma once

#include "engines/method_row.hpp"
#include "visibility/method.hpp"

#include <memory>
#include <span>

namespace penumbra::reference {

/// The table of this room's methods; the best come first.
std::span<const engines::MethodRow> methods();

/// `raytrace`: one shadow ray a light sample through Embree 3 in robust mode, with the truth of a pair
/// (docs/definitions.md) except that Embree's arithmetic, not an exact predicate, says whether a triangle meets the
/// segment. Every kind of light. Deterministic.
std::unique_ptr<visibility::Method> make_ray_traced(const visibility::MethodOptions& options);

/// `exact`: V of each view sample as the area that areas/exact_area.hpp defines, and the form factor of that region.
/// Evaluates only the pixels that the host wants (Method::want_pixels).
std::unique_ptr<visibility::Method> make_exact(const visibility::MethodOptions& options);

}  // namespace penumbra::reference
