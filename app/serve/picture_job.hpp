#pragma once

#include "app/pictures/frame_render.hpp"
#include "app/pictures/request.hpp"
#include "app/process/progress.hpp"
#include "render/machine.hpp"

#include <memory>
#include <string>
#include <vector>

namespace penumbra::app {

/// Pictures that are written as `render` writes them, one after the other. What does not change from one to the next is
/// kept: the device, methods, and of meshes what still holds.
class PictureJob {
 public:
  /// It must outlive this object.
  explicit PictureJob(Progress& progress) : progress_(progress) {}
  /// `arguments`: what would follow `penumbra render`. Throws Error for what that would refuse, and for a sequence.
  void run(const std::vector<std::string>& arguments);

 private:
  /// What cannot change from picture to picture.
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
