// SPDX-License-Identifier: Apache-2.0
// Reads the scene of a picture with the lens that the options ask for, makes copies of instances where the method needs
// them, and times all of this.

#include "session/pictures/picture_scene.hpp"

#include "session/process/stopwatch.hpp"
#include "session/session.hpp"

#include <utility>

namespace penumbra::session {

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

}  // namespace penumbra::session
