// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

#include <functional>
#include <memory>

namespace penumbra::engines {

/// Makes one of a method's two engines.
using MakeEngine = std::function<std::unique_ptr<visibility::Method>()>;
struct TwoEngines {
  MakeEngine usual, other;
  bool (*is_usual)(const visibility::Light&);  ///< true if the usual engine handles the light, else the other one
};
/// Makes a method whose lights are each handled by one of two engines with equal results. The usual engine is made
/// immediately and gets every mesh; the other is made, and given the mesh, when a light first needs it.
std::unique_ptr<visibility::Method> make_engine_by_light(TwoEngines engines);

}  // namespace penumbra::engines
