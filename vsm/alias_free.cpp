// SPDX-License-Identifier: Apache-2.0
// T. Aila and S. Laine, Alias-free shadow maps, 2004; G. Johnson, J. Lee, C. Burns and W. Mark, The irregular Z-buffer,
// 2005: a shadow map whose samples are at the places of view samples. View samples are stored in lists of light pixels;
// each triangle is rasterised conservatively from the light's centre and tested against the lists of the pixels that it
// touches.
//
// Departures. Six faces of a cube around the centre instead of one frustum (a sun has one, orthographic), each with a
// window around its view samples. A test is the exact predicate on the view sample itself: no depth is stored, so there
// is no bias. A view sample found to be in shadow is removed from its list.

#include "vsm/methods.hpp"

#include "base/assert.hpp"
#include "engines/pairs/list_raster.hpp"
#include "visibility/method_repairs.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/receivers.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace penumbra::vsm {
namespace {

using pairs::Footprint, pairs::LightPixels;

visibility::MeshVerdict alias_free_verdict(const mesh::Diagnosis& mesh) {
  return {
      visibility::Verdict::approximate,
      visibility::reason_with("a hard shadow of the light's centre; as a hard shadow it is exact for every mesh", mesh,
                              {{mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}

constexpr visibility::RealOption kPerPixel{"perPixel", 0.125, 64, 1,
                                           "average number of view samples in a light pixel; affects only the time"};

visibility::MethodDescription describe_alias_free() {
  return {.name = "alias-free",
          .family = visibility::Family::geometry,
          .paper = "Aila and Laine 2004; Johnson, Lee, Burns and Mark 2005",
          .output = visibility::Output::scalar,
          .exact_for = "the hard shadow of the light's centre, of any triangle soup and every kind of light",
          .lights = visibility::kEveryLight - visibility::kDomes,
          .options = {kPerPixel.description()},
          .verdict_on = alias_free_verdict,
          .repairs = visibility::exact_centre_repairs};
}

/// Projection from the light's centre: through a face of a cube, or along a sun's direction.
struct Eye {
  glm::dvec3 center{0};  ///< for a sun, its direction
  bool sun = false;
  int axis = 2;
  double sign = 1;

  /// Returns a homogeneous place: x and y along the other two axes, z away from the light. The place itself is (x, y) /
  /// z; for a sun it is (x, y).
  [[nodiscard]] glm::dvec3 see(const glm::vec3& point) const {
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    const glm::dvec3 x(point);
    if (sun) {
      const double along = x[axis] / center[axis];
      return {x[i] - along * center[i], x[j] - along * center[j], -along};
    }
    const glm::dvec3 d = x - center;
    return {d[i], d[j], sign * d[axis]};
  }
  [[nodiscard]] glm::dvec2 place(const glm::vec3& point) const {
    const glm::dvec3 at = see(point);
    return sun ? glm::dvec2(at) : glm::dvec2(at) / at.z;
  }
};

int largest_axis(const glm::dvec3& x) {
  const glm::dvec3 size = glm::abs(x);
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

/// A face with its view samples.
struct Face {
  Eye eye;
  std::vector<std::uint32_t> pixels;
  std::vector<double> depth;  ///< depth of each view sample
  LightPixels light_pixels;
};

/// A convex polygon clipped by value(x) ≥ −slack.
class Polygon {
 public:
  explicit Polygon(const std::array<glm::dvec3, 3>& corners)
      : corners_{corners[0], corners[1], corners[2]}, count_(3) {}

  template <typename Value>
  void cut(const Value& value, double slack) {
    std::array<glm::dvec3, 8> kept{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const glm::dvec3 &a = corners_[i], &b = corners_[(i + 1) % count_];
      const double at_a = value(a) + slack, at_b = value(b) + slack;
      if (at_a >= 0) kept[count++] = a;
      if ((at_a >= 0) != (at_b >= 0)) kept[count++] = a + (b - a) * (at_a / (at_a - at_b));
    }
    corners_ = kept;
    count_ = count;
  }
  [[nodiscard]] std::span<const glm::dvec3> corners() const { return std::span(corners_).first(count_); }

 private:
  std::array<glm::dvec3, 8> corners_;  // three corners, and one more for each of five clips
  std::size_t count_;
};

/// Returns the region of the face's window in which a triangle may be seen; a region without points means nowhere.
Footprint footprint_of(const Face& face, const std::array<glm::vec3, 3>& corners) {
  const std::array seen{face.eye.see(corners[0]), face.eye.see(corners[1]), face.eye.see(corners[2])};
  double largest = 0;
  for (const glm::dvec3& at : seen) largest = std::max({largest, std::abs(at.x), std::abs(at.y), std::abs(at.z)});
  Footprint footprint;
  if (face.eye.sun) {
    for (const glm::dvec3& at : seen) footprint.add(glm::dvec2(at));
    // Error of a quotient, a product and a difference, of at most twice the largest coordinate (center[axis] is
    // largest).
    footprint.error = 0;
    for (const glm::vec3& corner : corners)
      footprint.error = std::max(footprint.error, 0x1p-50 * 4 * glm::length(glm::dvec3(corner)));
    return footprint;
  }
  // A coordinate is rounded once, the value of a clip (at most 2 · largest) four times; a new corner likewise.
  const double slack = 0x1p-46 * largest;
  const glm::dvec2 lower = face.light_pixels.lower(), upper = face.light_pixels.upper();
  Polygon polygon(seen);
  polygon.cut([&](const glm::dvec3& x) { return x.x - lower.x * x.z; }, slack);
  polygon.cut([&](const glm::dvec3& x) { return upper.x * x.z - x.x; }, slack);
  polygon.cut([&](const glm::dvec3& x) { return x.y - lower.y * x.z; }, slack);
  polygon.cut([&](const glm::dvec3& x) { return upper.y * x.z - x.y; }, slack);
  polygon.cut([](const glm::dvec3& x) { return x.z; }, slack);  // with a window of zero width, the other four clips
                                                                // keep points with z < 0, too
  double nearest = std::numeric_limits<double>::max();
  for (const glm::dvec3& at : polygon.corners()) nearest = std::min(nearest, at.z);
  footprint.everywhere = !(nearest > 0x1p8 * slack);
  if (footprint.everywhere) return footprint;
  for (const glm::dvec3& at : polygon.corners()) footprint.add(glm::dvec2(at) / at.z);
  footprint.error = 16 * slack / nearest;  // includes a corner's error, the five clips, and a place of size 1
  return footprint;
}

class AliasFree final : public visibility::Method {
 public:
  explicit AliasFree(const visibility::MethodOptions& options)
      : description_(describe_alias_free()), per_pixel_(visibility::parse_options(description_, options)[kPerPixel]) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    light_ = nullptr;
  }
  void prepare_light(const visibility::Light& light) override {
    PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first: {}", light.name);
    visibility::check_light(description_, light);
    light_ = &light;
    center_ = visibility::center_of(light);
    casters_.clear();
    for (std::uint32_t i = 0; i < scene_->triangles.size(); ++i) {
      if (scene_->casts_shadow[i] != 0 && scene_->emits[i] != light.index) casters_.push_back(i);
    }
    tests_ = footprints_ = longest_ = 0;
  }
  void prepare_view(const visibility::ViewSamples& samples) override { samples_ = &samples; }
  [[nodiscard]] std::uint32_t max_tile_rows() const override { return std::max(1U, samples_->height); }
  void evaluate(const visibility::Tile& tile) override;
  void read_visibility(std::span<float> visibility) override {
    PENUMBRA_ASSERT(visibility.size() == lit_.size(), "{} pixels asked for, {} evaluated", visibility.size(),
                    lit_.size());
    std::ranges::transform(lit_, visibility.begin(), [](std::uint8_t lit) { return lit != 0 ? 1.0F : 0.0F; });
  }
  std::vector<visibility::PassTime> take_pass_times() override {
    return {{"irregular z-buffer", std::exchange(milliseconds_, 0)}};
  }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    return {{"footprints", footprints_}, {"viewSamplesTested", tests_}, {"longestList", longest_}};
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return bytes_; }

 private:
  /// Sorts view samples into faces; those that do not see the light's centre for reasons other than triangles are dark.
  std::vector<Face> sort_view_samples(const visibility::Tile& tile);
  void rasterise(Face& face);

  visibility::MethodDescription description_;
  double per_pixel_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  glm::vec3 center_{0};
  std::vector<std::uint32_t> casters_;
  const visibility::ViewSamples* samples_ = nullptr;
  std::size_t first_pixel_ = 0;
  std::vector<std::uint8_t> lit_;  // for each pixel of the tile
  std::uint64_t tests_ = 0, footprints_ = 0, longest_ = 0, bytes_ = 0;
  double milliseconds_ = 0;
};

std::vector<Face> AliasFree::sort_view_samples(const visibility::Tile& tile) {
  first_pixel_ = std::size_t{tile.first_row} * samples_->width;
  lit_.assign(std::size_t{tile.row_count} * samples_->width, 1);
  std::vector<std::uint8_t> face_of(lit_.size(), 0);  // 0: none
  const glm::dvec3 center(center_);
  tbb::parallel_for(std::size_t{0}, lit_.size(), [&](std::size_t i) {
    const std::size_t pixel = first_pixel_ + i;
    if (!visibility::is_receiver(*scene_, *light_, *samples_, pixel)) return;
    const auto carrier = scene_->corners(static_cast<std::uint32_t>(samples_->triangle[pixel]));
    lit_[i] = visibility::above_horizon(*light_, carrier, samples_->facing[pixel], center_) &&
              visibility::in_front_of_light(*light_, samples_->p[pixel]);
    if (lit_[i] == 0) return;
    const glm::dvec3 d = light_->sun ? -center : glm::dvec3(samples_->p[pixel]) - center;
    const int axis = largest_axis(d);
    face_of[i] = static_cast<std::uint8_t>(1 + 2 * axis + (d[axis] < 0 ? 1 : 0));
  });
  std::vector<Face> faces(6);
  for (std::size_t i = 0; i < lit_.size(); ++i) {
    if (face_of[i] != 0) faces[face_of[i] - 1U].pixels.push_back(static_cast<std::uint32_t>(first_pixel_ + i));
  }
  for (std::size_t i = 0; i < 6; ++i)
    faces[i].eye = {center, light_->sun.has_value(), static_cast<int>(i / 2), i % 2 == 0 ? 1.0 : -1.0};
  std::erase_if(faces, [](const Face& face) { return face.pixels.empty(); });
  return faces;
}

void AliasFree::evaluate(const visibility::Tile& tile) {
  PENUMBRA_ASSERT(samples_ != nullptr && light_ != nullptr, "prepare_light and prepare_view come first");
  const auto begin = std::chrono::steady_clock::now();
  std::uint64_t bytes = 0;
  for (Face& face : sort_view_samples(tile)) {
    std::vector<glm::dvec2> places;
    double reach = 0;
    for (const std::uint32_t pixel : face.pixels) {
      const glm::vec3& p = samples_->p[pixel];
      places.push_back(face.eye.place(p));
      face.depth.push_back(face.eye.see(p).z);
      reach = std::max(reach, glm::length(glm::dvec3(p)));
    }
    // The error of a place on a face is that of two differences and a quotient, of at most 1; for a sun, see
    // footprint_of.
    face.light_pixels = LightPixels(places, face.eye.sun ? 0x1p-48 * reach : 0x1p-50, per_pixel_);
    longest_ = std::max<std::uint64_t>(longest_, face.light_pixels.longest_list());
    bytes += face.light_pixels.bytes() + face.pixels.size() * (sizeof(std::uint32_t) + sizeof(double));
    rasterise(face);
  }
  bytes_ = std::max(bytes_, bytes + lit_.size() + casters_.size() * sizeof(casters_[0]));
  milliseconds_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

void AliasFree::rasterise(Face& face) {
  const auto corners_of = [&](std::uint32_t triangle) { return scene_->corners(triangle); };
  // Rounding keeps the order of depths: a place strictly deeper after rounding is deeper. This does not hold for a sun.
  const auto nearest_of = [&](std::uint32_t triangle) {
    if (face.eye.sun) return -std::numeric_limits<double>::max();
    const auto [a, b, c] = corners_of(triangle);
    return std::min({face.eye.see(a).z, face.eye.see(b).z, face.eye.see(c).z});
  };
  const auto stays = [&](std::uint32_t triangle, std::uint32_t number, std::uint64_t& tests) {
    const std::uint32_t pixel = face.pixels[number];
    const auto carrier = static_cast<std::uint32_t>(samples_->triangle[pixel]);
    if (!visibility::may_occlude(*scene_, *light_, carrier, triangle)) return true;
    ++tests;
    if (!visibility::segment_meets_triangle(samples_->p[pixel], center_, corners_of(triangle), *light_).meets)
      return true;
    lit_[pixel - first_pixel_] = 0;
    return false;
  };
  struct Tests {
    std::uint64_t count = 0;
  };
  const pairs::ListCounts counts = pairs::draw<Tests>(
      {face.light_pixels, face.depth, casters_},
      [&](std::uint32_t triangle) { return footprint_of(face, corners_of(triangle)); }, nearest_of,
      [&](std::uint32_t triangle, std::uint32_t number, Tests& tests) { return stays(triangle, number, tests.count); },
      [&](const Tests& tests) { tests_ += tests.count; });
  footprints_ += counts.footprints;
}

}  // namespace

std::unique_ptr<visibility::Method> make_alias_free(const visibility::MethodOptions& options) {
  return std::make_unique<AliasFree>(options);
}

}  // namespace penumbra::vsm
