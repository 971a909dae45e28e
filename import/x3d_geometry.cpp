// SPDX-License-Identifier: Apache-2.0
// Polygons of X3D geometry nodes (ISO/IEC 19775-1, 11 and 13): lists as they are, fans and strips as triangles, round
// solids with kX3dSides sides, and extrusions along their spine.

#include "import/x3d_geometry.hpp"

#include "import/text.hpp"
#include "import/x3d_spine.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace penumbra::import {
namespace {

/// Returns the next word between blanks and commas; empty at the end.
std::string_view take_value(std::string_view& text) {
  constexpr std::string_view kBetween = " ,\t\r\n\v\f";
  text.remove_prefix(std::min(text.find_first_not_of(kBetween), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBetween));
  text.remove_prefix(word.size());
  return word;
}

template <typename Value>
std::vector<double> reals(const pugi::xml_node& node, const char* name, const Value& value_of) {
  std::vector<double> values;
  std::string_view text = node.attribute(name).value();
  for (std::string_view word; !(word = take_value(text)).empty();) values.push_back(value_of(std::string(word)));
  return values;
}

std::vector<std::int32_t> integers(const XmlText& xml, const pugi::xml_node& node, const char* name) {
  std::vector<std::int32_t> values;
  std::string_view text = node.attribute(name).value();
  for (std::string_view word; !(word = take_value(text)).empty();) {
    const auto value = parse_number<std::int32_t>(word);
    if (!value) xml.fail(node, "{}: '{}' is no integer of 32 bits", name, mesh::printable(word));
    values.push_back(*value);
  }
  return values;
}

bool flag(const pugi::xml_node& node, const char* name, bool fallback) {
  const pugi::xml_attribute attribute = node.attribute(name);
  return attribute ? attribute.as_bool() : fallback;
}

double real(const XmlText& xml, const pugi::xml_node& node, const char* name, double fallback) {
  return x3d_reals(xml, node, name, {fallback}).front();
}

/// One geometry node; its positions begin at the end of the part.
class Geometry {
 public:
  Geometry(const XmlText& xml, const pugi::xml_node& node, const X3dResolve& resolve, AssemblyPart& part)
      : xml_(xml), node_(node), resolve_(resolve), part_(part), first_(part.positions.size()) {}

  void indexed_face_set() {
    take_coordinates();
    add_runs(integers(xml_, node_, "coordIndex"), [&](std::span<const std::int32_t> face) { add(face); });
  }
  void faces_of(std::size_t corners, bool indexed) {
    take_coordinates();
    const std::vector<std::int32_t> order = indexed ? integers(xml_, node_, "index") : all_in_order();
    if (order.size() % corners != 0) {
      xml_.fail(node_, "<{}> has {} corners, which is no multiple of {}", node_.name(), order.size(), corners);
    }
    for (std::size_t i = 0; i < order.size(); i += corners) add(std::span(order).subspan(i, corners));
  }
  void fans_or_strips(bool strips, bool indexed, const char* counts) {
    take_coordinates();
    const auto add_run = [&](std::span<const std::int32_t> run) {
      for (std::size_t i = 2; i < run.size(); ++i) {
        if (strips)
          add(std::array{run[i - 2 + i % 2], run[i - 1 - i % 2], run[i]});
        else
          add(std::array{run[0], run[i - 1], run[i]});
      }
    };
    if (indexed) return add_runs(integers(xml_, node_, "index"), add_run);
    const std::vector<std::int32_t> order = all_in_order();
    std::size_t at = 0;
    for (const std::int32_t count : integers(xml_, node_, counts)) {
      if (count < 3 || static_cast<std::size_t>(count) > order.size() - at)
        xml_.fail(node_, "{}: {} corners, but {} are left", counts, count, order.size() - at);
      add_run(std::span(order).subspan(at, static_cast<std::size_t>(count)));
      at += static_cast<std::size_t>(count);
    }
  }

  void elevation_grid() {
    const auto dimension = [&](const char* name) {
      const auto values = integers(xml_, node_, name);
      return values.size() == 1 && values[0] > 0 ? static_cast<std::size_t>(values[0]) : 0;
    };
    const std::size_t columns = dimension("xDimension"), rows = dimension("zDimension");
    const double dx = real(xml_, node_, "xSpacing", 1), dz = real(xml_, node_, "zSpacing", 1);
    const std::vector<double> heights = x3d_reals(xml_, node_, "height");
    if (heights.size() != columns * rows) {
      xml_.fail(node_, "<ElevationGrid> of {} x {} points has {} heights", columns, rows, heights.size());
    }
    for (std::size_t j = 0; j < rows; ++j) {
      for (std::size_t i = 0; i < columns; ++i) {
        part_.positions.emplace_back(static_cast<double>(i) * dx, heights[j * columns + i],
                                     static_cast<double>(j) * dz);
      }
    }
    add_grid(rows, columns, [&](std::size_t j, std::size_t i) { return j * columns + i; });
  }

