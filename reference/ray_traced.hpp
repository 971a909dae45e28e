#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::reference {

/// `raytrace`: one shadow ray a light sample through Embree 3 in robust mode, with the truth of a pair
/// (docs/definitions.md) except that Embree's arithmetic, not an exact predicate, says whether a triangle meets the
/// segment. Every kind of light. Deterministic.
std::unique_ptr<visibility::Method> make_ray_traced(const visibility::MethodOptions& options);

}  // namespace penumbra::reference
