// SPDX-License-Identifier: Apache-2.0
// Shadow method in one file outside of Penumbra's tree, compared with Penumbra's methods:
//
//   own_method SCENE -o DIR      compares the method with pcss and hard shadows; the report is DIR/report.html
//
// The method is image-space gathering (Robison and Shirley, Image space gathering, High Performance Graphics 2009): one
// shadow ray a pixel to the light's center gives a hard shadow, which is then averaged over surrounding pixels. The
// averaging width is a penumbra's width by similar triangles: the light's size · (d − b) / b, with d and b the
// distances from the light's center to the receiver and to the nearest blocker of the ray. Both come from the pixel
// itself or, if its ray is free, from surrounding pixels with blocked rays.

#include <penumbra/penumbra.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <optional>

namespace {

using penumbra::Float3, penumbra::Vector;

Vector minus(const Float3& a, const Float3& b) {
  return {double{a[0]} - b[0], double{a[1]} - b[1], double{a[2]} - b[2]};
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double length(const Vector& a) {
  return std::sqrt(dot(a, a));
}

class Gathering final : public penumbra::OwnMethod {
 public:
  explicit Gathering(int radius) : radius_(radius) {}

  void set_scene(const penumbra::MethodScene& scene) override { scene_ = scene; }
  void set_light(const penumbra::MethodLight& light) override { light_ = light; }
  void set_view(const penumbra::MethodView& view) override { view_ = view; }

  void visibility(std::span<const std::uint32_t> pixels, std::span<float> visibility) override {
    const Float3 center = {static_cast<float>(light_.center[0]), static_cast<float>(light_.center[1]),
                           static_cast<float>(light_.center[2])};
    blocked_.assign(view_.p.size(), kNotAsked);
    for (const std::uint32_t pixel : pixels) blocked_[pixel] = nearest_to_light(pixel, center);
    for (std::size_t i = 0; i < pixels.size(); ++i) visibility[i] = gather(pixels[i], center);
  }

 private:
  static constexpr double kNotAsked = -1, kFree = std::numeric_limits<double>::infinity();

  /// Returns the distance from the light's center to the nearest triangle on the segment to the pixel's point, or
  /// kFree.
  [[nodiscard]] double nearest_to_light(std::uint32_t pixel, const Float3& center) const {
    const Vector to_point = minus(view_.p[pixel], center);
    double nearest = 1;
    for (std::size_t t = 0; t < scene_.triangles.size(); ++t) {
      if (scene_.casts[t] == 0 || static_cast<std::int32_t>(t) == view_.triangle[pixel]) continue;
      if (const auto hit = meets(center, to_point, scene_.triangles[t]); hit && *hit < nearest) nearest = *hit;
    }
    return nearest < 1 - 1e-6 ? nearest * length(to_point) : kFree;
  }

  /// Returns t at the intersection of start + t · direction with a triangle, 0 < t < 1 (Möller and Trumbore 1997).
  [[nodiscard]] std::optional<double> meets(const Float3& start, const Vector& direction,
                                            const std::array<std::uint32_t, 3>& corners) const {
    const Float3& a = scene_.positions[corners[0]];
    const Vector ab = minus(scene_.positions[corners[1]], a), ac = minus(scene_.positions[corners[2]], a);
    const Vector normal = cross(direction, ac), from_a = minus(start, a);
    const double determinant = dot(ab, normal);
    if (determinant == 0) return std::nullopt;
    const double u = dot(from_a, normal) / determinant;
    const Vector other = cross(from_a, ab);
    const double v = dot(direction, other) / determinant, t = dot(ac, other) / determinant;
    if (u < 0 || v < 0 || u + v > 1 || t <= 0 || t >= 1) return std::nullopt;
    return t;
  }

  /// Calls f(pixel) for surrounding pixels whose point lies on nearly the same plane.
  template <typename Function>
  void around(std::uint32_t pixel, const Function& f) const {
    const auto width = static_cast<int>(view_.width), height = static_cast<int>(view_.height);
    const int x = static_cast<int>(pixel) % width, y = static_cast<int>(pixel) / width;
    const Float3& n = view_.n[pixel];
    for (int row = std::max(y - radius_, 0); row <= std::min(y + radius_, height - 1); ++row) {
      for (int column = std::max(x - radius_, 0); column <= std::min(x + radius_, width - 1); ++column) {
        const auto other = static_cast<std::uint32_t>(row * width + column);
        if (blocked_[other] == kNotAsked) continue;
        const Vector between = minus(view_.p[other], view_.p[pixel]);
        if (std::abs(dot(between, {n[0], n[1], n[2]})) <= 0.1 * length(between)) f(other, length(between));
      }
    }
  }

  [[nodiscard]] float gather(std::uint32_t pixel, const Float3& center) const {
    double blocker = blocked_[pixel];
    if (blocker == kFree)
      around(pixel, [&](std::uint32_t other, double) { blocker = std::min(blocker, blocked_[other]); });
    if (blocker == kFree) return 1;
    const double distance = length(minus(view_.p[pixel], center));
    const double half_width = light_.radius + std::max(length(light_.u), length(light_.v));
    const double reach = half_width * std::max(distance - blocker, 0.0) / blocker;
    double free = 0, all = 0;
    around(pixel, [&](std::uint32_t other, double away) {
      if (other != pixel && away > reach) return;
      all += 1;
      free += blocked_[other] == kFree ? 1 : 0;
    });
    return static_cast<float>(free / all);
  }

  int radius_;
  penumbra::MethodScene scene_;
  penumbra::MethodLight light_;
  penumbra::MethodView view_;
  std::vector<double> blocked_;  // for each pixel: nearest_to_light, or kNotAsked
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 4 || std::string_view(arguments[2]) != "-o") {
    std::cerr << "usage: own_method SCENE -o DIR\n";
    return 2;
  }
  try {
    penumbra::add_method({.name = "gathering",
                          .family = "image",
                          .paper = "Robison and Shirley, Image space gathering, 2009",
                          .lights = {"rectangle", "disk", "ellipse"},
                          .options = {{.name = "radius",
                                       .default_value = "8",
                                       .help = "radius of the searched neighbourhood, in pixels",
                                       .choices = {},
                                       .least = 0,
                                       .most = 64,
                                       .whole = true}}},
                         [](const std::map<std::string, std::string>& options) {
                           return std::make_unique<Gathering>(std::stoi(options.at("radius")));
                         });
    const std::string metrics = penumbra::compare_json(
        penumbra::Scene::load(arguments[1]), {.methods = {"gathering", "gathering:radius=3", "pcss", "shadow-map"},
                                              .reference = "exact",
                                              .width = 96,
                                              .height = 96,
                                              .runs = 1,
                                              .out = arguments[3]});
    std::cout << metrics << '\n';
  } catch (const penumbra::Error& error) {
    std::cerr << "own_method: " << error.what() << '\n';
    return 1;
  }
}
