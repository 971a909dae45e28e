#pragma once

#include "visibility/light_frame.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "volumes/edge_set.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::volumes {

/// The records of one light where those of the whole mesh will not do.
struct SidedRecords {
  bool cut = false;  ///< at the light's plane
  std::optional<std::vector<EdgeRecord>> front, back;
};

/// Which edge records a light needs: those of all casters, or, where it has a body or something lies behind its plane,
/// its own.
class EdgeSides {
 public:
  /// `method` names errors.
  explicit EdgeSides(std::string method) : method_(std::move(method)) {}

  /// Records of all that casts shadow, cut nowhere.
  std::vector<EdgeRecord> prepare_mesh(const visibility::SceneFloats& scene);
  /// `frame`: make_light_frame(light, scale). Throws InputError where float32 cannot span light and scene together.
  SidedRecords prepare_light(const visibility::Light& light, const visibility::LightFrame& frame, float scale);

 private:
  std::string method_;
  const visibility::SceneFloats* scene_ = nullptr;
  EdgeCasters casters_;
  std::int32_t casters_without_ = -1;  // the light whose body is left out of them
};

}  // namespace penumbra::volumes
