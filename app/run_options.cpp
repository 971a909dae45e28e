// SPDX-License-Identifier: Apache-2.0
// Adds options common to several commands.

#include "app/run_options.hpp"

#include "app/reading_options.hpp"

#include <CLI/CLI.hpp>

namespace penumbra::app {
namespace {

void add_format_options(CLI::App& command, session::FormatOptions& format) {
  command
      .add_option(
          "--layers", format.layers,
          "content of the EXR: names of layers or channels with commas between, * and ? in them, and beauty for "
          "R G B A; such as beauty,V,Z,key,P or 'beauty,*_light' (default: all but <light>_light and "
          "<light>_V, which repeat a light's R G B and V in the form that Blender's compositor needs)")
      ->type_name("NAME,…");
  command.add_flag("--half", format.half, "16 bits in the EXR for colours, V and N; P, Prel, Z, id and mattes keep 32");
  command
      .add_option(
          "--compression", format.compression,
          "compression of the EXR: zip, zips (line by line), none, or dwaa, lossy for colours only (default: zip)")
      ->type_name("NAME");
}

}  // namespace

void add_gltf_options(CLI::App& command, session::GltfOptions& gltf) {
  command
      .add_option("--lamp-radius", gltf.radius,
                  "glTF: radius of point and spot lamps whose file gives none (default: 0.1)")
      ->type_name("R");
  command
      .add_option("--sun-angle", gltf.sun_angle,
                  "glTF: apparent diameter in degrees of sun lamps whose file gives none (default: 0.53)")
      ->type_name("DEGREES");
  command
      .add_option(
          "--lumens-per-watt", gltf.lumens_per_watt,
          "glTF: divide the intensities of lamps by N (default: 1; for files of Blender's exporter, which multiplies "
          "by it, 683; for its versions before 3.4.36 4 pi, and 1 for suns)")
      ->type_name("N");
  command
      .add_option("--clip", gltf.clips,
                  "glTF: play this animation alone, by its name or its number from 0; may be given again (default: all "
                  "that can be played together; if several move the same node, only the first of these)")
      ->type_name("NAME|N")
      ->allow_extra_args(false);
}

void add_studio_options(CLI::App& command, session::StudioOptions& options) {
  command.add_flag(
      "--studio", options.always,
      "add a soft rectangle light and a floor to the scene, as is done for a mesh or a glTF without lights");
  command.add_flag("--no-studio", options.never, "refuse a scene without lights")->excludes("--studio");
  command
      .add_option("--floor", options.floor,
                  "floor of a studio: none, or auto (a floor if the scene does not already lie on one)")
      ->type_name("none|auto")
      ->capture_default_str();
  command
      .add_option(
          "--add-light", options.lights,
          "an additional light: rectangle:X,Y,Z:SIZE, sphere:X,Y,Z:RADIUS (both in the scene's unit, turned to its "
          "middle), sun:X,Y,Z:ANGLE (direction of its light, degrees), dome (all around); may be given again")
      ->type_name("KIND:…")
      ->allow_extra_args(false);
}

void add_run_options(CLI::App& command, session::RunOptions& options) {
  command
      .add_option("SCENE", options.scene,
                  "scene file: .json (penumbra-scene/1), .gltf, .glb, .fbx or .dae; or a mesh file, around which a "
                  "studio is put; "
                  "`render` also takes mesh.####.obj, one file per frame")
      ->required();
  command
      .add_option("--light-samples", options.light_samples,
                  "light samples: N or LxB, 1 to 4096 points (default: 256, or none if `render` computes exact areas)")
      ->type_name("N|LxB");
  command.add_option("--sample-pattern", options.sample_pattern, "rows, grid, sobol, jittered or rgss (default: rows)")
      ->type_name("NAME");
  command.add_option("--sample-seed", options.sample_seed, "seed of sobol and jittered")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--size", options.size, "image size in pixels (default: the scene's)")->type_name("WxH");
  command
      .add_option("--light", options.lights,
                  "only this light; may be given again; channel V, --bits and errors are those of the first (default: "
                  "all of the scene's, in its order)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command
      .add_option(
          "--camera", options.camera,
          "camera to look through: one of the scene's by its name, fit for a camera that sees the whole scene, or "
          "EX,EY,EZ:TX,TY,TZ[:FOV] (eye, target and vertical field of view in degrees) (default: the scene's first)")
      ->type_name("NAME|fit|E:T[:FOV]");
  command
      .add_option("--device", options.device, "Vulkan device: part of its name, its index, or cpu (default: the best)")
      ->type_name("NAME|INDEX|cpu");
  command.add_option("--method-option", options.method_options, "option of the method; may be given again")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  add_allow_outside(command, options.allow_outside);
  command
      .add_option("--normals", options.normals,
                  "normals of the beauty: shading (the file's smooth ones, if any) or geometric (facets); visibility "
                  "always uses the triangles' (default: shading)")
      ->type_name("NAME");
  add_lenient(command, options.lenient);
  add_gltf_options(command, options.gltf);
  add_studio_options(command, options.studio);
  add_format_options(command, options.format);
}

}  // namespace penumbra::app
