// SPDX-License-Identifier: Apache-2.0
// Describes the scene in words.
#include "compare/report.hpp"
#include "compare/report_text.hpp"
#include "compare/scene_words.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <array>
#include <utility>
#include <variant>

namespace penumbra::compare {
namespace {

std::string text_of(const glm::dvec3& v) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", v.x, v.y, v.z);
}

struct ShapeText {
  std::string operator()(const scenes::Rectangle& r) const {
    return fmt::format("a rectangle of {:.4g} × {:.4g} at {}", 2 * glm::length(r.half_u), 2 * glm::length(r.half_v),
                       text_of(r.center));
  }
  std::string operator()(const scenes::Disk& d) const {
    return fmt::format("a disk of radius {:.4g} at {}", d.radius, text_of(d.center));
  }
  std::string operator()(const scenes::Ellipse& e) const {
    return fmt::format("an ellipse with half axes of {:.4g} and {:.4g} at {}", glm::length(e.half_u),
                       glm::length(e.half_v), text_of(e.center));
  }
  std::string operator()(const scenes::Sun& s) const {
    return fmt::format("a sun of {:.4g}° that shines along {}", s.angle, text_of(s.direction));
  }
  std::string operator()(const scenes::Dome& d) const {
    return fmt::format("{} around {}", d.half ? "half a dome" : "a dome", text_of(d.up));
  }
  std::string operator()(const scenes::Polygon& p) const {
    return fmt::format("a polygon of {} corners", p.vertices.size());
  }
  std::string operator()(const scenes::Sphere& s) const {
    const std::string cone = s.cone ? fmt::format(" that shines {:.4g}° to {:.4g}° around {}", s.cone->inner,
                                                  s.cone->outer, text_of(s.cone->direction))
                                    : "";
    return fmt::format("a sphere of radius {:.4g} at {}{}", s.radius, text_of(s.center), cone);
  }
  /// "3 pieces: 2 rectangles, 1 polygon"
  std::string operator()(const scenes::Pieces& light) const {
    constexpr std::array kKinds = {"rectangle", "polygon", "sphere"};
    static_assert(kKinds.size() == std::variant_size_v<scenes::Pieces::Piece>);
    std::array<std::size_t, kKinds.size()> counts{};
    for (const scenes::Pieces::Piece& piece : light.pieces) ++counts.at(piece.index());
    std::string text = fmt::format("{} pieces:", light.pieces.size());
    const char* before = " ";
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
      if (counts.at(kind) == 0) continue;
      text += fmt::format("{}{} {}{}", std::exchange(before, ", "), counts.at(kind), kKinds.at(kind),
                          counts.at(kind) == 1 ? "" : "s");
    }
    return text;
  }
};

std::string texture_text(const scenes::AreaLight& light) {
  if (!light.texture) return "";
  return fmt::format(" times the texture {} of {} × {}", light.texture->file, light.texture->width,
                     light.texture->height);
}

}  // namespace

std::string words_of(const scenes::AreaLight& light) {
  return fmt::format("{}, radiance {}{}{}", std::visit(ShapeText{}, light.shape), text_of(light.radiance),
                     texture_text(light), light.two_sided ? ", from both sides" : "");
}

std::string words_of(const scenes::Camera& camera) {
  return fmt::format("at {}, looking at {}, {}", text_of(camera.eye), text_of(camera.target),
                     camera.height ? fmt::format("orthographic, {:.4g} high", *camera.height)
                                   : fmt::format("{:.4g}° high", camera.vertical_fov));
}

std::vector<ReportFact> describe_scene(const scenes::Scene& scene, std::size_t camera) {
  constexpr std::size_t kNamed = 8;  // number of objects listed by name
  std::string objects;
  for (std::size_t i = 0; i < scene.objects.size() && i < kNamed; ++i)
    objects += (i == 0 ? "" : ", ") + scene.objects[i].name;
  if (scene.objects.size() > kNamed) objects += fmt::format(" and {} more", scene.objects.size() - kNamed);
  std::vector<ReportFact> facts{
      {"Scene", scene.name}, {"Triangles", count_text(scene.soup.triangles.size())}, {"Objects", objects}};
  for (const scenes::AreaLight& light : scene.lights) {
    facts.push_back({fmt::format("Light “{}”", light.name), words_of(light)});
  }
  facts.push_back({"Camera", words_of(scene.cameras.at(camera))});
  return facts;
}

}  // namespace penumbra::compare
