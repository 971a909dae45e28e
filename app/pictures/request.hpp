#pragma once

#include "app/light_methods.hpp"
#include "app/options.hpp"
#include "app/pictures/frame_render.hpp"
#include "app/process/output_files.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace penumbra::app {

/// What `render` and `submit` are asked for, as the user gave it; what is empty was not said.
struct PictureOptions {
  RunOptions run;
  std::string method, exposure, frames, fps, pixel_samples, pixel_filter, filter_width, pixel_tolerance, motion_samples,
      shutter;
  std::optional<std::string> frame;  ///< of `render` alone
  bool skip_existing = false;
  std::map<std::string, std::string> camera_words;  ///< --camera all: of the scene's cameras, once it is read
  std::filesystem::path stats, png, bits;
};

/// Adds all of them but --frame.
void add_picture_options(CLI::App& command, PictureOptions& options);

/// What they mean, as far as that can be told before the scene is read.
struct PictureRequest {
  MethodWish wish;
  Exposure exposure;
  double seconds_per_frame = 0;
  std::uint32_t pixel_side = 1, moments = 1;
  PixelFilter filter;
  double pixel_tolerance = kPixelTolerance;
  double shutter_frames = 0.5;
  /// One entry without a number if no frame was asked for; a sequence's are whole.
  std::vector<std::optional<double>> frames;
};

/// Throws UsageError; InputError for a picture that --exposure names and that does not say how it was exposed.
PictureRequest parse_request(const PictureOptions& options);

/// Throws UsageError for a --png that does not end so. After outputs_of, whose reasons say more.
void check_png_name(const PictureOptions& options);

/// Where the picture of a frame goes: named after camera and frame, where there are several.
FrameFiles files_of(const PictureOptions& options, std::optional<double> frame, const std::string& camera);
/// Are the frame's files there, of all cameras?
bool is_there(const PictureOptions& options, std::optional<double> frame, const std::vector<std::string>& cameras);
/// All files of these frames and cameras. UsageError if two are one, or one is the scene.
OutputFiles outputs_of(const PictureOptions& options, const std::vector<std::optional<double>>& frames,
                       const std::vector<std::string>& cameras);

}  // namespace penumbra::app