  void box() {
    const std::vector<double> size = x3d_reals(xml_, node_, "size", {2, 2, 2});
    for (int i = 0; i < 8; ++i) {
      const auto at = [&](int axis) { return (i >> axis & 1 ? 0.5 : -0.5) * size[static_cast<std::size_t>(axis)]; };
      part_.positions.emplace_back(at(0), at(1), at(2));
    }
    for (const auto& face :
         {std::array{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}})
      add(face);
  }

  void sphere() {
    const double radius = real(xml_, node_, "radius", 1);
    constexpr int kStacks = kX3dSides / 2;
    const auto south = point({0, -radius, 0});
    std::vector<std::vector<std::int32_t>> rings;
    for (int i = 1; i < kStacks; ++i) {
      const double angle = std::numbers::pi * i / kStacks;
      rings.push_back(ring(radius * std::sin(angle), -radius * std::cos(angle)));
    }
    const auto north = point({0, radius, 0});
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) join(rings[i], rings[i + 1]);
    to_tip(rings.front(), south, false);
    to_tip(rings.back(), north, true);
  }
  void cone() {
    const double height = real(xml_, node_, "height", 2);
    const auto base = ring(real(xml_, node_, "bottomRadius", 1), -height / 2);
    if (flag(node_, "side", true)) to_tip(base, point({0, height / 2, 0}), true);
    if (flag(node_, "bottom", true)) add(reversed(base));
  }
  void cylinder() {
    const double height = real(xml_, node_, "height", 2), radius = real(xml_, node_, "radius", 1);
    const auto low = ring(radius, -height / 2), high = ring(radius, height / 2);
    if (flag(node_, "side", true)) join(low, high);
    if (flag(node_, "bottom", true)) add(reversed(low));
    if (flag(node_, "top", true)) add(high);
  }

  void rectangle_2d() {
    const std::vector<double> size = x3d_reals(xml_, node_, "size", {2, 2});
    for (const auto& [x, y] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
      part_.positions.emplace_back(x * size[0], y * size[1], 0);
    add(std::array{0, 1, 2, 3});
  }
  void triangle_set_2d() {
    const std::vector<double> at = x3d_reals(xml_, node_, "vertices");
    if (at.size() % 6 != 0) xml_.fail(node_, "<TriangleSet2D> has {} numbers, which is no multiple of 6", at.size());
    for (std::size_t i = 0; i < at.size(); i += 2) part_.positions.emplace_back(at[i], at[i + 1], 0);
    const auto order = all_in_order();
    for (std::size_t i = 0; i < order.size(); i += 3) add(std::span(order).subspan(i, 3));
  }
  void disk_2d() {
    const double inner = real(xml_, node_, "innerRadius", 0);
    const auto outline = circle(real(xml_, node_, "outerRadius", 1));
    if (inner == 0) return add(outline);
    join(outline, circle(inner));
  }

  /// Adds an extrusion (ISO/IEC 19775-1, 13.3.5): the cross-section, scaled and rotated, in a plane across the spine at
  /// each of the spine's points.
  void extrusion() {
    const std::vector<double> section = x3d_reals(xml_, node_, "crossSection"),
                              scales = x3d_reals(xml_, node_, "scale"), turns = x3d_reals(xml_, node_, "orientation"),
                              along = x3d_reals(xml_, node_, "spine");
    if (section.size() % 2 != 0 || scales.size() % 2 != 0 || turns.size() % 4 != 0 || along.size() % 3 != 0)
      xml_.fail(node_, "<Extrusion>: a list of numbers ends in the middle of a point");
    std::vector<glm::dvec2> outline;
    for (std::size_t i = 0; i < section.size(); i += 2) outline.emplace_back(section[i], section[i + 1]);
    if (section.empty()) outline = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1}};
    std::vector<glm::dvec3> spine;
    for (std::size_t i = 0; i < along.size(); i += 3) spine.emplace_back(along[i], along[i + 1], along[i + 2]);
    if (along.empty()) spine = {{0, 0, 0}, {0, 1, 0}};
    if (spine.size() < 2 || outline.size() < 2) xml_.fail(node_, "<Extrusion> needs two points of each of its lists");

