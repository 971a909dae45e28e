// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/gltf/emitters/welded.hpp"
#include "scenes/scene.hpp"

#include <optional>

namespace penumbra::import {

/// Recognises the sphere that the mesh approximates: its corners lie on the sphere (`rounding` is the distance of each
/// from its intended place), its triangles close around the centre once, facing outward, and no triangle is nearer to
/// the centre than 0.98 of the radius. Such a polyhedron and the sphere light surfaces equally up to 0.25 %, measured
/// without shadows on surfaces that face it at 1.5, 3 and 10 radii, for an icosphere of 320 faces (the nearest at
/// 0.982) and a UV sphere of 32 × 16 (0.990). An icosphere of 80 faces (0.934) would be off by up to 1.4 %, a UV sphere
/// of 16 × 8 (0.963) by 0.8 %. The resulting sphere has the triangles' surface area
/// (4 π r² = Σ areas), so that it emits the same power.
std::optional<scenes::Sphere> recognise_sphere(const Welded& mesh, double rounding);

}  // namespace penumbra::import
