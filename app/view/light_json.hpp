#pragma once

#include "scenes/scene.hpp"

#include <nlohmann/json_fwd.hpp>

namespace penumbra::app {

/// A light as scene files have it: its shape under the key of its kind, radiance (of a sun irradiance, which stays when
/// its angle changes), twoSided. A shape that the page cannot change has no such key.
nlohmann::ordered_json light_json(const scenes::AreaLight& light);
nlohmann::ordered_json camera_json(const scenes::Camera& camera);

/// The light with what an object of light_json()'s form says of it, read and checked by what reads scene files: its
/// name, texture, casters and cone stay. Throws InputError for what a file could not say.
scenes::AreaLight changed_light(const scenes::AreaLight& light, const nlohmann::json& change);
/// The camera with what an object of camera_json()'s form says of it: its name, shift and shape stay.
scenes::Camera changed_camera(const scenes::Camera& camera, const nlohmann::json& change);

}  // namespace penumbra::app