    const std::vector<glm::dmat3> planes = x3d_planes_across(spine);
    for (std::size_t i = 0; i < spine.size(); ++i) {
      glm::dvec2 scale(1);
      if (!scales.empty()) {
        const std::size_t s = std::min(2 * i, scales.size() - 2);
        scale = {scales[s], scales[s + 1]};
      }
      glm::dquat turn(1, 0, 0, 0);
      if (!turns.empty()) {
        const std::size_t t = std::min(4 * i, turns.size() - 4);
        const glm::dvec3 axis(turns[t], turns[t + 1], turns[t + 2]);
        if (glm::length(axis) > 0) turn = glm::angleAxis(turns[t + 3], glm::normalize(axis));
      }
      for (const glm::dvec2& p : outline) {
        part_.positions.push_back(spine[i] + planes[i] * (turn * glm::dvec3(scale.x * p.x, 0, scale.y * p.y)));
      }
    }
    const std::size_t columns = outline.size();
    add_grid(
        spine.size(), columns, [&](std::size_t j, std::size_t i) { return j * columns + i; }, true);
    const std::size_t corners = outline.front() == outline.back() ? columns - 1 : columns;
    if (corners < 3) return;
    std::vector<std::int32_t> begin, end;
    for (std::size_t i = 0; i < corners; ++i) {
      begin.push_back(static_cast<std::int32_t>(corners - 1 - i));
      end.push_back(static_cast<std::int32_t>((spine.size() - 1) * columns + i));
    }
    if (flag(node_, "beginCap", true)) add(begin);
    if (flag(node_, "endCap", true)) add(end);
  }

 private:
  void take_coordinates() {
    pugi::xml_node coordinates;
    for (const pugi::xml_node& child : node_.children()) {
      const std::string_view name = local_name(child);
      if (name == "Coordinate" || name == "CoordinateDouble") coordinates = resolve_(child);
      if (name == "GeoCoordinate") xml_.fail(child, "<GeoCoordinate> is not supported; write <Coordinate>");
    }
    const std::vector<double> at = reals(coordinates, "point", [&](const std::string& word) {
      return xml_.coordinate(coordinates, word.c_str(), "point");
    });
    if (at.size() % 3 != 0) xml_.fail(coordinates, "point has {} numbers, which is no multiple of 3", at.size());
    for (std::size_t i = 0; i < at.size(); i += 3) part_.positions.emplace_back(at[i], at[i + 1], at[i + 2]);
  }
  [[nodiscard]] std::size_t positions() const { return part_.positions.size() - first_; }
  [[nodiscard]] std::vector<std::int32_t> all_in_order() const {
    std::vector<std::int32_t> order(positions());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
    return order;
  }

  /// Adds a face; `corners` are indices into the positions of this node.
  void add(std::span<const std::int32_t> corners) {
    for (const std::int32_t corner : corners) {
      if (corner < 0 || static_cast<std::size_t>(corner) >= positions()) {
        xml_.fail(node_, "a face names vertex {}, but there are only {} (numbered from 0)", corner, positions());
      }
      part_.corners.push_back(static_cast<std::uint32_t>(first_ + static_cast<std::size_t>(corner)));
    }
    if (!flag(node_, "ccw", true)) {
      std::reverse(part_.corners.end() - static_cast<std::ptrdiff_t>(corners.size()), part_.corners.end());
    }
    part_.face_ends.push_back(part_.corners.size());
  }
  /// Calls add_run for each run of indices between two entries of −1.
  template <typename Add>
  static void add_runs(const std::vector<std::int32_t>& order, const Add& add_run) {
    for (std::size_t begin = 0; begin < order.size();) {
      const auto end = static_cast<std::size_t>(
          std::find(order.begin() + static_cast<std::ptrdiff_t>(begin), order.end(), -1) - order.begin());
      if (end > begin) add_run(std::span(order).subspan(begin, end - begin));
      begin = end + 1;
    }
  }
  template <typename At>
  void add_grid(std::size_t rows, std::size_t columns, const At& at, bool turned = false) {
    for (std::size_t j = 0; j + 1 < rows; ++j) {
      for (std::size_t i = 0; i + 1 < columns; ++i) {
        const auto corner = [&](std::size_t r, std::size_t c) { return static_cast<std::int32_t>(at(j + r, i + c)); };
        if (turned)
          add(std::array{corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)});
        else
          add(std::array{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});
      }
    }
  }

  std::int32_t point(const glm::dvec3& at) {
    part_.positions.push_back(at);
    return static_cast<std::int32_t>(positions() - 1);
  }
  static glm::dvec2 direction(int i) {
    const double angle = 2 * std::numbers::pi * i / kX3dSides;
    return {std::cos(angle), std::sin(angle)};
  }
  /// Adds a ring, counter-clockwise as seen from above.
  std::vector<std::int32_t> ring(double radius, double height) {
    std::vector<std::int32_t> corners;
    for (int i = 0; i < kX3dSides; ++i) {
      const glm::dvec2 toward = radius * direction(i);
      corners.push_back(point({toward.x, height, -toward.y}));
    }
    return corners;
  }
  std::vector<std::int32_t> circle(double radius) {
    std::vector<std::int32_t> corners;
    for (int i = 0; i < kX3dSides; ++i) corners.push_back(point(glm::dvec3(radius * direction(i), 0)));
    return corners;
  }
  static std::vector<std::int32_t> reversed(std::vector<std::int32_t> corners) {
    std::ranges::reverse(corners);
    return corners;
  }
  void join(const std::vector<std::int32_t>& low, const std::vector<std::int32_t>& high) {
    for (std::size_t i = 0, j = low.size() - 1; i < low.size(); j = i++)
      add(std::array{low[j], low[i], high[i], high[j]});
  }
  void to_tip(const std::vector<std::int32_t>& base, std::int32_t tip, bool above) {
    for (std::size_t i = 0, j = base.size() - 1; i < base.size(); j = i++) {
      if (above)
        add(std::array{base[j], base[i], tip});
      else
        add(std::array{base[i], base[j], tip});
    }
  }

  const XmlText& xml_;
  const pugi::xml_node& node_;
  const X3dResolve& resolve_;
  AssemblyPart& part_;
  std::size_t first_;
};

}  // namespace

