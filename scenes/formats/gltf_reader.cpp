#include "scenes/formats/gltf_reader.hpp"

#include "base/error.hpp"
#include "mesh/import_helper.hpp"
#include "mesh/import_wire.hpp"
#include "scenes/scene_wire.hpp"

#include <utility>

namespace penumbra::scenes {

Scene read_gltf(const std::filesystem::path& file, const ReadOptions& options) {
  const mesh::InputFile input = mesh::open_input(file);
  mesh::HelperJob job{"gltf", input, {}};
  if (options.allow_outside) job.flags.emplace_back("--allow-outside");
  if (options.lenient) job.flags.emplace_back("--lenient");
  if (!options.needs_light) job.flags.emplace_back("--without-light");
  // {} gives the shortest text that reads back as the same number.
  if (options.lamp_radius) job.flags.push_back(fmt::format("--lamp-radius={}", *options.lamp_radius));
  if (options.sun_angle) job.flags.push_back(fmt::format("--sun-angle={}", *options.sun_angle));
  if (options.lumens_per_watt) job.flags.push_back(fmt::format("--lumens-per-watt={}", *options.lumens_per_watt));
  if (options.time) job.flags.push_back(fmt::format("--time={}", *options.time));
  for (const std::string& clip : options.clips) job.flags.push_back("--clip=" + clip);
  if (options.lightmap != nullptr) job.flags.push_back(fmt::format("--uv={}", options.lightmap->set));
  mesh::HelperAnswer answer = mesh::run_import_helper(job, {});
  try {
    mesh::WireReader from(answer.payload());
    Scene scene = get_scene(from);
    scene.sources = std::move(answer.sources);
    if (options.lightmap != nullptr) {
      options.lightmap->places = from.get_array<glm::dvec2>();
      if (options.lightmap->places.size() != scene.soup.positions.size())
        throw mesh::WireError("not every vertex has a place");
    }
    from.expect_end();
    return scene;
  } catch (const mesh::WireError& error) {
    throw InputError("{}: the importer's answer is damaged ({}); the file is probably damaged", file.string(),
                     error.what());
  }
}

}  // namespace penumbra::scenes
