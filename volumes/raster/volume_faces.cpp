// SPDX-License-Identifier: Apache-2.0
// The faces of shadow volumes on the screen, after C. Everitt and M. Kilgard 2002: sides to infinity, caps, far ends.
// Departure: the far end is a fan for each silhouette edge, not a cap for each triangle (volumes/README.md, Counting).

#include "volumes/raster/volume_faces.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"
#include "volumes/raster/screen_box.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

/// Returns an edge's side, or its fan, without a screen box.
gpu::VolumeFace face_of(const VolumeEdge& edge) {
  return {edge.a, edge.b, edge.a, edge.multiplicity, 0, edge.part, {}};
}

double area_of(const gpu::VolumeFace& face) {
  const glm::dvec2 u(face.corners[1] - face.corners[0]), v(face.corners[2] - face.corners[0]);
  return glm::length(u) * glm::length(v);
}

using Corners = std::pair<std::array<FaceCorner, 4>, std::size_t>;

std::optional<std::int32_t> total(const std::optional<std::vector<std::int32_t>>& counts) {
  if (!counts) return std::nullopt;
  return std::accumulate(counts->begin(), counts->end(), 0);
}

class Finder {
 public:
  Finder(const LightVolumes& volumes, const visibility::PinholeCamera& camera)
      : volumes_(volumes), camera_(camera), boxes_(camera) {}

  VolumeFaces find(CountVariant variant);

 private:
  [[nodiscard]] bool is_bounded(std::uint32_t part, std::uint32_t by) const;
  [[nodiscard]] double offset_of(const glm::dvec3& x, std::uint32_t part, double plane) const;
  template <typename Item, typename Make>
  void add_faces(FaceKind kind, const std::vector<Item>& items, const Make& make);
  void add_sides();
  void add_caps();
  void add_fans(FaceKind kind);
  void stop_toggling_at_eye();
  void choose_apex();

  const LightVolumes& volumes_;
  const visibility::PinholeCamera& camera_;
  BoxFinder boxes_;
  VolumeFaces found_;
};

/// Adds the face that `make` returns for each item, if it has a screen box.
template <typename Item, typename Make>
void Finder::add_faces(FaceKind kind, const std::vector<Item>& items, const Make& make) {
  std::vector<gpu::VolumeFace> faces(items.size());
  for_each_index(items.size(), [&](std::size_t i) {
    gpu::VolumeFace& face = faces[i];
    const auto [corners, size] = make(items[i], face);
    if (face.weight == 0) return;
    const std::optional<ScreenBox> box = boxes_.around(std::span(corners).first(size));
    if (!box) face.weight = 0;
    for (std::size_t j = 0; box && j < 4; ++j) face.corners[j] = box->corners[j];
  });
  std::erase_if(faces, [](const gpu::VolumeFace& face) { return face.weight == 0; });
  double area = 0;
  for (const gpu::VolumeFace& face : faces) area += area_of(face);
  found_.fragments += static_cast<std::uint64_t>(area);
  found_.kinds.push_back({kind, std::move(faces)});
}

/// Chooses an apex behind the camera, from which fans hardly ever reach the screen; moved slightly if rounding does not
/// determine the count there.
void Finder::choose_apex() {
  constexpr int kTries = 64;
  for (int i = 0; i < kTries; ++i) {
    found_.apex = -camera_.forward + 0x1p-10 * i * (camera_.right + 0.618 * camera_.up);
    const std::optional<std::vector<std::int32_t>> counts = counts_along(volumes_, -found_.apex);
    if (!counts) continue;
    found_.at_start = 0;
    for (std::uint32_t part = 0; part < counts->size(); ++part) {
      if (is_bounded(part, gpu::kHasUpper) || (*counts)[part] == 0) continue;
      found_.at_start += (*counts)[part];
      // a part whose count does not start at 0 cannot toggle
      if (is_bounded(part, gpu::kToggles)) found_.parts[part].bounds &= ~gpu::kToggles;
    }
    return;
  }
  PENUMBRA_ASSERT(false, "no apex for {} volumes", volumes_.caps.size());
}

bool Finder::is_bounded(std::uint32_t part, std::uint32_t by) const {
  return part < found_.parts.size() && (found_.parts[part].bounds & by) != 0;
}

/// Returns the t for which l + t (x − l) is on this plane across the part's axis.
double Finder::offset_of(const glm::dvec3& x, std::uint32_t part, double plane) const {
  const double(&n)[3] = found_.parts[part].axis;
  return plane / glm::dot(glm::dvec3(n[0], n[1], n[2]), x - glm::dvec3(volumes_.l));
}

