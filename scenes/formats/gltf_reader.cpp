// SPDX-License-Identifier: Apache-2.0
// Reads glTF scenes through the import helper, so that no parser of a foreign file runs in this process, and reads
// further moments of an animation ahead where memory allows.

#include "scenes/formats/gltf_reader.hpp"

#include "base/descriptor.hpp"
#include "base/error.hpp"
#include "base/file_error.hpp"
#include "base/memory.hpp"
#include "mesh/import_helper.hpp"
#include "mesh/import_wire.hpp"
#include "scenes/formats/json_meshes.hpp"
#include "scenes/formats/scenes_ahead.hpp"
#include "scenes/instances.hpp"
#include "scenes/scene_wire.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace penumbra::scenes {
namespace {

/// Scenes are read ahead only if more memory than this is free: then their bytes (kAheadBytes in import/main.cpp, held
/// three times while they are decoded) are a small part of it.
constexpr std::uint64_t kMemoryForAhead = std::uint64_t{4} << 30U;

/// Reads the pictures of domes, which are looked for next to the file, as with JSON scenes. `has_folder`: whether the
/// file is in a folder.
void read_skies(const std::filesystem::path& file, bool has_folder, const ReadOptions& options, Scene& scene) {
  for (AreaLight& light : scene.lights) {
    const auto* const dome = std::get_if<Dome>(&light.shape);
    if (dome == nullptr || dome->image.empty()) continue;
    if (!has_folder)
      throw InputError("dome \"{}\" names the picture \"{}\", and no folder is given to read it from", light.name,
                       dome->image);
    light.texture =
        read_sky(dome->image, {file.string(), fmt::format("dome \"{}\", image", light.name)}, options, scene);
  }
}

Scene read_by_helper(const mesh::InputFile& input, bool has_folder, const ReadOptions& options) {
  mesh::HelperJob job{"scene", input, {}};
  if (options.allow_outside) job.flags.emplace_back("--allow-outside");
  if (options.lenient) job.flags.emplace_back("--lenient");
  if (!options.needs_light) job.flags.emplace_back("--without-light");
  if (!options.needs_surface) job.flags.emplace_back("--without-surface");
  // {} gives the shortest text that reads back as the same number.
  if (options.lamp_radius) job.flags.push_back(fmt::format("--lamp-radius={}", *options.lamp_radius));
  if (options.sun_angle) job.flags.push_back(fmt::format("--sun-angle={}", *options.sun_angle));
  if (options.lumens_per_watt) job.flags.push_back(fmt::format("--lumens-per-watt={}", *options.lumens_per_watt));
  if (options.time) job.flags.push_back(fmt::format("--time={}", *options.time));
  for (const std::string& clip : options.clips) job.flags.push_back("--clip=" + clip);
  if (options.lightmap != nullptr) job.flags.push_back(fmt::format("--uv={}", options.lightmap->set));
  if (options.instances != nullptr) job.flags.emplace_back("--instances");
  ScenesAhead* const ahead = options.time && memory_room().bytes > kMemoryForAhead ? options.ahead : nullptr;
  if (ahead != nullptr) {
    for (const double time : ahead->times) job.flags.push_back(fmt::format("--then={}", time));
  }
  mesh::HelperAnswer answer = mesh::run_import_helper(job, {.step = options.step});
  try {
    mesh::WireReader from(answer.payload());
    Scene scene = get_scene(from);
    scene.sources = std::move(answer.sources);
    if (options.lightmap != nullptr) {
      options.lightmap->places = from.get_array<glm::dvec2>();
      if (options.lightmap->places.size() != scene.soup.positions.size())
        throw mesh::WireError("the number of lightmap coordinates is wrong");
    }
    if (options.instances != nullptr) *options.instances = get_instances(from, scene);
    read_skies(input.name, has_folder, options, scene);
    const auto further = from.get<std::uint64_t>();
    if (further > (ahead == nullptr ? 0 : ahead->times.size())) throw mesh::WireError("more scenes than asked for");
    for (std::uint64_t i = 0; i < further; ++i) {
      ScenesAhead::Read read{ahead->times[i], get_scene(from), {}};
      read.scene.sources = scene.sources;
      if (options.instances != nullptr) read.instances = get_instances(from, read.scene);
      read_skies(input.name, has_folder, options, read.scene);
      ahead->kept.push_back(std::move(read));
    }
    from.expect_end();
    if (further > 0)
      ahead->times.erase(ahead->times.begin(), ahead->times.begin() + static_cast<std::ptrdiff_t>(further));
    return scene;
  } catch (const mesh::WireError& error) {
    throw InputError("{}: the importer's answer is damaged ({}); the file is probably damaged", input.name.string(),
                     error.what());
  }
}

/// Returns a nameless file that holds these bytes.
Descriptor file_of(std::span<const std::byte> bytes, const std::string& name) {
  Descriptor file(::memfd_create("glb", MFD_CLOEXEC));
  if (!file.is_open()) throw_file_error(errno, name);
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) throw_file_error(errno, name);
    if (written > 0) bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return file;
}

}  // namespace

Scene read_gltf(const std::filesystem::path& file, const ReadOptions& options) {
  if (options.ahead != nullptr && options.time) {
    if (auto read = options.ahead->take(*options.time)) {
      if (options.instances != nullptr) *options.instances = std::move(read->instances);
      return std::move(read->scene);
    }
    auto& times = options.ahead->times;
    if (!times.empty() && times.front() == *options.time) times.erase(times.begin());
  }
  return read_by_helper(mesh::open_input(file), true, options);
}

Scene read_glb(std::span<const std::byte> bytes, const std::string& name, const ReadOptions& options,
               const std::filesystem::path& folder) {
  if (bytes.empty()) throw InputError("{}: it is empty", name);
  // Without a folder, files that the bytes name are looked for in a place that holds no files.
  const std::filesystem::path home = folder.empty() ? "/dev/null" : folder;
  const int flags = O_RDONLY | O_CLOEXEC | (folder.empty() ? 0 : O_DIRECTORY);
  mesh::InputFile input{folder / (name + ".glb"), file_of(bytes, name), Descriptor(::open(home.c_str(), flags))};
  if (!input.folder.is_open()) throw_file_error(errno, home.string());
  return read_by_helper(input, !folder.empty(), options);
}

}  // namespace penumbra::scenes
