// Lights from scenes: the stored frame, the outline and the light samples. World space in double, minus the origin,
// rounded once to float32: nothing else is ever rounded.

#include "visibility/light_samples.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "visibility/axes_around.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/sample_patterns.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace penumbra::visibility {
namespace {

glm::vec3 to_float(const glm::dvec3& world, const glm::dvec3& origin) {
  return glm::vec3(world - origin) + 0.0f;  // + 0 turns −0 into +0
}

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The least of a triangle's heights: what a corner that rounding moved turns its plane by is in proportion to its
/// inverse.
double least_height(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
  return longest > 0 ? glm::length(glm::cross(b - a, c - a)) / longest : 0;
}

/// How high a triangle of a polygon's stored corners must be for its plane to be the polygon's: so that rounding
/// of one corner, by √3 · 2⁻²⁴ of the largest coordinate at most, turns it by √3 / 128 (.8 degrees) at most, and of all
/// three by twice that: gradients of barycentric coordinates are no longer than 1 / height and add up to 0. Of a
/// polygon that is smaller than that, an eighth of the highest there is, about.
double enough_height(const std::vector<glm::vec3>& corners) {
  const glm::dvec3 first(corners.front());
  glm::dvec3 farthest = first;
  double largest = 0, highest = 0;
  for (const glm::dvec3 corner : corners) {
    if (!(glm::length(corner) < 1e30)) return 0;
    largest = std::max({largest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
    if (glm::length(corner - first) > glm::length(farthest - first)) farthest = corner;
  }
  for (const glm::dvec3 corner : corners) highest = std::max(highest, least_height(first, farthest, corner));
  return std::min(0x1p-17 * largest, highest / 8);
}

/// Unit square to unit disk, areas in proportion: Shirley, Chiu, "A low distortion map between disk and square" (1997).
glm::dvec2 concentric_disk(const glm::dvec2& unit) {
  const double a = 2 * unit.x - 1, b = 2 * unit.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  constexpr double kQuarter = std::numbers::pi / 4;
  const bool wide = std::abs(a) > std::abs(b);
  const double radius = wide ? a : b;
  const double angle = wide ? kQuarter * (b / a) : 2 * kQuarter - kQuarter * (a / b);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Of a light in pieces, a piece like this is left out; any other light is refused.
struct NoArea : InputError {
  using InputError::InputError;
};

/// What the shapes have in common while a light is being made.
struct Builder {
  Light& light;
  const glm::dvec3& origin;
  const std::vector<glm::dvec2>& unit;

  [[nodiscard]] glm::vec3 stored(const glm::dvec3& world) const { return to_float(world, origin); }

  [[noreturn]] void refuse_zero_area(const std::string& detail) const {
    throw NoArea("light \"{}\": its area is zero{}; an area light needs a shape with an area", light.name, detail);
  }

  /// The frame must span a plane after rounding too, and emit to the side it was meant to.
  void store_frame(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) const {
    light.center = stored(center);
    light.center_u = stored(u);
    light.center_v = stored(v);
    if (!finite(light.center) || !finite(light.center_u) || !finite(light.center_v)) return;  // make_light refuses it
    const LightFrame frame = light_frame(light);
    const glm::dvec3 normal = glm::cross(frame.u, frame.v);
    if (collinear(light.center, light.center_u, light.center_v) ||
        !(glm::dot(normal, glm::cross(u - center, v - center)) > 0)) {
      refuse_zero_area(" in float32 relative to the scene's origin");
    }
  }

  void add(const glm::dvec2& coordinate, const glm::dvec3& world) const {
    light.coordinates.push_back(coordinate);
    light.points.push_back(stored(world));
  }

  void operator()(const scenes::Rectangle& shape) const {
    const glm::dvec3 &c = shape.center, &u = shape.half_u, &v = shape.half_v;
    light.kind = LightKind::rectangle;
    light.area = 4 * glm::length(glm::cross(u, v));
    if (!(light.area > 0)) refuse_zero_area(" (halfU and halfV are parallel or zero)");
    store_frame(c, c + u, c + v);
    light.outline = {stored(c - u - v), stored(c + u - v), stored(c + u + v), stored(c - u + v)};
    for (const glm::dvec2& sample : unit) {
      const glm::dvec2 st = 2.0 * sample - 1.0;
      add(st, c + st.x * u + st.y * v);
    }
  }

  /// The unit disk of a frame.
  void add_round(const glm::dvec3& c, const glm::dvec3& u, const glm::dvec3& v) const {
    store_frame(c, c + u, c + v);
    light.outline = {stored(c - u - v), stored(c + u - v), stored(c + u + v), stored(c - u + v)};
    for (const glm::dvec2& sample : unit) {
      const glm::dvec2 st = concentric_disk(sample);
      add(st, c + st.x * u + st.y * v);
    }
  }

  void operator()(const scenes::Ellipse& shape) const {
    light.kind = LightKind::ellipse;
    light.area = std::numbers::pi * glm::length(glm::cross(shape.half_u, shape.half_v));
    if (!(light.area > 0)) refuse_zero_area(" (halfU and halfV are parallel or zero)");
    add_round(shape.center, shape.half_u, shape.half_v);
  }

  void operator()(const scenes::Disk& shape) const {
    light.kind = LightKind::disk;
    light.radius = shape.radius;
    const double length = glm::length(shape.normal);
    if (!(shape.radius > 0)) refuse_zero_area(" (its radius is not positive)");
    if (!(length > 0)) refuse_zero_area(" (its normal is zero)");
    light.area = std::numbers::pi * shape.radius * shape.radius;
    const Axes axes = axes_around(shape.normal / length);
    add_round(shape.center, shape.radius * axes.u, shape.radius * axes.v);
  }

  void operator()(const scenes::Polygon& shape) const;
  void operator()(const scenes::Pieces& shape) const;

  void operator()(const scenes::Sphere& shape) const {
    light.kind = LightKind::sphere;
    light.radius = shape.radius;
    if (!(shape.radius > 0)) refuse_zero_area(" (its radius is not positive)");
    light.area = std::numbers::pi * shape.radius * shape.radius;
    light.center = light.center_u = light.center_v = stored(shape.center);
    if (!finite(stored(shape.center + shape.radius)) || !finite(stored(shape.center - shape.radius))) {
      light.center.x = std::numeric_limits<float>::infinity();  // refused by make_light
    }
    for (const glm::dvec2& sample : unit) light.coordinates.push_back(concentric_disk(sample));
    if (!shape.cone) return;
    const double inner = std::cos(glm::radians(shape.cone->inner)), outer = std::cos(glm::radians(shape.cone->outer));
    const double scale = 1 / std::max(0.001, inner - outer);
    light.spot = Light::Spot{glm::normalize(shape.cone->direction), scale, -outer * scale, shape.cone->smooth};
  }

  void operator()(const scenes::Sun& shape) const {
    light.kind = LightKind::sun;
    const double length = glm::length(shape.direction);
    if (!(length > 0) || !(shape.angle >= 0 && shape.angle < 180)) {
      throw InputError(
          "light \"{}\": a sun needs a direction and an angle from 0 to less than 180 degrees; they are ({}, {}, {}) "
          "and {}",
          light.name, shape.direction.x, shape.direction.y, shape.direction.z, shape.angle);
    }
    const glm::dvec3 travels = shape.direction / length;
    const Axes axes = axes_around(travels);
    const double tangent = std::tan(glm::radians(shape.angle) / 2);
    light.sun = Light::Directions{glm::vec3(axes.u) + 0.0f, glm::vec3(axes.v) + 0.0f, tangent};
    light.area = std::numbers::pi * tangent * tangent;
    light.center = light.center_u = light.center_v = glm::vec3(-travels) + 0.0f;
    if (tangent == 0) light.radiance /= std::numbers::pi;
    for (const glm::dvec2& sample : unit) {
      const glm::dvec2 st = concentric_disk(sample);
      light.coordinates.push_back(st);
      light.points.push_back(glm::vec3(-travels + tangent * (st.x * axes.u + st.y * axes.v)) + 0.0f);
    }
  }
};

/// A fan around the first corner: x runs along the far edges in proportion to the fan triangles' areas, √y from the
/// corner outward. Continuous, and areas stay in proportion: d(area) = 2·A·√y · d√y · dx' = A dy dx'.
void Builder::operator()(const scenes::Polygon& shape) const {
  light.kind = LightKind::polygon;
  const std::vector<glm::dvec3>& corners = shape.vertices;
  const std::size_t count = corners.size();
  if (count < 3) refuse_zero_area(" (a polygon needs three corners)");

  std::vector<double> area_up_to(count - 1, 0.0);  // of the fan triangles 1 … i; triangle i has corners 0, i, i + 1
  glm::dvec3 normal{0};                            // twice the polygon's area long
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const glm::dvec3 doubled = glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    normal += doubled;
    area_up_to[i] = area_up_to[i - 1] + glm::length(doubled) / 2;
  }
  light.area = area_up_to.back();
  if (!(light.area > 0)) refuse_zero_area(" (its corners lie on a line)");
  for (const glm::dvec3& corner : corners) light.outline.push_back(stored(corner));

  // The plane of condition (2): the first three corners that are not on a line, nor so nearly that rounding would
  // choose the plane. If rounding has turned them, they are swapped so that the light still emits to the side it was
  // meant to.
  const double enough = enough_height(light.outline);
  bool found = false;
  for (std::size_t i = 0; i < count && !found; ++i) {
    for (std::size_t j = i + 1; j < count && !found; ++j) {
      for (std::size_t k = j + 1; k < count && !found; ++k) {
        const glm::vec3 &a = light.outline[i], &b = light.outline[j], &c = light.outline[k];
        if (!finite(a) || !finite(b) || !finite(c) || collinear(a, b, c) || least_height(a, b, c) < enough) continue;
        const glm::dvec3 stored_normal = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
        const bool turned = glm::dot(stored_normal, normal) < 0;
        light.center = a;
        light.center_u = turned ? c : b;
        light.center_v = turned ? b : c;
        found = true;
      }
    }
  }
  const bool all_finite = std::all_of(light.outline.begin(), light.outline.end(), finite);
  if (!found && all_finite) refuse_zero_area(" in float32 relative to the scene's origin");

  // Coordinates: [−1, 1]² over the polygon's bounding rectangle, x along the fan's longest spoke.
  glm::dvec3 spoke{0};
  for (const glm::dvec3& corner : corners) {
    if (glm::length(corner - corners[0]) > glm::length(spoke)) spoke = corner - corners[0];
  }
  const glm::dvec3 x_axis = spoke / glm::length(spoke), y_axis = glm::cross(normal / glm::length(normal), x_axis);
  const auto flat = [&](const glm::dvec3& q) {
    return glm::dvec2(glm::dot(q - corners[0], x_axis), glm::dot(q - corners[0], y_axis));
  };
  glm::dvec2 lower = flat(corners[0]), upper = lower;
  for (const glm::dvec3& corner : corners) {
    lower = glm::min(lower, flat(corner));
    upper = glm::max(upper, flat(corner));
  }

  for (const glm::dvec2& sample : unit) {
    const double along = sample.x * light.area;
    std::size_t i = 1;
    while (i + 2 < count && along >= area_up_to[i]) ++i;
    const double fraction = std::clamp((along - area_up_to[i - 1]) / (area_up_to[i] - area_up_to[i - 1]), 0.0, 1.0);
    const glm::dvec3 far_point = corners[i] + fraction * (corners[i + 1] - corners[i]);
    const glm::dvec3 world = corners[0] + std::sqrt(sample.y) * (far_point - corners[0]);
    add(glm::clamp(2.0 * (flat(world) - lower) / (upper - lower) - 1.0, -1.0, 1.0), world);
  }
}

void Builder::operator()(const scenes::Pieces& shape) const {
  throw InputError("light \"{}\" is cut in {} pieces, and what was asked for is of one; take another light", light.name,
                   shape.pieces.size());
}

void add_texture(Light& light, const scenes::Texture& source) {
  PENUMBRA_ASSERT(light.kind == LightKind::rectangle, "light \"{}\" is a {} with a texture", light.name,
                  name_of(light.kind));
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
  for (std::size_t i = 0; i < scene.objects.size() && light.filtered_by.empty(); ++i) {
    const scenes::Object& object = scene.objects[i];
    const bool own_body = object.emits == light_index;
    const bool casts = object.casts_shadow && (light.unshaded_by.empty() || light.unshaded_by[i] == 0) && !own_body;
    if (casts && object.alpha.mode != scenes::Alpha::Mode::opaque) light.filtered_by = object.name;
  }
}

/// Which of a scene's lights, or which piece of it, and what shape that is.
struct Part {
  const scenes::Scene& scene;
  std::uint32_t light_index, piece;
};

template <typename Shape>
Light make_part(const Part& part, const Shape& shape, const glm::dvec3& origin, const SampleRequest& request,
                std::vector<std::string>* notes) {
  const auto& [scene, light_index, piece] = part;
  const scenes::AreaLight& source = scene.lights.at(light_index);
  const SampleLayout layout = layout_of(request);
  Light light;
  light.name = source.name;
  light.index = static_cast<std::int32_t>(light_index);
  light.piece = piece;
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
  std::visit(Builder{light, origin, unit}, shape);
  const auto all_finite = [](const std::vector<glm::vec3>& points) {
    return std::all_of(points.begin(), points.end(), finite);
  };
  if (!finite(light.center) || !finite(light.center_u) || !finite(light.center_v) || !all_finite(light.outline) ||
      !all_finite(light.points) || !std::isfinite(light.area)) {
    throw InputError("light \"{}\": its position relative to the scene's origin ({}, {}, {}) is not finite in float32",
                     light.name, origin.x, origin.y, origin.z);
  }
  if (source.texture) add_texture(light, *source.texture);
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
  for (const scenes::Pieces::Piece& shape : cut->pieces) {
    const auto piece = static_cast<std::uint32_t>(pieces.size());
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
