// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/machine.hpp"
#include "session/pictures/frame_render.hpp"
#include "session/pictures/request.hpp"
#include "session/process/progress.hpp"

#include <memory>
#include <string>
#include <vector>

namespace penumbra::app {

/// Writes pictures as `render` does, one after another. Unchanged data are kept between pictures: the device, methods,
/// and the valid parts of meshes' structures.
class PictureJob {
 public:
  /// `progress` must outlive this object.
  explicit PictureJob(session::Progress& progress) : progress_(progress) {}
  /// Writes one picture. `arguments`: those of `penumbra render`. Throws Error if `render` would reject them, and for a
  /// sequence.
  void run(const std::vector<std::string>& arguments);

 private:
  /// Data that are kept from picture to picture.
  struct Kept {
    session::PictureOptions options;
    session::PictureRequest request;
    render::Machine machine;
    std::unique_ptr<session::FrameRenderer> renderer;  // refers to these
  };

  session::Progress& progress_;
  std::unique_ptr<Kept> kept_;
};

}  // namespace penumbra::app
