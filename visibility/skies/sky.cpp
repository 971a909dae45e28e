// SPDX-License-Identifier: Apache-2.0
// Computes the flux from regions of a dome's picture as a sum over their sides: those on borders of faces by tables,
// others texel by texel.

#include "visibility/skies/sky.hpp"

#include "visibility/dome_faces.hpp"
#include "visibility/skies/sky_texels.hpp"
#include "visibility/skies/sky_walk.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <mutex>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace penumbra::visibility {

using std::numbers::pi;

/// A fixed arc with the integral from its beginning to each border of texels, so that the integral over any part of it
/// takes two look-ups.
class SkyLine {
 public:
  SkyLine(const SkyTexels& texels, const SkyArc& arc, SkyPole pole) : texels_(&texels), arc_(arc), pole_(pole) {
    SkyFlux flux(0.0);
    texels.walk(arc, [&](const SkyCell& cell, const SkyPoint& from, const SkyPoint& to) {
      parts_.push_back({cell, from, flux});
      texels.add_part(cell, pole, from, to, arc.axis, flux);
    });
  }

  /// Returns the integral from the beginning to a direction of the arc.
  [[nodiscard]] SkyFlux up_to(const glm::dvec3& direction) const {
    if (parts_.empty()) return SkyFlux(0.0);
    const double turn = arc_.turn_of(direction);
    const auto after = std::upper_bound(parts_.begin() + 1, parts_.end(), turn,
                                        [](double value, const Part& part) { return value < part.from.turn; });
    const Part& part = *(after - 1);
    SkyFlux flux = part.before;
    texels_->add_part(part.cell, pole_, part.from, texels_->point_of(arc_, direction, part.cell.column), arc_.axis,
                      flux);
    return flux;
  }

 private:
  struct Part {
    SkyCell cell;
    SkyPoint from;
    SkyFlux before;
  };
  const SkyTexels* texels_;
  SkyArc arc_;
  SkyPole pole_;
  std::vector<Part> parts_;
};

/// A face in the sky's axes.
struct SkyFace {
  glm::dvec3 middle{0}, u{0}, v{0};
  SkyPole pole = SkyPole::north;
  std::vector<glm::dvec2> corners;  // of the emitting part
  /// Lines s = −1, s = 1, t = −1, t = 0, t = 1.
  std::vector<SkyLine> upright, level;
  SkyFlux whole{0.0};

  [[nodiscard]] glm::dvec3 direction(const glm::dvec2& st) const { return middle + st.x * u + st.y * v; }
};

struct SkyTables {
  SkyTexels texels;
  glm::dmat3 to_sky;  // from world space

  SkyTables(const scenes::Texture& picture, const DomeFrame& frame, bool half)
      : texels(picture, half), to_sky(glm::transpose(glm::dmat3(-frame.ahead, frame.right, frame.up))) {}

  std::array<SkyFace, kDomeFaces> faces;

  /// Flux from parts of faces above planes, by face and plane: neighbouring view samples often need the same one.
  static constexpr std::size_t kMostKept = 1U << 16U;
  std::mutex mutex;
  std::map<std::array<double, 4>, SkyFlux> above;

  [[nodiscard]] SkyFlux side(const SkyFace& face, const glm::dvec2& from, const glm::dvec2& to, double& exposure) const;
  [[nodiscard]] SkyFlux polygon(const SkyFace& face, const std::vector<glm::dvec2>& corners) const {
    SkyFlux flux(0.0);
    double ignored = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
      flux += side(face, corners[i], corners[(i + 1) % corners.size()], ignored);
    return flux;
  }
};

SkyFlux SkyTables::side(const SkyFace& face, const glm::dvec2& from, const glm::dvec2& to, double& exposure) const {
  const auto along = [&](const SkyLine& line) {
    return line.up_to(face.direction(from)) - line.up_to(face.direction(to));
  };
  if (from.x == to.x && std::abs(from.x) == 1) return along(face.upright[from.x < 0 ? 0 : 1]);
  if (from.y == to.y && (std::abs(from.y) == 1 || from.y == 0))
    return along(face.level[static_cast<std::size_t>(from.y + 1)]);
  SkyFlux flux(0.0);
  exposure += texels.integrate(SkyArc(face.direction(to), face.direction(from)), face.pole, flux);
  return flux;
}

namespace {

SkyFace make_face(const SkyTables& tables, const Light::Dome& dome, std::size_t number) {
  const DomeFace stored = dome_face(dome, number);
  SkyFace face;
  face.middle = tables.to_sky * glm::dvec3(stored.middle);
  face.u = tables.to_sky * glm::dvec3(stored.u);
  face.v = tables.to_sky * glm::dvec3(stored.v);
  face.pole = number == kDomeBottom ? SkyPole::south : SkyPole::north;
  const auto line = [&](const glm::dvec2& from, const glm::dvec2& to) {
    return SkyLine(tables.texels, SkyArc(face.direction(from), face.direction(to)), face.pole);
  };
  for (const double s : {-1.0, 1.0}) face.upright.push_back(line({s, -1}, {s, 1}));
  for (const double t : {-1.0, 0.0, 1.0}) face.level.push_back(line({-1, t}, {1, t}));
  Light light;
  light.dome = dome;
  light.dome->face = static_cast<std::int32_t>(number);
  light.dome->half = dome.half && number < 4;
  const auto corners = dome_face_corners(light);
  face.corners.assign(corners.begin(), corners.end());
  if (!dome.half || number != kDomeBottom) face.whole = tables.polygon(face, face.corners);
  return face;
}

}  // namespace

