// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"
#include "volumes/counters/methods.hpp"
#include "volumes/scatter/methods.hpp"
#include "vsm/methods.hpp"

#include <array>
#include <memory>
#include <ostream>
#include <string_view>

namespace penumbra::tests {

/// A method that promises the truth of its pair in every bit.
struct MaskMethod {
  const char* name;
  std::unique_ptr<visibility::Method> (*make)(const render::Device&, const visibility::MethodOptions&);
  bool any_light;        ///< if false, it supports only light samples in rows of a rectangle
  bool no_rows = false;  ///< if true, it gets light samples without the information that they form rows

  [[nodiscard]] bool on_device() const { return !std::string_view(name).starts_with("native"); }

  friend std::ostream& operator<<(std::ostream& out, const MaskMethod& method) { return out << method.name; }
};

template <bool kNative>
std::unique_ptr<visibility::Method> make_view_sample(const render::Device& device,
                                                     const visibility::MethodOptions& given) {
  visibility::MethodOptions options = given;
  options["engine"] = kNative ? "native" : "vulkan";
  return vsm::make_view_sample(device, options);
}
inline constexpr MaskMethod kViewSample{"view_sample", make_view_sample<false>, true};
inline constexpr MaskMethod kNativeViewSample{"native_view_sample", make_view_sample<true>, true};
template <bool kNative>
std::unique_ptr<visibility::Method> make_edge_scatter(const render::Device& device,
                                                      const visibility::MethodOptions& given) {
  visibility::MethodOptions options = given;
  options["engine"] = kNative ? "native" : "vulkan";
  return volumes::make_edge_scatter(device, options);
}
inline constexpr MaskMethod kEdgeScatter{"edge_scatter", make_edge_scatter<false>, true};
inline constexpr MaskMethod kNativeEdgeScatter{"native_edge_scatter", make_edge_scatter<true>, true};

/// The same methods on their code paths for light samples that form no rows.
inline constexpr MaskMethod kEdgeScatterPoints{"edge_scatter_points", make_edge_scatter<false>, true, true};
inline constexpr MaskMethod kNativeEdgeScatterPoints{"native_edge_scatter_points", make_edge_scatter<true>, true, true};

template <bool kNative>
std::unique_ptr<visibility::Method> make_depth_complexity(const render::Device& device,
                                                          const visibility::MethodOptions& given) {
  visibility::MethodOptions options = given;
  options["engine"] = kNative ? "native" : "vulkan";
  return volumes::make_depth_complexity(device, options);
}
inline constexpr MaskMethod kDepthComplexity{"depth_complexity", make_depth_complexity<false>, false};
inline constexpr MaskMethod kNativeDepthComplexity{"native_depth_complexity", make_depth_complexity<true>, true};

/// The two fast methods, each on both engines.
inline constexpr std::array kMaskMethods{kViewSample, kNativeViewSample, kEdgeScatter, kNativeEdgeScatter};
/// All methods that promise every bit.
inline constexpr std::array kAllMaskMethods{kViewSample,        kNativeViewSample,     kEdgeScatter,
                                            kNativeEdgeScatter, kEdgeScatterPoints,    kNativeEdgeScatterPoints,
                                            kDepthComplexity,   kNativeDepthComplexity};
/// Methods that support spheres and suns.
inline constexpr std::array kConeMethods{kNativeEdgeScatter, kNativeViewSample, kNativeDepthComplexity};

}  // namespace penumbra::tests
