// SPDX-License-Identifier: Apache-2.0
// A picture of `serve`: the arguments of `render`, parsed by the same code, on a device and methods that are kept from
// picture to picture.

#include "app/serve/picture_job.hpp"

#include "app/picture_options.hpp"
#include "base/error.hpp"
#include "session/machine.hpp"
#include "session/options.hpp"
#include "session/output.hpp"
#include "session/pictures/picture_scene.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <tuple>
#include <utility>

namespace penumbra::app {
namespace {

session::PictureOptions parse_picture(const std::vector<std::string>& arguments) {
  session::PictureOptions options;
  CLI::App app("", "render");
  add_picture_options(app, options);
  add_moments(app, options);
  try {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    app.parse(reversed);
  } catch (const CLI::ParseError& error) {
    throw UsageError("{}", error.what());
  }
  return options;
}

auto format_key(const session::FormatOptions& format) {
  return std::tie(format.layers, format.half, format.compression);
}

}  // namespace

void PictureJob::run(const std::vector<std::string>& arguments) {
  session::PictureOptions options = parse_picture(arguments);
  session::PictureRequest request = session::parse_request(options);
  if (request.frames.size() != 1 || options.run.camera == "all" || (request.moments > 1 && options.moments.empty()))
    throw UsageError("expected one camera and one frame; moments of an open shutter must be given as files (--moment)");
  session::OutputFiles outputs = session::outputs_of(options, request.frames, {options.run.camera});
  outputs.require_writable();
  session::check_png_name(options);
  const bool same_device = kept_ && kept_->options.run.device == options.run.device;
  const bool same = same_device && format_key(kept_->options.run.format) == format_key(options.run.format);
  if (!same) {
    const render::Machine machine = same_device ? kept_->machine : session::make_machine(options.run.device);
    kept_.reset();
    kept_ = std::make_unique<Kept>(Kept{options, request, machine, nullptr});
    kept_->renderer =
        std::make_unique<session::FrameRenderer>(kept_->options.run, kept_->request.wish, machine, progress_);
    kept_->renderer->expect_frames();
  }
  kept_->options = std::move(options);
  kept_->request = std::move(request);
  const session::PictureRequest& now = kept_->request;
  try {
    session::PictureScene read = session::read_picture_scene(kept_->options.run, std::nullopt, now);
    outputs.refuse_inputs(read.scene.sources);
    const session::FrameFiles files = session::files_of(kept_->options, now.frames.front(), kept_->options.run.camera);
    auto moments = session::moments_in_files(kept_->options, now, read);
    kept_->renderer->render(std::move(read.scene),
                            {now.frames.front(), kept_->options.run.camera, now.pixel_side, now.filter,
                             now.pixel_tolerance, std::move(moments), &read.instances, false, now.light_cutoff},
                            files.bits, read.seconds);
    session::Exposure exposure = now.exposure;
    progress_.info(session::summary(kept_->renderer->write(files, exposure)));
  } catch (...) {
    kept_.reset();  // its data may belong partly to one picture and partly to another
    throw;
  }
}

}  // namespace penumbra::app
