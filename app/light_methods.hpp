#pragma once

#include "visibility/method.hpp"
#include "visibility/scene_floats.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace penumbra::app {

/// What was said of methods on the command line.
struct MethodWish {
  std::string method;  ///< empty: the best for each light
  visibility::MethodOptions options;
  bool samples = false;  ///< light samples were asked for, too
};

/// What one light is done with.
struct LightMethod {
  visibility::MethodDescription description;  ///< with its options
  visibility::MethodOptions options;
  std::string note;  ///< why light samples are looked at that nobody asked for; else empty
};

/// Exact by default, light by light: where nobody asked for light samples, the first method of the table that gives a
/// light's exact area (`exact_area`) and holds it beside the scene (`span`), with the options that this takes; of a
/// method that was named, only that one, if it does. Where none does, or light samples were asked for, the default
/// method for light samples. An option goes to those chosen methods that have it. Throws UsageError for one that none
/// has, and what describe_method throws.
std::vector<LightMethod> choose_light_methods(const std::vector<visibility::Light>& lights,
                                              const visibility::SceneFloats& scene, const MethodWish& wish);

/// Those lights (indices) that are done by one method with the same options, in the order of the first of each.
std::vector<std::vector<std::size_t>> same_methods(const std::vector<LightMethod>& chosen);

}  // namespace penumbra::app
