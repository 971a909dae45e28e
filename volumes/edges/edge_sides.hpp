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

/// What one light asks of the edge records.
struct LightEdges {
  bool has_body = false;                 ///< which casts no shadow of it: the casters are without
  std::optional<LightSide> front, back;  ///< sides it emits to at whose plane records must be cut
};

/// Which edge records a light needs: those of all casters, or, where it has a body or something lies behind its plane,
/// its own.
class EdgeSides {
 public:
  /// `method` names errors.
  explicit EdgeSides(std::string method) : method_(std::move(method)) {}

  void prepare_mesh(const visibility::SceneFloats& scene);
  /// `frame`: make_device_light(light, scale); a sphere or sun needs none, and cuts nothing. Throws InputError where
  /// float32 cannot span light and scene together.
  LightEdges prepare_light(const visibility::Light& light, const visibility::DeviceLight& frame, float scale);

  /// Of all that casts shadow of the light last prepared; of everything before there is one.
  [[nodiscard]] const EdgeCasters& casters() const { return casters_; }
  /// Of these.
  [[nodiscard]] EdgeRecords records() const { return {*scene_, casters_}; }

 private:
  std::string method_;
  const visibility::SceneFloats* scene_ = nullptr;
  EdgeCasters casters_;
  std::int32_t casters_without_ = -1;  // the light whose body is left out of them
};

}  // namespace penumbra::volumes
