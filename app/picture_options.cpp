// SPDX-License-Identifier: Apache-2.0
// Adds the options of commands that write pictures.

#include "app/picture_options.hpp"

#include "app/run_options.hpp"

#include <CLI/CLI.hpp>

namespace penumbra::app {

void add_picture_options(CLI::App& command, session::PictureOptions& options) {
  add_run_options(command, options.run);
  command
      .add_option("-o,--output", options.run.out,
                  "image to write: linear beauty and V (both also for each light), positions, normals, ids")
      ->required()
      ->type_name("OUT.exr");
  command
      .add_option("--method", options.method,
                  "shadow method, see `penumbra methods`, with options if any (NAME:key=value:...) (default: for each "
                  "light the best method with exact areas; if light samples are requested, or there is no such method, "
                  "the best geometry-based one, or rays)")
      ->type_name("NAME");
  command.add_option("--stats", options.stats, "times, counters and warnings as JSON; times of one run, the first")
      ->type_name("FILE.json");
  command.add_option("--png", options.png, "tone-mapped beauty image (sRGB)")->type_name("FILE.png");
  command
      .add_option(
          "--exposure", options.exposure,
          "exposure of the PNG: auto (from lit surfaces, without light bodies), first (that of a sequence's first "
          "frame for all), stops, or FILE.exr (that picture's exposure)")
      ->type_name("auto|first|EV|FILE.exr");
  command.add_option("--bits", options.bits, "every pair's answer for the first light (penumbra-bits/1; mask methods)")
      ->type_name("FILE");
  command
      .add_option("--frames", options.frames,
                  "frames of a sequence, every N-th of them; the number replaces \"####\" or \"%04d\" in files' names, "
                  "else it precedes the extension")
      ->type_name("A-B[xN]");
  command.add_option("--fps", options.fps, "frame F is F / fps seconds of a glTF animation (default: 24)")
      ->type_name("N");
  command
      .add_option("--pixel-samples", options.pixel_samples,
                  "view samples per pixel, on a square grid; R G B A and V are their mean: 1, 4, 9 … 64; other numbers "
                  "are rounded up to one of these (default: 1, the pixel's centre)")
      ->type_name("S");
  command
      .add_option("--pixel-filter", options.pixel_filter,
                  "weights of the view samples: box (the mean of the pixel's own) or blackman-harris, which includes "
                  "neighbours, as in Blender (default: box)")
      ->type_name("NAME");
  command
      .add_option("--filter-width", options.filter_width,
                  "distance in pixels to which blackman-harris reaches on each side, Cycles' width (default: 1.5)")
      ->type_name("PIXELS");
  command
      .add_option(
          "--pixel-tolerance", options.pixel_tolerance,
          "largest estimated error of V where exact areas at several view samples a pixel are interpolated between "
          "neighbouring pixels (default: 1/512; 0: every view sample is evaluated)")
      ->type_name("V");
  command
      .add_option(
          "--light-cutoff", options.light_cutoff,
          "leaves out a light at pixels where, even if nothing blocked it, it would contribute at most this share of "
          "the light of all lights, in each of R, G and B; its V is 0 there (default: 0, no light is left out)")
      ->type_name("E");
  command
      .add_option(
          "--motion-samples", options.motion_samples,
          "moments at which the shutter is open; R G B A and V are their mean: 1 to 256 (default: 1, the frame's)")
      ->type_name("N");
  command
      .add_option("--shutter", options.shutter,
                  "time for which the shutter is open, centred on the frame's time, in frames (default: 0.5)")
      ->type_name("FRAMES");
  command
      .add_option(
          "--aperture", options.aperture,
          "radius of the camera's lens in the scene's unit; each view sample of a pixel has a different point of the "
          "lens, which blurs surfaces away from the focus distance (default: the camera's; 0: everything is sharp)")
      ->type_name("RADIUS");
  command
      .add_option("--focus-distance", options.focus_distance,
                  "distance along the view axis at which surfaces are sharp (default: the camera's)")
      ->type_name("D");
  command
      .add_option(
          "--instances", options.instances,
          "meshes that occur several times in the scene: copies, shared (stored once; only visible triangles and those "
          "that "
          "may shade them are copied), or auto (shared if copies would exceed 500000 triangles, and the method is "
          "exact for each pair or area, or draws one map) (default: auto)")
      ->type_name("NAME");
  command.add_flag("--skip-existing", options.skip_existing, "skip pictures whose files all exist: resumes a sequence");
}

void add_moments(CLI::App& command, session::PictureOptions& options) {
  command
      .add_option("--moment", options.moments,
                  "file of the scene at one moment of the open shutter; may be given several times. R G B A and V are "
                  "the mean over these files and not of SCENE; everything else is from SCENE")
      ->type_name("FILE")
      ->allow_extra_args(false);
}

void add_tev(CLI::App& command, std::string& address) {
  command
      .add_option("--tev", address,
                  "show each picture in the viewer tev that listens at this address, such as 127.0.0.1:14158")
      ->type_name("HOST:PORT");
}

}  // namespace penumbra::app
