// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/method.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::visibility {

/// A planar light in the form of device passes: its samples lie at center + s·u + t·v with s, t in [−1, 1], up to
/// `deviation`. u × v points to the emitting side. In float32, scaled by `scale`.
struct DeviceLight {
  glm::vec3 center{0}, u{0}, v{0};
  bool rows = false;             ///< the samples form rows of a rectangle (not: disks, polygons, sobol, jittered)
  std::uint32_t shift_step = 0;  ///< rows: a row's shift in cells is (row · shift_step) / 2¹⁶, modulo 1 into [−½, ½)
  std::vector<glm::vec2> coordinates;  ///< (s, t) of each light sample, in their order
  float deviation = 0;                 ///< the largest distance of a stored sample from its place in this frame
};

/// Returns a frame as large as a sphere, only for the checks of size that planar lights get; the sphere itself has no
/// frame.
DeviceLight box_of_sphere(const Light& light, float scale);

/// Returns the frame of a rectangle; for a disk, ellipse or polygon that of a rectangle around it along the first
/// stored axis. `scale` is a power of two. Not for spheres.
DeviceLight make_device_light(const Light& light, float scale);

/// Returns whether the light samples are rows of a rectangle: DeviceLight::rows.
bool has_rows(const Light& light);

/// Returns an upper bound of the magnitudes of all coordinates in scene and light, times `scale`: rounding errors of
/// positions are proportional to it.
float reach_of(const SceneFloats& scene, const DeviceLight& frame, float scale);

/// Returns whether a method with this span of light sizes supports the light. Every method supports suns, which have no
/// size.
bool can_span(const LightSpan& span, const Light& light, const SceneFloats& scene);

/// Throws InputError if float32 (kFloatSpan) cannot represent light and scene together; `method` names the method in
/// the message.
void check_size(const Light& light, const DeviceLight& frame, const std::string& method);

}  // namespace penumbra::visibility
