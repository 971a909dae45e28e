// SPDX-License-Identifier: Apache-2.0
// Command `bake`: options and the run.

#include "app/bake/baked_mesh.hpp"
#include "app/bake/vertex_file.hpp"
#include "app/commands.hpp"
#include "app/process/process.hpp"
#include "app/process/terminal_progress.hpp"
#include "app/run_options.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "session/machine.hpp"
#include "session/methods.hpp"
#include "session/parse.hpp"
#include "session/pictures/frames.hpp"
#include "session/pictures/request.hpp"
#include "session/process/output_files.hpp"
#include "session/process/process_clock.hpp"

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

namespace penumbra::app {
namespace {

/// Memory per triangle that the command itself takes: a copy of the corners, and the index in the baked mesh.
constexpr std::uint64_t kOwnTriangle = sizeof(mesh::Triangle) + sizeof(std::uint32_t);

constexpr std::uint32_t kDefaultSide = 512, kMostMargin = 1024;
constexpr std::uint32_t kPointsInARow = 256;  // row length of the picture that holds the vertices' view samples

class BakeCommand : public Command {
 public:
  explicit BakeCommand(CLI::App& app)
      : Command(app, "bake", "compute V and irradiance at texels of a mesh's lightmap, or at its vertices") {
    add_run_options(cli_, options_.run);
    cli_.remove_option(cli_.get_option("--camera"));
    cli_.get_option("--size")
        ->description(fmt::format("texels of the map: S for a square, or WxH (default: {})", kDefaultSide))
        ->type_name("S|WxH");
    cli_.add_option("--mesh", mesh_,
                    "name of the mesh to bake: all meshes of that name, and all materials of a glTF mesh")
        ->required()
        ->type_name("NAME");
    auto* uv = cli_.add_option("--uv", lightmap_.set,
                               "number of the texture coordinates that map the mesh: TEXCOORD_N of glTF; OBJ files and "
                               "quads of JSON have one set, 0")
                   ->type_name("N")
                   ->default_str("0");
    cli_.add_flag("--vertices", vertices_, "values at vertices in place of a map, as MAP.ply")->excludes(uv);
    cli_.add_option("-o,--output", options_.run.out,
                    "MAP.exr: the channels of `render`; R G B are the irradiance, A is 1 on texels of the mesh. With "
                    "--vertices: MAP.ply")
        ->required()
        ->type_name("MAP.exr|MAP.ply");
    cli_.add_option("--side", side_, "side to bake: front (from where triangles are counter-clockwise) or back")
        ->type_name("front|back")
        ->capture_default_str();
    cli_.add_option("--margin", margin_,
                    "width in texels of the margin around the mesh's texels, filled with the nearest texel's value")
        ->type_name("N")
        ->check(CLI::Range(0U, kMostMargin))
        ->capture_default_str();
    cli_.add_option("--method", options_.method,
                    "shadow method, see `penumbra methods`, with options if any (NAME:key=value:...) (default: as in "
                    "`render`: exact areas if a method computes them)")
        ->type_name("NAME");
    cli_.add_option("--stats", options_.stats, "times, counters and warnings as JSON")->type_name("FILE.json");
    cli_.add_option("--png", options_.png, "the irradiance as a picture for viewing")->type_name("FILE.png");
    cli_.add_option("--exposure", options_.exposure,
                    "exposure of the PNG: auto, stops, or FILE.exr (that picture's exposure) "
                    "(default: auto)")
        ->type_name("auto|EV|FILE.exr");
    cli_.add_option("--frame", options_.frame,
                    "one frame of the scene's animation, or a moment between two, such as 12.5")
        ->type_name("F");
    cli_.add_option("--fps", options_.fps, "frame F is F / fps seconds of a glTF animation (default: 24)")
        ->type_name("N");
    cli_.footer(
        "Each texel whose centre lies on the mesh is a view sample there, on the mesh's own triangle, with its "
        "geometric normal; V and irradiance are what `render` finds at such a point. See docs/bake.md.\n");
  }

