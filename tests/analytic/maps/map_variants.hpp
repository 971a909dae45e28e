// SPDX-License-Identifier: Apache-2.0
#pragma once

// Methods of maps/ written as on the command line: "bitmask:occluder=quad:layers=2".

#include "maps/filters/methods.hpp"
#include "tests/analytic/maps/fixture.hpp"

#include <map>
#include <sstream>
#include <string>
#include <utility>

namespace penumbra::tests {

/// A method and its options.
struct MapVariant {
  std::string method;
  visibility::MethodOptions options;

  explicit MapVariant(const std::string& words) {
    std::stringstream fields(words);
    std::getline(fields, method, ':');
    for (std::string field; std::getline(fields, field, ':');) {
      const std::size_t equals = field.find('=');
      options[field.substr(0, equals)] = field.substr(equals + 1);
    }
  }
  /// Returns this variant with these values for options that it does not set itself.
  [[nodiscard]] MapVariant with(const visibility::MethodOptions& more) const {
    MapVariant variant = *this;
    variant.options.insert(more.begin(), more.end());
    return variant;
  }
  [[nodiscard]] std::unique_ptr<visibility::Method> make(const render::Device& device) const {
    static const std::map<std::string, Factory> factories{{"shadow-map", maps::make_shadow_map},
                                                          {"silhouette-map", maps::make_silhouette_map},
                                                          {"forward-map", maps::make_forward_map},
                                                          {"pcf", maps::make_pcf},
                                                          {"pcss", maps::make_pcss},
                                                          {"vssm", maps::make_vssm},
                                                          {"convolution", maps::make_convolution},
                                                          {"occlusion-textures", maps::make_occlusion_textures},
                                                          {"backproject", maps::make_backproject},
                                                          {"backproject-peel", maps::make_backproject_peel},
                                                          {"bitmask", maps::make_bitmask},
                                                          {"layer-rays", maps::make_layer_rays},
                                                          {"penumbra-map", maps::make_penumbra_map},
                                                          {"smoothies", maps::make_smoothies},
                                                          {"brabec-seidel", maps::make_brabec_seidel},
                                                          {"kirsch-doellner", maps::make_kirsch_doellner},
                                                          {"parker", maps::make_parker},
                                                          {"arvo", maps::make_arvo},
                                                          {"contour", maps::make_contour},
                                                          {"packet", maps::make_packet},
                                                          {"soft-shadow-map", maps::make_soft_shadow_map},
                                                          {"accumulate", maps::make_accumulate},
                                                          {"adaptive-light", maps::make_adaptive_light},
                                                          {"deep-penumbra", maps::make_deep_penumbra},
                                                          {"layered-attenuation", maps::make_layered_attenuation}};
    return factories.at(method)(device, options);
  }
};

}  // namespace penumbra::tests
