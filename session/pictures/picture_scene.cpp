// SPDX-License-Identifier: Apache-2.0
// Reads the scene of a picture with the requested lens, makes copies of instances where the method needs them, and
// measures the time of all this.

#include "session/pictures/picture_scene.hpp"

#include "base/error.hpp"
#include "scenes/picture_size.hpp"
#include "scenes/whole_view.hpp"
#include "session/process/stopwatch.hpp"
#include "session/session.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <future>
#include <memory>
#include <utility>

namespace penumbra::session {
namespace {

using Size = std::pair<std::uint32_t, std::uint32_t>;

/// Returns the size of the picture of one of a scene's cameras, the first if none is named; nullopt: there is none.
std::optional<Size> size_of(const scenes::Scene& scene, const std::string& camera) {
  const auto found =
      camera.empty() ? scene.cameras.begin() : std::ranges::find(scene.cameras, camera, &scenes::Camera::name);
  if (found == scene.cameras.end()) return std::nullopt;
  return picture_size(scene, *found);
}

/// Files of --moment, read one after the other, each while the previous one is in use.
class MomentFiles {
 public:
  MomentFiles(const PictureOptions& options, const PictureRequest& request, const scenes::Scene& own)
      : options_(options), request_(request), origin_(own.origin) {
    if (options.run.size.empty()) size_ = size_of(own, options.run.camera);
  }

  PictureScene take(std::size_t moment) {
    std::future<PictureScene> wanted = coming_.valid() ? std::move(coming_) : begin(moment);
    PictureScene read = wanted.get();
    if (moment + 1 < options_.moments.size()) coming_ = begin(moment + 1);
    return read;
  }

 private:
  std::future<PictureScene> begin(std::size_t moment) {
    return std::async(std::launch::async, [this, moment] { return read(moment); });
  }

  [[nodiscard]] PictureScene read(std::size_t moment) const {
    RunOptions run = options_.run;
    run.scene = options_.moments[moment];
    PictureScene read = read_picture_scene(run, std::nullopt, request_);
    const auto size = size_of(read.scene, run.camera);  // a missing camera is reported by the session
    if (size_ && size && size != size_)
      throw InputError("{}: a picture of {}x{} pixels, but SCENE's has {}x{}; set one size for all with --size",
                       run.scene.string(), size->first, size->second, size_->first, size_->second);
    if (origin_) read.scene.origin = origin_;
    return read;
  }

  const PictureOptions& options_;
  const PictureRequest& request_;
  std::optional<glm::dvec3> origin_;
  std::optional<Size> size_;          // nullopt: --size is given
  std::future<PictureScene> coming_;  // last: its thread uses the other members
};

}  // namespace

PictureScene read_picture_scene(const RunOptions& run, std::optional<double> time, const PictureRequest& request,
                                scenes::ScenesAhead* ahead) {
  const Stopwatch watch;
  PictureScene read;
  read.scene = read_session_scene(
      run, time, {.instances = &read.instances, .ahead = ahead, .bytes_per_copy = bytes_per_copy(request.wish, {})});
  set_lens(read.scene, request, run.camera);
  if (needs_copies(read.scene, read.instances, request.instances, request.wish, request.view_samples())) {
    const std::uint64_t bytes = bytes_per_copy(request.wish, read.scene.lights);
    read.scene = copied(std::move(read.scene), std::exchange(read.instances, {}), bytes);
  }
  read.seconds = watch.seconds();
  return read;
}

std::vector<std::function<PictureScene()>> moments_in_files(const PictureOptions& options,
                                                            const PictureRequest& request, PictureScene& own) {
  // No common origin for a scene with instances: it has positions outside the soup, and its parts are evaluated again
  // at each moment in any case.
  if (!options.moments.empty() && !own.scene.origin && own.instances.empty())
    own.scene.origin = scenes::bounds_of(own.scene.soup.positions).middle();
  const auto files = std::make_shared<MomentFiles>(options, request, own.scene);
  std::vector<std::function<PictureScene()>> all;
  for (std::size_t moment = 0; moment < options.moments.size(); ++moment)
    all.emplace_back([files, moment] { return files->take(moment); });
  return all;
}

}  // namespace penumbra::session
