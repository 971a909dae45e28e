// SPDX-License-Identifier: Apache-2.0
// Draws two views of a mesh with its defects: view samples of a camera, shaded by a light at the eye, with lines over
// them.

#include "app/inspect/defect_picture.hpp"

#include "app/inspect/export.hpp"
#include "engines/vectors/scan_conversion.hpp"
#include "mesh/soup_ply.hpp"
#include "scenes/whole_view.hpp"
#include "visibility/view_samples.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::app {
namespace {

constexpr std::uint32_t kFine = 2;  ///< pixels of the views along a side of each pixel of the picture
constexpr float kHalfWidth = 2.0F;  ///< of lines, in pixels of the views
constexpr glm::vec3 kBackground{255};

/// View, in sRGB values of 0 to 255 for each channel.
class View {
 public:
  View(const visibility::SceneFloats& scene, const scenes::Camera& camera, std::uint32_t side)
      : camera_(visibility::make_camera(camera, scene.origin, side, side)),
        samples_(vectors::scan_view_samples(scene, camera_)),
        colors_(samples_.size(), kBackground),
        size_(glm::distance(scene.lower, scene.upper)) {}

  void shade(const std::vector<mesh::Color>& colors) {
    for (std::size_t i = 0; i < colors_.size(); ++i) {
      if (samples_.triangle[i] == visibility::ViewSamples::kBackground) continue;
      const glm::vec3 toward = glm::normalize(samples_.eye - samples_.p[i]);
      const float light = 0.35F + 0.65F * std::abs(glm::dot(samples_.n[i], toward));
      colors_[i] = bytes_of(colors[static_cast<std::size_t>(samples_.triangle[i])]) * light;
    }
  }

  /// Draws a line between two points relative to the scene's origin; a dot if they are equal.
  void draw(const glm::dvec3& a, const glm::dvec3& b, mesh::Color color, float half_width) {
    const glm::dvec3 from = place(a), to = place(b);
    if (!(from.z > 0) || !(to.z > 0)) return;
    const double length = glm::length(glm::dvec2(to) - glm::dvec2(from));
    if (!std::isfinite(length)) return;
    const auto steps = static_cast<std::uint32_t>(std::clamp(std::ceil(2 * length), 1.0, 8.0 * camera_.width));
    for (std::uint32_t i = 0; i <= steps; ++i)
      dot(glm::mix(from, to, static_cast<double>(i) / steps), bytes_of(color), half_width);
  }

  /// Paints the drawn lines over the surface.
  void finish() {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (lines_[i].w > 0) colors_[i] = glm::mix(colors_[i], glm::vec3(lines_[i]), lines_[i].w);
    }
  }

  [[nodiscard]] const std::vector<glm::vec3>& colors() const { return colors_; }

 private:
  static glm::vec3 bytes_of(mesh::Color color) { return {color[0], color[1], color[2]}; }

  /// Returns the position of a point, in pixels, and its depth.
  [[nodiscard]] glm::dvec3 place(const glm::dvec3& p) const {
    const glm::dvec3 seen = p - camera_.eye;
    const double depth = glm::dot(seen, camera_.forward);
    const double x = glm::dot(seen, camera_.screen_across()) / depth,
                 y = glm::dot(seen, camera_.screen_upward()) / depth;
    return {(x + 1) / 2 * camera_.width, (1 - y) / 2 * camera_.height, depth};
  }

  void dot(const glm::dvec3& at, const glm::vec3& color, float half_width) {
    const auto first = [&](double middle) { return static_cast<int>(std::floor(middle - half_width)); };
    const auto last = [&](double middle) { return static_cast<int>(std::ceil(middle + half_width)); };
    for (int y = first(at.y); y <= last(at.y); ++y) {
      for (int x = first(at.x); x <= last(at.x); ++x) {
        if (x < 0 || y < 0 || x >= static_cast<int>(camera_.width) || y >= static_cast<int>(camera_.height)) continue;
        if (std::hypot(x + 0.5 - at.x, y + 0.5 - at.y) > half_width) continue;
        const std::size_t pixel = static_cast<std::size_t>(y) * camera_.width + static_cast<std::size_t>(x);
        const bool covered = samples_.triangle[pixel] != visibility::ViewSamples::kBackground;
        const bool hidden = covered && at.z > static_cast<double>(samples_.depth[pixel]) + 0.01 * size_;
        const glm::vec4 paint(color, hidden ? 0.35F : 1.0F);
        lines_.resize(colors_.size());
        if (paint.w >= lines_[pixel].w) lines_[pixel] = paint;
      }
    }
  }

  visibility::PinholeCamera camera_;
  visibility::ViewSamples samples_;
  std::vector<glm::vec3> colors_;
  std::vector<glm::vec4> lines_;  // colour, and its coverage of the surface; empty: no line yet
  double size_;
};

scenes::Bounds bounds_of_triangles(const session::ObjectReport& report) {
  return {report.diagnosis.lower, report.diagnosis.upper};
}

}  // namespace

Image8 defect_picture(const mesh::TriangleSoup& soup, const session::ObjectReport& report, std::uint32_t side) {
  const MarkedMesh marked = mark_defects(soup, report);
  const visibility::SceneFloats scene = visibility::make_scene_floats(session::scene_of(soup, "mesh"));
  scenes::Camera camera = scenes::camera_that_sees_all(bounds_of_triangles(report));
  Image8 image{2 * side, side, std::vector<Color8>(std::size_t{2} * side * side)};
  for (std::uint32_t half = 0; half < 2; ++half) {
    View view(scene, camera, kFine * side);
    view.shade(marked.ply.triangle_colors);
    const auto at = [&](std::uint32_t i) { return marked.ply.positions[i] - scene.origin; };
    for (const mesh::PlyEdge& edge : marked.ply.edges) view.draw(at(edge.a), at(edge.b), edge.color, kHalfWidth);
    for (const auto& [point, color] : marked.points) {
      view.draw(point - scene.origin, point - scene.origin, color, 2 * kHalfWidth);
    }
    view.finish();
    const std::size_t row = std::size_t{kFine} * side;  // pixels of the view
    for (std::size_t y = 0; y < side; ++y) {
      for (std::size_t x = 0; x < side; ++x) {
        glm::vec3 sum(0);
        for (std::size_t i = 0; i < std::size_t{kFine} * kFine; ++i)
          sum += view.colors()[(kFine * y + i / kFine) * row + kFine * x + i % kFine];
        const glm::vec3 mean = glm::round(sum / static_cast<float>(kFine * kFine));
        Color8& pixel = image.pixels[y * image.width + std::size_t{half} * side + x];
        pixel = {static_cast<std::uint8_t>(mean.x), static_cast<std::uint8_t>(mean.y),
                 static_cast<std::uint8_t>(mean.z)};
      }
    }
    camera.eye = camera.target - (camera.eye - camera.target);
  }
  return image;
}

}  // namespace penumbra::app
