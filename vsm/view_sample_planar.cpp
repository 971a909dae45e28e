// SPDX-License-Identifier: Apache-2.0
// E. Eisemann and X. Décoret, Visibility sampling on GPU and applications, Computer Graphics Forum 26 (3), 2007: the
// picture is a receiver patch, its texels are view samples. For each triangle, a box on the receiver contains every
// point from which the triangle may hide any of the light. In each texel of the box, the triangle is projected back
// onto the light, and for each of its three edges a left-sample map gives the light samples to the left of the edge's
// line.
//
// Departures. Every plane of the scene with enough view samples is a receiver, and the remaining view samples form a
// height field over a plane parallel to the light: so any scene is possible. Texels have lists of view samples at the
// camera's places. An edge's line on the light is that of the plane through p and the edge, found without a division.
// lookup=exact decides light samples that a map leaves open.

#include "vsm/methods.hpp"

#include "engines/pairs/list_raster.hpp"
#include "engines/pairs/pair_method.hpp"
#include "visibility/method_repairs.hpp"
#include "vsm/left_samples.hpp"
#include "vsm/planar_receiver.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <vector>

namespace penumbra::vsm {
namespace {

using pairs::PairCounts;

constexpr double kPerTexel = 1;  // view samples for each texel of a receiver, on average
using pairs::kDeterminant;

enum class Lookup : std::uint8_t { exact, nearest };
constexpr visibility::ChoiceOption kLookup{
    "lookup",
    {{"exact", Lookup::exact}, {"nearest", Lookup::nearest}},
    Lookup::exact,
    "exact: light samples that a texel of the left-sample map leaves open are decided pair by pair; nearest: as "
    "published, uses the light samples stored for the texel's middle"};
constexpr visibility::IntegerOption kMap{"map", 8, 1024, 128,
                                         "number of angles, and of distances, of the left-sample map"};
constexpr visibility::IntegerOption kFewest{"fewest", 1, 1U << 24U, 1024,
                                            "smallest number of view samples for which a plane is a separate receiver; "
                                            "view samples of all other planes form a height field"};

visibility::MeshVerdict exact_on(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::exact,
          visibility::reason_with("every pair is decided exactly, for every mesh", mesh,
                                  {{mesh.boundary_loops, "open boundaries, where light passes as it should"},
                                   {mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}
visibility::MeshVerdict approximate_on(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::approximate,
          visibility::reason_with("light samples near a triangle's outline are only as precise as the left-sample map",
                                  mesh,
                                  {{mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}

visibility::ErrorRepairs view_sample_planar_repairs(const visibility::MethodDescription& method,
                                                    const visibility::MethodOptions& given) {
  using visibility::ErrorCause;
  visibility::ErrorRepairs repairs = visibility::exact_pair_repairs(method, given);
  if (visibility::complete_options(method, given).at(kLookup.name()) == "exact") return repairs;
  visibility::repair_of(repairs, ErrorCause::resolution) = {
      .cause = ErrorCause::resolution,
      .runs = {{method.name, visibility::options_with(method, given, {{kLookup.name(), "exact"}})}},
      .words = "light samples that a texel of the left-sample map leaves open are decided pair by pair (lookup=exact)"};
  visibility::repair_of(repairs, ErrorCause::samples) = visibility::more_light_samples(method, given);
  return repairs;
}

visibility::MethodDescription describe(const visibility::MethodOptions& given) {
  visibility::MethodDescription description{
      .name = "view-sample-planar",
      .family = visibility::Family::geometry,
      .paper = "Eisemann and Décoret 2007",
      .output = visibility::Output::mask,
      .exact_for = "every pair of view sample and light sample, for any triangle soup (lookup=exact)",
      .lights = visibility::kEveryLight - visibility::kBodies - visibility::kDomes,
      .on_request = true,
      .options = {kLookup.description(), kMap.description(), kFewest.description()},
      .verdict_on = exact_on,
      .repairs = view_sample_planar_repairs};
  if (visibility::parse_options(description, given)[kLookup] == Lookup::nearest)
    description.verdict_on = approximate_on;
  return description;
}

struct LookupCounts {
  PairCounts pairs;
  std::uint64_t lookups = 0, open = 0;
};

class ViewSamplePlanar final : public pairs::PairMethod {
 public:
  explicit ViewSamplePlanar(const visibility::MethodOptions& given)
      : PairMethod(describe(given), "view-sample planes"),
        lookup_(visibility::parse_options(description(), given)[kLookup]),
        map_(visibility::parse_options(description(), given)[kMap]),
        fewest_(visibility::parse_options(description(), given)[kFewest]) {}

 private:
  void prepare_casters() override {
    box_ = pairs::make_light_box(light());
    left_ = LeftSamples(light(), box_, map_, map_);
    casters_.clear();
    for (std::uint32_t i = 0; i < scene().triangles.size(); ++i) {
      if (scene().casts_shadow[i] != 0 && scene().emits[i] != light().index) casters_.push_back(i);
    }
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return PairMethod::memory_bytes() + left_.bytes(); }
  void block(std::span<const std::uint32_t> pixels, std::map<std::string, std::uint64_t>& counters) override;
  void draw_on(PlanarReceiver& receiver, std::map<std::string, std::uint64_t>& counters);
  /// Uses the map, then decides the remaining light samples.
  void look_up(std::uint32_t triangle, std::uint32_t pixel, LookupCounts& counts);

  Lookup lookup_;
  std::uint32_t map_, fewest_;
  pairs::LightBox box_;
  LeftSamples left_;
  std::vector<std::uint32_t> casters_;
};

void ViewSamplePlanar::block(std::span<const std::uint32_t> pixels, std::map<std::string, std::uint64_t>& counters) {
  const double reach = 2 * std::max(glm::length(glm::dvec3(scene().lower)), glm::length(glm::dvec3(scene().upper))) +
                       glm::length(box_.origin) + glm::length(box_.lower) + glm::length(box_.upper);
  // Groups by plane and visible side, in the order of planes, which is determined by the scene.
  std::map<std::pair<std::uint32_t, std::int8_t>, std::vector<std::uint32_t>> planes;
  for (const std::uint32_t pixel : pixels)
    planes[{scene().plane[static_cast<std::size_t>(samples().triangle[pixel])], samples().facing[pixel]}].push_back(
        pixel);
  std::array<std::vector<std::uint32_t>, 2> fields;  // in front of the light; behind it
  for (auto& [plane, own] : planes) {
    const std::uint32_t pixel = own.front();
    const auto corners = scene().corners(static_cast<std::uint32_t>(samples().triangle[pixel]));
    const glm::dvec3 a(corners[0]), normal = glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
    if (own.size() < fewest_ || !(glm::dot(normal, normal) > 0)) {
      for (const std::uint32_t one : own) {
        const bool front = box_.sun || box_.place(glm::dvec3(samples().p[one])).z > 0;
        fields[front ? 0 : 1].push_back(one);
      }
      continue;
    }
    ++counters["planes"];
    PlanarReceiver receiver(box_, normal * static_cast<double>(samples().facing[pixel]), reach, std::move(own),
                            samples().p, kPerTexel);
    draw_on(receiver, counters);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (fields[i].empty()) continue;
    counters["viewSamplesOnHeightFields"] += fields[i].size();
    PlanarReceiver receiver(box_, i == 0 ? -box_.axis : box_.axis, reach, std::move(fields[i]), samples().p, kPerTexel);
    draw_on(receiver, counters);
  }
}

void ViewSamplePlanar::draw_on(PlanarReceiver& receiver, std::map<std::string, std::uint64_t>& counters) {
  const pairs::ListCounts counts = pairs::draw<LookupCounts>(
      {receiver.texels(), receiver.depths(), casters_},
      [&](std::uint32_t triangle) { return receiver.footprint(scene().corners(triangle)); },
      [&](std::uint32_t triangle) { return receiver.nearest(scene().corners(triangle)); },
      [&](std::uint32_t triangle, std::uint32_t number, LookupCounts& own) {
        const std::uint32_t pixel = receiver.pixel(number);
        if (may_hide(triangle, pixel)) look_up(triangle, pixel, own);
        return sees_something(pixel);
      },
      [&](const LookupCounts& own) {
        add(own.pairs);
        counters["mapLookups"] += own.lookups;
        counters["lightSamplesLeftOpen"] += own.open;
      });
  counters["footprints"] += counts.footprints;
  counters["texelsTouched"] += counts.lists;
}

void ViewSamplePlanar::look_up(std::uint32_t triangle, std::uint32_t pixel, LookupCounts& counts) {
  const auto corners = scene().corners(triangle);
  const glm::vec3& p = samples().p[pixel];
  const glm::dvec3 at(p), first(corners[0]);
  const std::array d{glm::dvec3(corners[0]) - at, glm::dvec3(corners[1]) - at, glm::dvec3(corners[2]) - at};
  const glm::dvec3 e1 = glm::dvec3(corners[1]) - first, e2 = glm::dvec3(corners[2]) - first;
  const glm::dvec3 normal = glm::cross(e1, e2);
  const double normal_error = kDeterminant * glm::length(e1) * glm::length(e2), height = -glm::dot(normal, d[0]);
  // If the orientation of the triangle's edges is not certain, each light sample is decided exactly.
  if (!(std::abs(height) > normal_error * glm::length(d[0]))) {
    blocked().hide(p, corners, visible(pixel), counts.pairs);
    return;
  }
  const double turn = height < 0 ? 1 : -1;
  // The light's point (a, b) is on the inner side of an edge where n · (o + a across + b along − p) > 0, and beyond the
  // triangle where the same holds for its own plane. (For a sun, o is the direction −axis, and p is not subtracted.)
  const double span = glm::length(box_.lower) + glm::length(box_.upper);
  // A light sample's distance from its place changes the value by at most |n| times that distance.
  const bool as_published = lookup_ == Lookup::nearest;
  const auto line_of = [&](const glm::dvec3& n, const glm::dvec3& from, double sizes) {
    const glm::dvec3 direction = box_.sun ? -box_.axis : box_.origin - from;
    return LeftSamples::Line{
        glm::dot(n, box_.across), glm::dot(n, box_.along), glm::dot(n, direction),
        as_published ? 0 : sizes * 2 * kDeterminant * (glm::length(direction) + span) + glm::length(n) * box_.off};
  };
  std::array<LeftSamples::Texel, 4> texels;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    texels[i] = left_.at(line_of(turn * glm::cross(d[i], d[next]), at, glm::length(d[i]) * glm::length(d[next])));
  }
  texels[3] = left_.at(line_of(turn * normal, first, glm::length(e1) * glm::length(e2)));
  counts.lookups += 4;
  const std::span<std::uint32_t> mask = visible(pixel);
  for (std::size_t word = 0; word < mask.size(); ++word) {
    if (mask[word] == 0) continue;
    if (as_published) {
      mask[word] &=
          ~(texels[0].middle[word] & texels[1].middle[word] & texels[2].middle[word] & texels[3].middle[word]);
      continue;
    }
    mask[word] &= ~(texels[0].all[word] & texels[1].all[word] & texels[2].all[word] & texels[3].all[word]);
    const std::uint32_t open =
        mask[word] & texels[0].any[word] & texels[1].any[word] & texels[2].any[word] & texels[3].any[word];
    if (open == 0) continue;
    counts.open += static_cast<std::uint64_t>(std::popcount(open));
    std::uint32_t seen = open;
    blocked().hide(p, corners, std::span(&seen, 1), counts.pairs, word);
    mask[word] &= ~(open & ~seen);
  }
}

}  // namespace

std::unique_ptr<visibility::Method> make_view_sample_planar(const visibility::MethodOptions& options) {
  return std::make_unique<ViewSamplePlanar>(options);
}

}  // namespace penumbra::vsm