Sky::Sky(const scenes::Texture& picture, const DomeFrame& frame, const Light::Dome& dome)
    : frame_(frame), dome_(dome), picture_(picture) {}

SkyTables& Sky::tables() const {
  std::call_once(once_, [&] {
    // Runs on all cores, but this thread must not run another task meanwhile: that could enter this function again.
    tbb::this_task_arena::isolate([&] {
      auto tables = std::make_unique<SkyTables>(picture_, frame_, dome_.half);
      for (std::size_t face = 0; face < kDomeFaces; ++face) tables->faces.at(face) = make_face(*tables, dome_, face);
      tables_ = std::move(tables);
      picture_ = {};
    });
  });
  return *tables_;
}

Sky::~Sky() = default;

SkyFlux Sky::side(std::size_t face, const glm::dvec2& from, const glm::dvec2& to, double& exposure) const {
  const SkyTables& all = tables();
  return all.side(all.faces.at(face), from, to, exposure);
}

const SkyFlux& Sky::of_face(std::size_t face) const {
  return tables().faces.at(face).whole;
}

/// The cut keeps corners exactly, so sides on the face's border stay there.
SkyFlux Sky::of_face_above(std::size_t number, const glm::dvec3& n) const {
  SkyTables& all = tables();
  const std::array<double, 4> key{static_cast<double>(number), n.x, n.y, n.z};
  {
    const std::lock_guard lock(all.mutex);
    if (const auto found = all.above.find(key); found != all.above.end()) return found->second;
  }
  const SkyFace& face = all.faces.at(number);
  const glm::dvec3 up = all.to_sky * n;
  std::vector<glm::dvec2> corners;
  for (std::size_t i = 0; i < face.corners.size(); ++i) {
    const glm::dvec2 &a = face.corners[i], &b = face.corners[(i + 1) % face.corners.size()];
    const double height_a = glm::dot(up, face.direction(a)), height_b = glm::dot(up, face.direction(b));
    if (height_a >= 0) corners.push_back(a);
    if ((height_a >= 0) != (height_b >= 0)) corners.push_back(a + height_a / (height_a - height_b) * (b - a));
  }
  const SkyFlux flux = all.polygon(face, corners);
  const std::lock_guard lock(all.mutex);
  if (all.above.size() >= SkyTables::kMostKept) all.above.clear();
  all.above.emplace(key, flux);
  return flux;
}

/// The region's border is the great circle orthogonal to n. Its upper half takes the integrals from the north pole, its
/// lower half those from the south pole; the difference between both, over the half of the equator above the plane, is
/// added.
SkyFlux Sky::above(const glm::dvec3& n) const {
  const SkyTexels& texels = tables().texels;
  const glm::dvec3 up = glm::normalize(tables().to_sky * n);
  const double level = std::hypot(up.x, up.y);
  const glm::dvec3 toward = level > 0 ? glm::dvec3(up.x / level, up.y / level, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 first(-toward.y, toward.x, 0);  // on the circle, where it rises
  const glm::dvec3 top = glm::cross(up, first);
  SkyFlux flux(0.0);
  if (level > 0) {
    texels.integrate({first, top}, SkyPole::north, flux);
    texels.integrate({top, -first}, SkyPole::north, flux);
    texels.integrate({-first, -top}, SkyPole::south, flux);
    texels.integrate({-top, first}, SkyPole::south, flux);
  } else {
    const SkyPole pole = up.z > 0 ? SkyPole::north : SkyPole::south;
    const glm::dvec3 side(0, up.z > 0 ? 1 : -1, 0);
    texels.integrate({toward, side}, pole, flux);
    texels.integrate({side, -toward}, pole, flux);
    texels.integrate({-toward, -side}, pole, flux);
    texels.integrate({-side, toward}, pole, flux);
    return flux;
  }
  const auto azimuth = [](const glm::dvec3& direction) {
    const double angle = std::atan2(direction.y, direction.x);
    return angle < 0 ? angle + 2 * pi : angle;
  };
  const double from = azimuth(-first), to = azimuth(first);
  flux += texels.wedge(to) - texels.wedge(from);
  if (to < from) flux += texels.wedge(2 * pi);
  return flux;
}

glm::dvec3 Sky::form_factor(const SkyFlux& flux, const glm::dvec3& n) const {
  return (tables().to_sky * n) * flux / pi;
}

/// A great circle has at most two parts for each row and one for each column, and each adds a few roundings of the
/// picture's whole light.
double Sky::rounding() const {
  const SkyTexels& texels = tables().texels;
  return 64 * 0x1p-53 * static_cast<double>(2 * texels.rows() + texels.columns()) * texels.mean();
}

double Sky::mean_luminance() const {
  return tables().texels.mean();
}

}  // namespace penumbra::visibility
