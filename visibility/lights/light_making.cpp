// SPDX-License-Identifier: Apache-2.0
// Makes lights from scenes, independent of their kind. Frames, outlines and light samples: lights/kinds/.

#include "visibility/light_samples.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "visibility/lights/kinds/light_kinds.hpp"
#include "visibility/sample_patterns.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

namespace penumbra::visibility {
namespace {

void add_texture(Light& light, const scenes::Texture& source) {
  PENUMBRA_ASSERT(is_parallelogram(light.kind), "light \"{}\" is a {} with a texture", light.name, name_of(light.kind));
  light.texture = make_light_texture(source);
  light.weights = sample_weights(*light.texture, light.coordinates, light.name);
  for (const glm::dvec2& st : light.coordinates) {
    light.sample_colors.push_back(light.texture->colors[light.texture->texel_at(st)]);
  }
}

void add_links(Light& light, const scenes::Scene& scene, std::uint32_t light_index) {
  const std::vector<std::uint32_t>& passed = scene.lights[light_index].unshaded_by;
  if (!passed.empty()) light.unshaded_by.assign(scene.objects.size(), 0);
  for (const std::uint32_t object : passed) light.unshaded_by.at(object) = 1;
  for (std::size_t object = 0; object < scene.objects.size(); ++object) {
    const auto& lit_by = scene.objects[object].lit_by;
    if (!lit_by || std::ranges::find(*lit_by, light_index) != lit_by->end()) continue;
    light.unlit.resize(scene.objects.size());
    light.unlit[object] = 1;
  }
  for (std::size_t i = 0; i < scene.objects.size() && light.dimmed_by.empty(); ++i) {
    const scenes::Object& object = scene.objects[i];
    const bool own_body = object.emits == light_index;
    const bool casts = object.casts_shadow && (light.unshaded_by.empty() || light.unshaded_by[i] == 0) && !own_body;
    if (!casts || object.alpha.mode == scenes::Alpha::Mode::opaque) continue;
    if (light.filtered_by.empty()) light.filtered_by = object.name;
    if (object.alpha.mode == scenes::Alpha::Mode::blend) light.dimmed_by = object.name;
  }
}

/// One of a scene's lights, or a piece of it.
struct Part {
  const scenes::Scene& scene;
  std::uint32_t light_index, piece;
};

Light make_part(const Part& part, const scenes::LightShape& shape, const glm::dvec3& origin,
                const SampleRequest& request, std::vector<std::string>* notes) {
  const auto& [scene, light_index, piece] = part;
  const scenes::AreaLight& source = scene.lights.at(light_index);
  const std::optional<LightKind> kind = scenes::kind_of(shape);
  if (!kind) {
    throw InputError(
        "light \"{}\" consists of {} pieces, but this result needs a light of one piece; take another light",
        source.name, std::get<scenes::Pieces>(shape).pieces.size());
  }
  const SampleLayout layout = layout_of(request);
  Light light;
  light.name = source.name;
  light.index = static_cast<std::int32_t>(light_index);
  light.piece = piece;
  light.kind = *kind;
  light.two_sided = source.two_sided;
  light.radiance = source.radiance;
  light.pattern = request.pattern;
  if (request.pattern == SamplePattern::rows || request.pattern == SamplePattern::grid) {
    light.rows = layout.rows;
    light.columns = layout.columns;
    if (notes != nullptr && request.rows == 0 && layout.count != request.count) {
      notes->push_back(fmt::format("light samples: {} rounded up to {} rows of {} = {} by pattern {}", request.count,
                                   layout.rows, layout.columns, layout.count, name_of(request.pattern)));
    }
  }
  if (request.pattern == SamplePattern::rgss && notes != nullptr) {
    const std::uint32_t wanted = request.rows != 0 ? request.rows * request.columns : request.count;
    if (layout.count != wanted) {
      notes->push_back(fmt::format("light samples: {} rounded up to {} x {} squares of four = {} by pattern {}", wanted,
                                   layout.rows, layout.columns, layout.count, name_of(request.pattern)));
    }
  }
  if (request.pattern == SamplePattern::rows) {
    for (std::uint32_t row = 0; row < layout.rows; ++row) light.row_shift.push_back(row_shift_of(row));
  }

  const std::vector<glm::dvec2> unit = unit_square_samples(request);
  behaviour_of(*kind).make(shape, {light, origin, unit, source.texture && is_dome(*kind) ? &*source.texture : nullptr});
  const auto all_finite = [](const std::vector<glm::vec3>& points) {
    return std::all_of(points.begin(), points.end(), is_finite_point);
  };
  if (!is_finite_point(light.center) || !is_finite_point(light.center_u) || !is_finite_point(light.center_v) ||
      !all_finite(light.outline) || !all_finite(light.points) || !std::isfinite(light.area)) {
    throw InputError("light \"{}\": its position relative to the scene's origin ({}, {}, {}) is not finite in float32",
                     light.name, origin.x, origin.y, origin.z);
  }
  if (source.texture && !is_dome(*kind)) add_texture(light, *source.texture);
  add_links(light, scene, light_index);
  return light;
}

}  // namespace

Light make_light(const scenes::Scene& scene, std::uint32_t light_index, const glm::dvec3& origin,
                 const SampleRequest& request, std::vector<std::string>* notes) {
  return make_part({scene, light_index, 0}, scene.lights.at(light_index).shape, origin, request, notes);
}

std::vector<Light> make_light_pieces(const scenes::Scene& scene, std::uint32_t light_index, const glm::dvec3& origin,
                                     const SampleRequest& request, std::vector<std::string>* notes) {
  const auto* cut = std::get_if<scenes::Pieces>(&scene.lights.at(light_index).shape);
  if (cut == nullptr) return {make_light(scene, light_index, origin, request, notes)};
  std::vector<Light> pieces;
  std::optional<NoArea> thin;
  for (const scenes::Pieces::Piece& one : cut->pieces) {
    const auto piece = static_cast<std::uint32_t>(pieces.size());
    const scenes::LightShape shape = std::visit([](const auto& its) { return scenes::LightShape(its); }, one);
    try {
      pieces.push_back(make_part({scene, light_index, piece}, shape, origin, request, piece == 0 ? notes : nullptr));
    } catch (const NoArea& error) {
      thin = error;
    }
  }
  if (pieces.empty()) throw NoArea(*thin);
  return pieces;
}

}  // namespace penumbra::visibility
