// SPDX-License-Identifier: Apache-2.0
// `penumbra convert`: reads a scene or a mesh, adds a studio if requested, and writes the scene as the program
// understood it, in world space, as .json, .glb or .obj. All files to be written are known before reading begins, and
// refused if they are inputs.

#include "app/commands.hpp"
#include "app/reading_options.hpp"
#include "app/run_options.hpp"
#include "base/error.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/formats/writer.hpp"
#include "scenes/instances.hpp"
#include "session/options.hpp"
#include "session/process/output_files.hpp"

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

namespace penumbra::app {
namespace {

class ConvertCommand : public Command {
 public:
  explicit ConvertCommand(CLI::App& app)
      : Command(app, "convert", "write the scene as the program understood it, in world space") {
    cli_.add_option("SCENE", scene_, "scene file: .json (penumbra-scene/1), .gltf or .glb; or a mesh file")->required();
    cli_.add_option("-o,--output", out_,
                    "FILE.json (textures of lights are written next to it: FILE-light0.exr; without alpha and pictures "
                    "of materials), FILE.glb "
                    "(no textures of lights) or FILE.obj (geometry alone)")
        ->required()
        ->type_name("FILE");
    cli_.add_option("--instances", instances_,
                    "meshes that occur several times in the scene: copies (a separate mesh each, in world space), "
                    "shared (one mesh with several instances; not in .obj), or auto (shared in .glb, and in .json "
                    "where it reads back as the "
                    "same scene or copies would exceed 500000 triangles) (default: auto)")
        ->type_name("NAME");
    add_allow_outside(cli_, allow_outside_);
    add_lenient(cli_, lenient_);
    add_gltf_options(cli_, gltf_);
    add_studio_options(cli_, studio_);
    cli_.add_option("--camera", camera_,
                    "an additional camera, which becomes the first: fit for a camera that sees the whole scene, or "
                    "EX,EY,EZ:TX,TY,TZ[:FOV]")
        ->type_name("fit|E:T[:FOV]");
  }

  int run(const GlobalOptions&) override {
    constexpr std::array kExtensions = {".json", ".glb", ".obj"};
    if (std::ranges::find(kExtensions, out_.extension()) == kExtensions.end()) {
      throw UsageError("-o {}: expected a name that ends in .json, .glb or .obj", out_.string());
    }
    scenes::ReadOptions reading = session::read_options(gltf_, allow_outside_);
    reading.lenient = lenient_;
    reading.studio = session::parse_studio(studio_, camera_);
    if (!camera_.empty() && reading.studio.fit_camera.empty() && !reading.studio.camera)
      throw UsageError("--camera {}: expected fit, or EX,EY,EZ:TX,TY,TZ[:FOV]", camera_);
    reading.needs_light = out_.extension() != ".obj";  // an .obj contains no light
    const scenes::WriteOptions writing{.lenient = lenient_, .instances = parse_instances()};
    scenes::Instances instances;
    reading.instances = &instances;
    reading.bytes_per_copy = scenes::writer_bytes_per_triangle(out_);  // a studio is built around copies
    session::OutputFiles outputs;
    outputs.add("-o", out_);
    outputs.refuse_inputs({&scene_, 1});
    outputs.require_writable();
    scenes::Scene scene = scenes::read_scene(scene_, reading);
    for (const std::filesystem::path& texture : scenes::texture_files(scene, out_)) outputs.add("-o", texture);
    scene.sources.push_back(scene_);
    outputs.refuse_inputs(scene.sources);
    for (const std::string& warning : scene.warnings) spdlog::warn("{}", warning);
    for (const std::string& loss : scenes::write_scene(scene, out_, writing, instances)) spdlog::warn("{}", loss);
    spdlog::info("{}: {} triangles, {} lights", out_.string(), scenes::triangle_count(scene, instances),
                 scene.lights.size());
    return 0;
  }

 private:
  [[nodiscard]] scenes::WriteInstances parse_instances() const {
    using scenes::WriteInstances;
    if (instances_ == "copies") return WriteInstances::copies;
    if (instances_.empty() || instances_ == "auto") return WriteInstances::automatic;
    if (instances_ != "shared") throw UsageError("--instances {}: expected auto, copies or shared", instances_);
    if (out_.extension() == ".obj") throw UsageError("--instances shared: .obj has no instances; write .json or .glb");
    return WriteInstances::shared;
  }

  std::filesystem::path scene_, out_;
  bool allow_outside_ = false, lenient_ = false;
  session::GltfOptions gltf_;
  session::StudioOptions studio_;
  std::string camera_, instances_;
};

}  // namespace

std::unique_ptr<Command> make_convert_command(CLI::App& app) {
  return std::make_unique<ConvertCommand>(app);
}

}  // namespace penumbra::app
