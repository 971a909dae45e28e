#pragma once

#include "visibility/method.hpp"

#include <functional>
#include <memory>

namespace penumbra::engines {

/// One of a method's two engines.
using MakeEngine = std::function<std::unique_ptr<visibility::Method>()>;
struct TwoEngines {
  MakeEngine usual, other;
  bool (*is_usual)(const visibility::Light&);  ///< else the other one does it
};
/// A method of which each light is done by one of two engines that give the same bits. The usual one is made at once
/// and gets every mesh; the other is made, and given the mesh, when a light first needs it.
std::unique_ptr<visibility::Method> make_engine_by_light(TwoEngines engines);

}  // namespace penumbra::engines
