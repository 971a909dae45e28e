// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <nlohmann/json_fwd.hpp>

namespace penumbra::app {

/// Returns a light in the form of scene files: its shape under the key of its kind, radiance, twoSided. A sun has
/// irradiance in place of radiance, so that it stays as bright when the page changes its angle. A shape that the page
/// cannot change has no key.
nlohmann::ordered_json light_json(const scenes::AreaLight& light);
nlohmann::ordered_json camera_json(const scenes::Camera& camera);

/// Returns the light with the changes in an object of light_json()'s form, read and checked by the reader of scene
/// files: its name, texture, casters and cone are unchanged. Throws InputError for values that are invalid in a file.
scenes::AreaLight changed_light(const scenes::AreaLight& light, const nlohmann::json& change);
/// Returns the camera with the changes in an object of camera_json()'s form: its name, shift and shape are unchanged.
scenes::Camera changed_camera(const scenes::Camera& camera, const nlohmann::json& change);

}  // namespace penumbra::app
