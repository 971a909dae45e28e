// SPDX-License-Identifier: Apache-2.0
// Names of families and outputs, and the default implementations in class Method, which refuse requests for masks or
// form factors. No shadow is computed here.

#include "visibility/method.hpp"

#include "base/error.hpp"

namespace penumbra::visibility {
const char* name_of(Family family) {
  switch (family) {
    case Family::reference:
      return "reference";
    case Family::geometry:
      return "geometry";
    case Family::image:
      return "image";
  }
  return "?";
}

const char* name_of(Output output) {
  switch (output) {
    case Output::mask:
      return "mask";
    case Output::scalar:
      return "scalar";
    case Output::radiance:
      return "radiance";
  }
  return "?";
}

void Method::read_masks(std::span<std::uint32_t> masks) {
  throw UsageError(
      "method {} gives only V, not one bit per light sample ({} words requested); take a method whose output "
      "is a mask (see `penumbra methods`)",
      description().name, masks.size());
}

void Method::read_form_factors(std::span<glm::dvec3> form_factors) {
  throw UsageError("method {} does not integrate radiance itself ({} form factors asked for)", description().name,
                   form_factors.size());
}

const std::string& left_to_host(const MethodDescription& description, const Light& light) {
  return description.draws_holes ? light.dimmed_by : light.filtered_by;
}

void check_light(const MethodDescription& description, const Light& light) {
  if (light.texture && !description.textures) {
    throw InputError(
        "light \"{}\" has a texture; method {}, with these options, does not weight V by it. Take another light "
        "(--light) or "
        "method (--method: edge-scatter and raytrace support textures; so do contour, packet and backproject)",
        light.name, description.name);
  }
  if (light.rows == 0 && !description.any_pattern && is_parallelogram(light.kind)) {
    throw InputError(
        "light \"{}\": method {} takes light samples in rows (--sample-pattern rows or grid), not {}; view-sample and "
        "raytrace take any",
        light.name, description.name, name_of(light.pattern));
  }
  if (const std::string& through = left_to_host(description, light);
      !through.empty() && description.output != Output::mask) {
    if (!description.draws_holes && description.output == Output::scalar && !is_dome(light.kind)) {
      throw InputError(
          "light \"{}\": its light passes through \"{}\" (alphaMode MASK or BLEND); method {} finds shadows by the "
          "edges "
          "of triangles, but holes of an alpha texture have other edges. Take a method that draws the holes of "
          "MASK "
          "(--method: shadow-map, pcss, backproject and most maps), or one whose output is a mask (--method: "
          "edge-scatter, view-sample, raytrace): there each light sample is tested separately",
          light.name, through, description.name);
    }
    throw InputError(
        "light \"{}\": its light passes through \"{}\" (alphaMode {}BLEND), which must be tested light sample by light "
        "sample; method {}{} gives only {}. Take a method whose output is a mask (--method: edge-scatter, "
        "view-sample, raytrace; `penumbra methods` lists all)",
        light.name, through, description.draws_holes ? "" : "MASK or ", description.name,
        description.gives_area() ? ", as asked for," : "", description.gives_area() ? "areas" : "V");
  }
  require_kind(
      light, description.lights,
      "; method {}, with these options, supports: {}. Take another light (--light) or method (--method; edge-scatter "
      "and raytrace support every kind)",
      description.name, description.lights.words());
}

MethodOptions complete_options(const MethodDescription& description, const MethodOptions& given) {
  MethodOptions all = given;
  for (const OptionDescription& option : description.options) all.emplace(option.name, option.default_value);
  return all;
}

ParsedOptions parse_options(const MethodDescription& description, const MethodOptions& given) {
  return {description.name, description.options, given};
}

}  // namespace penumbra::visibility