std::vector<double> x3d_reals(const XmlText& xml, const pugi::xml_node& node, const char* name) {
  return reals(node, name, [&](const std::string& word) { return xml.real(node, word.c_str(), name); });
}

std::vector<double> x3d_reals(const XmlText& xml, const pugi::xml_node& node, const char* name,
                              std::vector<double> fallback) {
  std::vector<double> values = x3d_reals(xml, node, name);
  if (values.empty()) return fallback;
  if (values.size() != fallback.size()) {
    xml.fail(node, "{} has {} numbers; expected {}", name, values.size(), fallback.size());
  }
  return values;
}

X3dGeometry add_x3d_geometry(const XmlText& xml, const pugi::xml_node& node, const X3dResolve& resolve,
                             AssemblyPart& part) {
  struct Kind {
    std::string_view name;
    X3dGeometry kind;
    void (*add)(Geometry&) = nullptr;
  };
  constexpr std::array<Kind, 27> kKinds = {
      {{"IndexedFaceSet", X3dGeometry::surface, [](Geometry& g) { g.indexed_face_set(); }},
       {"TriangleSet", X3dGeometry::surface, [](Geometry& g) { g.faces_of(3, false); }},
       {"IndexedTriangleSet", X3dGeometry::surface, [](Geometry& g) { g.faces_of(3, true); }},
       {"QuadSet", X3dGeometry::surface, [](Geometry& g) { g.faces_of(4, false); }},
       {"IndexedQuadSet", X3dGeometry::surface, [](Geometry& g) { g.faces_of(4, true); }},
       {"TriangleFanSet", X3dGeometry::surface, [](Geometry& g) { g.fans_or_strips(false, false, "fanCount"); }},
       {"TriangleStripSet", X3dGeometry::surface, [](Geometry& g) { g.fans_or_strips(true, false, "stripCount"); }},
       {"IndexedTriangleFanSet", X3dGeometry::surface, [](Geometry& g) { g.fans_or_strips(false, true, ""); }},
       {"IndexedTriangleStripSet", X3dGeometry::surface, [](Geometry& g) { g.fans_or_strips(true, true, ""); }},
       {"ElevationGrid", X3dGeometry::surface, [](Geometry& g) { g.elevation_grid(); }},
       {"Extrusion", X3dGeometry::surface, [](Geometry& g) { g.extrusion(); }},
       {"Box", X3dGeometry::surface, [](Geometry& g) { g.box(); }},
       {"Rectangle2D", X3dGeometry::surface, [](Geometry& g) { g.rectangle_2d(); }},
       {"TriangleSet2D", X3dGeometry::surface, [](Geometry& g) { g.triangle_set_2d(); }},
       {"Sphere", X3dGeometry::curved, [](Geometry& g) { g.sphere(); }},
       {"Cone", X3dGeometry::curved, [](Geometry& g) { g.cone(); }},
       {"Cylinder", X3dGeometry::curved, [](Geometry& g) { g.cylinder(); }},
       {"Disk2D", X3dGeometry::curved, [](Geometry& g) { g.disk_2d(); }},
       {"PointSet", X3dGeometry::line},
       {"LineSet", X3dGeometry::line},
       {"IndexedLineSet", X3dGeometry::line},
       {"Arc2D", X3dGeometry::line},
       {"Circle2D", X3dGeometry::line},
       {"Polyline2D", X3dGeometry::line},
       {"Polypoint2D", X3dGeometry::line},
       {"NurbsCurve", X3dGeometry::line},
       {"Text", X3dGeometry::line}}};
  const auto* const kind = std::ranges::find(kKinds, local_name(node), &Kind::name);
  if (kind == kKinds.end()) return X3dGeometry::unknown;
  if (kind->add != nullptr) {
    Geometry geometry(xml, node, resolve, part);
    kind->add(geometry);
  }
  return kind->kind;
}

}  // namespace penumbra::import
