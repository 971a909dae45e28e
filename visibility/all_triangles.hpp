// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/assert.hpp"
#include "visibility/method.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <span>

namespace penumbra::visibility {

/// All triangles of a scene whose SceneFloats hold only a part of them (visibility/seen/). For methods that process the
/// triangles one after the other and keep none.
class AllTriangles {
 public:
  /// Triangles of one object, each with its corners as in SceneFloats. Valid until take() returns.
  struct Run {
    std::span<const std::array<glm::vec3, 3>> corners;
    bool casts_shadow = true, receives_shadow = true;
    std::int32_t emits = -1;
  };

  virtual ~AllTriangles() = default;
  /// Calls take(run) for all triangles that have an area.
  virtual void for_each_run(const std::function<void(const Run&)>& take) const = 0;
  /// Calls take(positions) for all positions, including those that no triangle uses.
  virtual void for_each_positions(const std::function<void(std::span<const glm::vec3>)>& take) const = 0;
};

/// A method that can be given all triangles apart from the scene.
class PassesTriangles {
 public:
  /// Gives all triangles for the next calls of prepare_mesh, whose scenes hold only a part: at least the triangles that
  /// carry view samples. `all` must outlive its use. Null: those scenes are complete.
  virtual void pass(const AllTriangles* all) = 0;

 protected:
  ~PassesTriangles() = default;
};

/// Gives the triangles to a method that takes them. Other methods may only be given null.
inline void pass(Method& method, const AllTriangles* all) {
  auto* const passes = dynamic_cast<PassesTriangles*>(&method);
  PENUMBRA_ASSERT(passes != nullptr || all == nullptr, "{} takes no triangles apart from the scene's",
                  method.description().name);
  if (passes != nullptr) passes->pass(all);
}

}  // namespace penumbra::visibility