  int run(const GlobalOptions& global) override {
    const session::PictureRequest request = checked_request();
    const auto side = parse_side();
    const session::OutputFiles outputs = claimed_outputs();
    TerminalProgress progress(!global.quiet);
    const render::Machine machine = session::make_machine(options_.run.device);
    progress.begin("reading " + options_.run.scene.filename().string(), 1);
    std::optional<double> time;
    if (request.frames.front()) time = *request.frames.front() * request.seconds_per_frame;
    scenes::Scene scene =
        session::read_session_scene(options_.run, time,
                                    {.lightmap = vertices_ ? nullptr : &lightmap_,
                                     .bytes_per_copy = kOwnTriangle + session::bytes_per_copy(request.wish, {})});
    outputs.refuse_inputs(scene.sources);
    const BakedMesh mesh = find_baked(scene, mesh_);
    progress.clear();
    std::vector<std::string> notes;
    const std::vector<visibility::SurfacePoint> points = find_points(scene, mesh, notes);
    for (const std::string& note : notes) spdlog::warn("{}", note);
    prepare_scene(scene, mesh);
    const std::vector<glm::dvec3> positions = vertices_ ? scene.soup.positions : std::vector<glm::dvec3>();
    const std::vector<mesh::Triangle> triangles = scene.soup.triangles;

    session::FrameRenderer renderer(options_.run, request.wish, machine, progress);
    const auto sources = visibility::margin_sources(points, width_, vertices_ ? 0 : margin_);
    renderer.look_at_surface({[&](const visibility::SceneFloats& floats, const visibility::PinholeCamera& camera) {
                                return visibility::surface_view_samples(floats, triangles, camera, points, side);
                              },
                              [&](session::RenderedFrame& frame, const session::Session& session) {
                                make_irradiance(frame, session);
                                if (!vertices_) fill_margins(frame, sources);
                              },
                              {{"penumbra.bake", fmt::format("mesh {}, coordinates {}, side {}: R G B are irradiance",
                                                             mesh_, lightmap_.set, side_)}}});
    session::Frame frame;
    frame.number = request.frames.front();
    renderer.render(std::move(scene), frame, {}, session::seconds_since_start());
    if (vertices_) {
      write_vertices(renderer, positions);
      return 0;
    }
    session::Exposure exposure = request.exposure;
    const std::string made =
        session::summary(renderer.write({options_.run.out, options_.stats, options_.png, {}}, exposure));
    const auto covered = std::ranges::count_if(points, [](const auto& point) { return point.triangle >= 0; });
    spdlog::info("{} texels of \"{}\"; {}", covered, mesh_, made);
    return 0;
  }

 private:
  /// Checks the command line before any long work.
  [[nodiscard]] session::PictureRequest checked_request() {
    std::string& size = options_.run.size;
    if (size.empty()) size = fmt::format("{}", kDefaultSide);
    if (session::parse_integer<std::uint32_t>(size)) size = fmt::format("{0}x{0}", size);
    std::tie(width_, height_) = session::parse_size(size);
    // Checks the other options as `render` does for an output whose name ends in .exr.
    session::PictureOptions as_picture = options_;
    if (vertices_) {
      if (options_.run.out.extension() != ".ply")
        throw UsageError("-o {}: expected a name that ends in .ply (--vertices)", options_.run.out.string());
      if (!options_.png.empty() || !options_.stats.empty())
        throw UsageError("--vertices: {} applies to a map only; leave it out",
                         options_.png.empty() ? "--stats" : "--png");
      as_picture.run.out.replace_extension(".exr");
    }
    if (options_.exposure == "first")
      throw UsageError("--exposure first: a bake has one frame; expected auto or stops");
    return session::parse_request(as_picture);
  }

  [[nodiscard]] visibility::SurfaceSide parse_side() const {
    if (side_ == "front") return visibility::SurfaceSide::front;
    if (side_ == "back") return visibility::SurfaceSide::back;
    throw UsageError("--side {}: expected front or back", side_);
  }

  [[nodiscard]] session::OutputFiles claimed_outputs() const {
    session::check_png_name(options_);
    session::OutputFiles outputs;
    outputs.add("-o", options_.run.out);
    outputs.add("--stats", options_.stats);
    outputs.add("--png", options_.png);
    outputs.refuse_inputs({&options_.run.scene, 1});
    outputs.require_writable();
    return outputs;
  }

  /// Finds the points; also sets the size of the picture of view samples.
  std::vector<visibility::SurfacePoint> find_points(const scenes::Scene& scene, const BakedMesh& mesh,
                                                    std::vector<std::string>& notes) {
    if (!vertices_) return lightmap_points(scene, mesh, lightmap_, width_, height_, notes);
    at_vertices_ = vertex_points(scene, mesh, kPointsInARow);
    width_ = kPointsInARow;
    height_ = static_cast<std::uint32_t>(at_vertices_.points.size() / width_);
    options_.run.size = fmt::format("{}x{}", width_, height_);
    return at_vertices_.points;
  }

  void write_vertices(session::FrameRenderer& renderer, const std::vector<glm::dvec3>& positions) const {
    session::RenderedFrame frame = renderer.take();
    make_irradiance(frame, renderer.session());
    write_vertex_ply(options_.run.out, positions, at_vertices_,
                     values_at_vertices(at_vertices_, frame, renderer.session()));
    spdlog::info("{}: {} vertices of \"{}\", {} points", options_.run.out.string(), at_vertices_.vertices.size(), mesh_,
                 at_vertices_.weights.size());
  }

  session::PictureOptions options_;
  scenes::LightmapPlaces lightmap_;
  std::string mesh_, side_ = "front";
  std::uint32_t margin_ = 8, width_ = 0, height_ = 0;
  bool vertices_ = false;
  VertexPoints at_vertices_;
};

}  // namespace

std::unique_ptr<Command> make_bake_command(CLI::App& app) {
  return std::make_unique<BakeCommand>(app);
}

}  // namespace penumbra::app
