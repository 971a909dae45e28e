// SPDX-License-Identifier: Apache-2.0
// Part of FrameRenderer: pictures of scenes with instances, rendered in bands of rows.

#include "base/assert.hpp"
#include "session/methods.hpp"
#include "session/pictures/frame_render.hpp"
#include "session/process/stopwatch.hpp"
#include "visibility/all_triangles.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace penumbra::session {
namespace {

/// Number of triangles of a part that is rendered at once: a method's hierarchies then take some 200 MB, much of which
/// stays in caches. With five times as many, ten thousand trees took a quarter more processor time.
constexpr std::uint64_t kMostTriangles = 300'000;
/// Number of rows in the first band, which shows how many triangles other bands may need.
constexpr std::uint32_t kFirstRows = 32;

/// Copies the values of some rows over the previous ones.
template <typename T>
void put_rows(std::vector<T>& all, const std::vector<T>& some, std::size_t first, std::size_t end) {
  if (some.empty()) return;
  all.resize(some.size());
  std::copy(some.begin() + static_cast<std::ptrdiff_t>(first), some.begin() + static_cast<std::ptrdiff_t>(end),
            all.begin() + static_cast<std::ptrdiff_t>(first));
}
template <typename T>
void put_rows(std::vector<std::vector<T>>& all, const std::vector<std::vector<T>>& some, std::size_t first,
              std::size_t end) {
  all.resize(some.size());
  for (std::size_t light = 0; light < some.size(); ++light) put_rows(all[light], some[light], first, end);
}

}  // namespace

bool FrameRenderer::shows_in_bands(const std::filesystem::path& bits) const {
  const Frame& frame = picture_.frame;
  return frame.instances != nullptr && !frame.instances->empty() && frame.moments.empty() && frame.pixel_side == 1 &&
         bits.empty();
}

bool FrameRenderer::passes_triangles() const {
  const Frame& frame = picture_.frame;
  return frame.instances != nullptr && !frame.instances->empty() &&
         session::passes_triangles(wish_.method, wish_.options);
}

void FrameRenderer::render_passing(const scenes::Scene& scene, const std::filesystem::path& bits) {
  PENUMBRA_ASSERT(picture_.frame.moments.empty() && picture_.frame.pixel_side == 1,
                  "{} looks at the triangles of one moment, for pixels' centres", wish_.method);
  Stopwatch watch;
  maker_.look_into(scene, *picture_.frame.instances, false);
  spent_.load += watch.seconds();
  maker_.show_seen(picture_.frame.camera, progress_);
  note_seconds(maker_);
  check_wanted_layers();
  picture_.all = &maker_.all_triangles();
  const auto leave = [&] {
    for (Kept& kept : kept_) {
      visibility::pass(*kept.method, nullptr);
      kept.prepared = nullptr;  // unseen triangles may move before the next picture
    }
    picture_.all = nullptr;
    maker_.look_away();
  };
  try {
    run_methods(bits);
  } catch (...) {  // the live view cancelled the picture
    leave();
    throw;
  }
  leave();
  picture_.run.counters["meshTreesBuilt"] = maker_.mesh_trees_built();
}

void FrameRenderer::render_in_bands(const scenes::Scene& scene) {
  picture_.in_bands = true;
  done_.lights_something.clear();
  const auto [width, height] = maker_.picture_size(scene, picture_.frame.camera);
  Stopwatch watch;
  maker_.look_into(scene, *picture_.frame.instances, counts_dome_samples(wish_, scene.lights));
  spent_.load += watch.seconds();
  std::vector<std::vector<float>> visibility;
  std::vector<std::vector<glm::vec3>> beauty;
  std::vector<float> alpha;
  std::vector<std::vector<std::uint32_t>> masks;
  MethodRun all;
  std::uint64_t parts = 0, most = 0;
  for (std::uint32_t row = 0, rows = kFirstRows; row < height;) {
    const visibility::Tile band{row, std::min(rows, height - row)};
    maker_.show_part(band, picture_.frame.camera, progress_);
    note_seconds(maker_);
    if (row == 0) check_wanted_layers();
    picture_.masks.clear();
    run_methods({});
    if (row > 0) add_times(picture_.run, all);
    watch.restart();
    const std::size_t first = std::size_t{row} * width, end = first + std::size_t{band.row_count} * width;
    put_rows(visibility, picture_.run.visibility, first, end);
    put_rows(beauty, picture_.beauty, first, end);
    put_rows(alpha, picture_.alpha, first, end);
    masks.resize(picture_.masks.size());
    for (std::size_t light = 0; light < masks.size(); ++light) {
      const std::size_t words = picture_.masks[light].size() / picture_.alpha.size();
      put_rows(masks[light], picture_.masks[light], first * words, end * words);
    }
    all = std::move(picture_.run);
    spent_.beauty += watch.seconds();
    const std::uint64_t triangles = std::max<std::uint64_t>(session().numbers.size(), 1);
    ++parts;
    most = std::max(most, triangles);
    row += band.row_count;
    // Rows for which the last band would have filled the memory, but at most twice as many: the next rows may differ.
    const std::uint64_t wanted = band.row_count * kMostTriangles / triangles;
    rows = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(wanted, 1, std::uint64_t{2} * band.row_count));
  }
  // Outputs of surfaces need only the visible triangles.
  if (parts > 1) {
    maker_.show_viewed(picture_.frame.camera, progress_);
    note_seconds(maker_);
  }
  maker_.look_away();
  all.counters["partsOfPicture"] = parts;
  all.counters["trianglesOfLargestPart"] = most;
  all.counters["meshTreesBuilt"] = maker_.mesh_trees_built();
  picture_.run = std::move(all);
  picture_.run.visibility = std::move(visibility);
  picture_.beauty = std::move(beauty);
  picture_.alpha = std::move(alpha);
  picture_.masks = std::move(masks);
  picture_.in_bands = false;
  say_idle_lights();
}

}  // namespace penumbra::session
