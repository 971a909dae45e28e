// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/pictures/frame_render.hpp"
#include "app/pictures/request.hpp"
#include "app/process/progress.hpp"
#include "render/machine.hpp"

#include <memory>
#include <string>
#include <vector>

namespace penumbra::app {

/// Writes pictures as `render` does, one after another. Unchanged data are kept between pictures: the device, methods,
/// and the valid parts of meshes' structures.
class PictureJob {
 public:
  /// `progress` must outlive this object.
  explicit PictureJob(Progress& progress) : progress_(progress) {}
  /// Writes one picture. `arguments`: those of `penumbra render`. Throws Error if `render` would reject them, and for a
  /// sequence.
  void run(const std::vector<std::string>& arguments);

 private:
  /// Data that are constant from picture to picture.
  struct Kept {
    PictureOptions options;
    PictureRequest request;
    render::Machine machine;
    std::unique_ptr<FrameRenderer> renderer;  // refers to these
  };

  Progress& progress_;
  std::unique_ptr<Kept> kept_;
};

}  // namespace penumbra::app
