// SPDX-License-Identifier: Apache-2.0
// Leaves out lights whose unshadowed light is a small share of all light at a view sample (--light-cutoff). Sums are
// taken 128 view samples at a time, over all lights, so that a thousand lights fit the processor's cache.

#include "session/pictures/faint_lights.hpp"

#include "base/memory.hpp"
#include "session/whole_lights.hpp"
#include "visibility/lights/whole_form_factors.hpp"

#include <glm/vector_relational.hpp>
#include <tbb/blocked_range.h>
#include <tbb/combinable.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace penumbra::session {
namespace {

using visibility::Light;
using visibility::PixelClass;

/// Number of view samples of a task: their data for a thousand lights fit a core's own cache.
constexpr std::size_t kGrain = 128;

/// Returns whether the light of a pixel of this class is the whole unshadowed light times V.
bool is_asked(PixelClass pixel) {
  return pixel == PixelClass::judged || pixel == PixelClass::horizon || pixel == PixelClass::other_body;
}

bool has_closed_form(const Light& light) {
  return !light.texture && !light.dome;
}

/// Counters of a task.
struct Counts {
  std::uint64_t pairs = 0;
  double largest_share = 0;
};

/// Buffers of one task.
struct Buffers {
  std::vector<std::uint32_t> which;  // view samples
  std::vector<double> form_factors;
  std::vector<double> arriving;           // of each light, each view sample: divided by the radiance
  std::vector<glm::dvec3> total, hidden;  // of each view sample
};

class Search {
 public:
  /// `counted`: the range of the view samples whose pairs are counted.
  Search(const Session& session, std::span<const glm::vec3> normals, double cutoff,
         std::pair<std::size_t, std::size_t> counted, FaintLights& found)
      : session_(session),
        normals_(normals),
        wholes_(whole_lights(session.lights)),
        cutoff_(cutoff),
        counted_(counted),
        found_(found) {}

  Counts operator()(std::size_t begin, std::size_t end) {
    Buffers& own = buffers_.local();
    const std::size_t count = end - begin;
    own.arriving.assign(count * session_.lights.size(), 0);
    own.total.assign(count, glm::dvec3(0));
    own.hidden.assign(count, glm::dvec3(0));
    for (std::size_t light = 0; light < session_.lights.size(); ++light) {
      if (has_closed_form(session_.lights[light])) add(light, begin, end, own);
    }
    Counts counts;
    for (const WholeLight& whole : wholes_) leave_out(whole, begin, end, own, counts);
    for (std::size_t i = 0; i < count; ++i) {
      for (int c = 0; c < 3; ++c) {
        if (own.total[i][c] > 0)
          counts.largest_share = std::max(counts.largest_share, own.hidden[i][c] / own.total[i][c]);
      }
    }
    return counts;
  }

 private:
  /// Adds a light to the sums of its view samples.
  void add(std::size_t light_index, std::size_t begin, std::size_t end, Buffers& own) const {
    const Light& light = session_.lights[light_index];
    const std::span<const PixelClass> classes = session_.classes[light_index];
    const std::span<double> arriving = std::span(own.arriving).subspan(light_index * (end - begin), end - begin);
    own.which.clear();
    for (std::size_t i = begin; i < end; ++i) {
      if (!is_asked(classes[i]) && classes[i] != PixelClass::unshadowed) continue;
      arriving[i - begin] = visibility::spot_share(light, session_.samples.p[i], normals_[i]);
      if (arriving[i - begin] > 0) own.which.push_back(static_cast<std::uint32_t>(i));
    }
    own.form_factors.resize(own.which.size());
    visibility::whole_form_factors(light, {session_.samples.p, normals_, own.which}, own.form_factors);
    for (std::size_t k = 0; k < own.which.size(); ++k) {
      const std::size_t i = own.which[k] - begin;
      arriving[i] *= own.form_factors[k];
      own.total[i] += arriving[i] * light.radiance;
    }
  }
  void leave_out(const WholeLight& whole, std::size_t begin, std::size_t end, Buffers& own, Counts& counts) {
    const auto pieces = std::span(session_.lights).subspan(whole.first, whole.count);
    if (!std::ranges::all_of(pieces, has_closed_form)) return;
    for (std::size_t i = begin; i < end; ++i) {
      glm::dvec3 sum(0);
      bool asked = false;
      for (std::size_t light = whole.first; light < whole.first + whole.count; ++light) {
        asked = asked || is_asked(session_.classes[light][i]);
        sum += own.arriving[light * (end - begin) + i - begin] * session_.lights[light].radiance;
      }
      if (!asked || !glm::all(glm::lessThanEqual(sum, cutoff_ * own.total[i - begin]))) continue;
      for (std::size_t light = whole.first; light < whole.first + whole.count; ++light) found_.dark[light][i] = 1;
      if (sum == glm::dvec3(0)) continue;
      counts.pairs += i >= counted_.first && i < counted_.second ? 1 : 0;
      own.hidden[i - begin] += sum;
    }
  }

  const Session& session_;
  std::span<const glm::vec3> normals_;
  std::vector<WholeLight> wholes_;
  double cutoff_;
  std::pair<std::size_t, std::size_t> counted_;
  FaintLights& found_;
  tbb::enumerable_thread_specific<Buffers> buffers_;
};

}  // namespace

FaintLights find_faint_lights(const Session& session, std::span<const glm::vec3> normals, double cutoff,
                              const visibility::Tile& counted) {
  FaintLights found;
  require_memory(session.lights.size() * session.samples.size(), "which lamps are left out of which view samples",
                 "choose a smaller --size, or leave out --light-cutoff");
  found.dark.assign(session.lights.size(), std::vector<std::uint8_t>(session.samples.size(), 0));
  const std::size_t first = std::size_t{counted.first_row} * session.width;
  Search search(session, normals, cutoff, {first, first + std::size_t{counted.row_count} * session.width}, found);
  tbb::combinable<Counts> counts;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, session.samples.size(), kGrain), [&](const auto& range) {
    const Counts here = search(range.begin(), range.end());
    Counts& sum = counts.local();
    sum.pairs += here.pairs;
    sum.largest_share = std::max(sum.largest_share, here.largest_share);
  });
  counts.combine_each([&](const Counts& part) {
    found.pairs += part.pairs;
    found.largest_share = std::max(found.largest_share, part.largest_share);
  });
  for (std::vector<std::uint8_t>& dark : found.dark) {
    if (std::ranges::find(dark, std::uint8_t{1}) == dark.end()) dark = {};
  }
  if (std::ranges::all_of(found.dark, [](const auto& dark) { return dark.empty(); })) found.dark.clear();
  return found;
}

}  // namespace penumbra::session