/// A part that contains the eye, or may contain it, is counted beyond p everywhere.
void Finder::stop_toggling_at_eye() {
  if (found_.parts.empty()) return;
  const std::optional<std::vector<std::int32_t>> counts = counts_at(volumes_, camera_.eye);
  for (std::size_t part = 0; part < found_.parts.size(); ++part) {
    if (!counts || (*counts)[part] != 0) found_.parts[part].bounds &= ~gpu::kToggles;
  }
}

void Finder::add_sides() {
  const glm::dvec3 l = volumes_.l;
  add_faces(kSideFaces, volumes_.edges, [&](const VolumeEdge& edge, gpu::VolumeFace& face) -> Corners {
    face = face_of(edge);
    glm::dvec3 a = edge.a, b = edge.b;
    FaceCorner far_a{a - l, true}, far_b{b - l, true};
    if (is_bounded(edge.part, gpu::kHasUpper)) {
      const double upper = found_.parts[edge.part].upper;
      far_a = {l + (a - l) * offset_of(a, edge.part, upper)};
      far_b = {l + (b - l) * offset_of(b, edge.part, upper)};
    }
    if (is_bounded(edge.part, gpu::kHasLower)) {
      const double lower = found_.parts[edge.part].lower;
      a = l + (a - l) * offset_of(a, edge.part, lower);
      b = l + (b - l) * offset_of(b, edge.part, lower);
    }
    return {{{{a}, {b}, far_b, far_a}}, 4};
  });
}

void Finder::add_caps() {
  add_faces(kCapFaces, volumes_.caps, [&](const VolumeCap& cap, gpu::VolumeFace& face) -> Corners {
    const auto& [a, b, c] = cap.corners;
    face = {a, b, c, is_bounded(cap.part, gpu::kHasLower) ? 0 : 1, cap.plane, cap.part, {}};
    return {{{{a}, {b}, {c}}}, 3};
  });
}

/// Adds the ends of volumes at infinity, or in the planes that cut parts.
void Finder::add_fans(FaceKind kind) {
  const glm::dvec3 l = volumes_.l;
  add_faces(kind, volumes_.edges, [&](const VolumeEdge& edge, gpu::VolumeFace& face) -> Corners {
    face = face_of(edge);
    const glm::dvec3 a = glm::dvec3(edge.a) - l, b = glm::dvec3(edge.b) - l;
    if (is_bounded(edge.part, gpu::kHasUpper) == (kind == kFanFaces)) face.weight = 0;
    if (kind == kFanFaces) return {{{{found_.apex, true}, {a, true}, {b, true}}}, 3};
    if (kind == kLowerFanFaces) face.weight = is_bounded(edge.part, gpu::kHasLower) ? edge.multiplicity : 0;
    if (face.weight == 0) return {{}, 0};
    const gpu::VolumePart& part = found_.parts[edge.part];
    const double plane = kind == kLowerFanFaces ? part.lower : part.upper;
    const glm::dvec3 n(part.axis[0], part.axis[1], part.axis[2]);
    return {{{{l + n * (plane / glm::dot(n, n))},
              {l + a * offset_of(edge.a, edge.part, plane)},
              {l + b * offset_of(edge.b, edge.part, plane)}}},
            3};
  });
}

VolumeFaces Finder::find(CountVariant variant) {
  found_.parts = volumes_.parts;
  if (variant != CountVariant::z_fail) {
    const std::optional<std::int32_t> at = total(counts_at(volumes_, camera_.eye));
    (variant == CountVariant::z_pass ? found_.at_eye : found_.at_start) = at.value_or(0);
    found_.before = variant == CountVariant::z_pass || at;
  }
  if (!found_.before) {
    stop_toggling_at_eye();
    choose_apex();
  }
  add_sides();
  add_caps();
  if (!found_.before) add_fans(kFanFaces);
  const auto some = [&](std::uint32_t bound) {
    return std::ranges::any_of(found_.parts, [&](const gpu::VolumePart& part) { return (part.bounds & bound) != 0; });
  };
  if (some(gpu::kHasLower)) add_fans(kLowerFanFaces);
  if (some(gpu::kHasUpper)) add_fans(kUpperFanFaces);
  return std::move(found_);
}

}  // namespace

std::size_t VolumeFaces::count(FaceKind kind) const {
  const auto at = std::ranges::find(kinds, kind, &Kind::kind);
  return at == kinds.end() ? 0 : at->faces.size();
}

VolumeFaces faces_on_screen(const LightVolumes& volumes, const visibility::PinholeCamera& camera,
                            CountVariant variant) {
  return Finder(volumes, camera).find(variant);
}

}  // namespace penumbra::volumes
