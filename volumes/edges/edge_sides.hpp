// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/lights/device_light.hpp"
#include "visibility/scene_floats.hpp"
#include "volumes/edges/edge_cut.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::volumes {

/// Requirements of one light on the edge records.
struct LightEdges {
  bool has_body = false;                 ///< the light has a body, which casts no shadow of this light: the casters
                                         ///< exclude it
  std::optional<LightSide> front, back;  ///< emitting sides; set if records must be cut at the light's plane
};

/// Selects the edge records that a light needs: those of all casters; or separate ones, if the light has a body or
/// something lies behind its plane.
class EdgeSides {
 public:
  /// `method` names the method in errors.
  explicit EdgeSides(std::string method) : method_(std::move(method)) {}

  void prepare_mesh(const visibility::SceneFloats& scene);
  /// `frame`: make_device_light(light, scale); a sphere or sun needs none, and cuts nothing. Throws InputError if
  /// float32 cannot represent light and scene together.
  LightEdges prepare_light(const visibility::Light& light, const visibility::DeviceLight& frame, float scale);

  /// Returns the casters of the light prepared last; all casters before that.
  [[nodiscard]] const EdgeCasters& casters() const { return casters_; }
  /// Returns the records of these casters.
  [[nodiscard]] EdgeRecords records() const { return {*scene_, casters_}; }

 private:
  std::string method_;
  const visibility::SceneFloats* scene_ = nullptr;
  EdgeCasters casters_;
  std::int32_t casters_without_ = -1;  // the light whose body is excluded from them
};

}  // namespace penumbra::volumes
