// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace penumbra::fuzz {

/// A few triangles, a light among them, and view samples on the triangles.
struct SoupCase {
  scenes::Scene scene;
  visibility::SceneFloats floats;
  visibility::Light light;
  visibility::ViewSamples samples;
};

/// Makes a case from any bytes in which cases that rounding hides elsewhere are normal: corners on a small lattice, an
/// ulp off it, or many powers of two smaller; doubles, shared edges, coplanar neighbours, needles, triangles without
/// area or in the light's plane; view samples on corners and edges. Returns nullopt if no scene can be made of the
/// bytes.
std::optional<SoupCase> read_soup_case(std::span<const std::uint8_t> bytes);

}  // namespace penumbra::fuzz
