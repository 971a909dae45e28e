// SPDX-License-Identifier: Apache-2.0
// penumbra-import: reads one foreign file in a separate process. Not for users: penumbra starts it, passes the file and
// the limits, and reads the answer from its standard output (see mesh/import_helper.hpp).

#include "base/error.hpp"
#include "base/memory.hpp"
#include "mesh/helper_process.hpp"
#include "mesh/import_helper.hpp"
#include "import/read.hpp"
#include "mesh/import_wire.hpp"
#include "mesh/opened_files.hpp"
#include "import/foreign_scene.hpp"
#include "import/gltf/gltf_import.hpp"
#include "scenes/instances.hpp"
#include "scenes/scene_wire.hpp"
#include "import/texture_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <list>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#if defined(PENUMBRA_SHADOW_MEMORY)
// Sanitizers reserve terabytes of addresses, so the limit must be on resident memory instead. Leaks are not reported:
// they are Assimp's (on eleven of its own test files), and end with this process.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "detect_leaks=0:hard_rss_limit_mb=4096";
}
#endif

namespace {

using namespace penumbra;

struct Arguments {
  std::string_view kind;
  std::uint64_t milliseconds = 0, bytes = 0, asker = 0;
  const char* file = nullptr;
  scenes::ReadOptions options;
  std::optional<double> uv;
  bool instances = false;
  std::vector<double> further;  ///< further times at which the scene is wanted
};

/// Scenes at further times are added while the answer has fewer than kAheadBytes bytes, and until 1 / kAheadPart of the
/// time that reading may take is spent.
constexpr std::uint64_t kAheadBytes = std::uint64_t{256} << 20U, kAheadPart = 4;

bool parse(std::string_view text, std::uint64_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// Parses a `flag` of the form --name=NUMBER.
bool parse_number(std::string_view flag, std::string_view name, std::optional<double>& value) {
  if (!flag.starts_with(name)) return false;
  flag.remove_prefix(name.size());
  double number = 0;
  const auto [end, error] = std::from_chars(flag.data(), flag.data() + flag.size(), number);
  value = number;
  return error == std::errc() && end == flag.data() + flag.size();
}

bool parse(int argc, char** argv, Arguments& arguments) {
  if (argc < 6) return false;
  arguments.kind = argv[1];
  arguments.file = argv[5];
  for (int i = 6; i < argc; ++i) {
    const std::string_view flag = argv[i];
    if (parse_number(flag, "--lamp-radius=", arguments.options.lamp_radius) ||
        parse_number(flag, "--sun-angle=", arguments.options.sun_angle) ||
        parse_number(flag, "--lumens-per-watt=", arguments.options.lumens_per_watt) ||
        parse_number(flag, "--time=", arguments.options.time) || parse_number(flag, "--uv=", arguments.uv)) {
      continue;
    }
    if (constexpr std::string_view kClip = "--clip="; flag.starts_with(kClip)) {
      arguments.options.clips.emplace_back(flag.substr(kClip.size()));
      continue;
    }
    if (std::optional<double> then; parse_number(flag, "--then=", then)) {
      arguments.further.push_back(*then);
      continue;
    }
    if (flag == "--instances") {
      arguments.instances = true;
      continue;
    }
    if (flag != "--allow-outside" && flag != "--without-light" && flag != "--without-surface" && flag != "--lenient")
      return false;
    arguments.options.allow_outside |= flag == "--allow-outside";
    arguments.options.lenient |= flag == "--lenient";
    arguments.options.needs_light &= flag != "--without-light";
    arguments.options.needs_surface &= flag != "--without-surface";
  }
  constexpr std::array<std::string_view, 4> kKinds = {"mesh", "scene", "texture", "sky"};
  return std::ranges::find(kKinds, arguments.kind) != kKinds.end() && parse(argv[2], arguments.milliseconds) &&
         parse(argv[3], arguments.bytes) && parse(argv[4], arguments.asker);
}

struct Answer {
  mesh::WireWriter head, payload, further;  // `further`: scenes after the first
  // Owners of data that the payload refers to without copying.
  mesh::ImportedMesh mesh;
  std::list<std::pair<scenes::Scene, scenes::Instances>> scenes;
  scenes::Texture texture;
  scenes::LightmapPlaces lightmap;
};

Answer message(mesh::HelperStatus status) {
  return {mesh::answer_head(status), {}, {}, {}, {}, {}, {}};
}

mesh::ImportedMesh read_mesh(const mesh::InputFile& input, const Arguments& arguments) {
  if (import::is_gltf(input.name)) return import::import_gltf_mesh(input, arguments.options);
  return import::read_mesh(input, arguments.uv.has_value());
}

/// Answers with the scene, then the number of scenes at further times, then those scenes.
void put_scenes(Answer& answer, const mesh::InputFile& input, const Arguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  scenes::ReadOptions options = arguments.options;
  scenes::Instances instances;
  answer.lightmap.set = static_cast<std::uint32_t>(std::clamp(arguments.uv.value_or(0), 0.0, 1e6));
  if (arguments.uv) options.lightmap = &answer.lightmap;
  if (arguments.instances) options.instances = &instances;
  const auto put = [&](mesh::WireWriter& to, scenes::Scene scene, scenes::Instances its_instances) {
    const auto& [kept, kept_instances] = answer.scenes.emplace_back(std::move(scene), std::move(its_instances));
    scenes::put_scene(to, kept);
    const bool is_first = answer.scenes.size() == 1;
    if (arguments.uv && is_first) to.put_array(std::span<const glm::dvec2>(answer.lightmap.places));
    if (arguments.instances) scenes::put_instances(to, kept_instances);
  };
  if (import::is_foreign_scene(input.name)) {
    put(answer.payload, import::import_foreign_scene(input, options), {});
  } else {
    import::import_gltf_scenes(input, options, arguments.further,
                               [&](scenes::Scene scene, scenes::Instances its_instances) {
                                 put(answer.scenes.empty() ? answer.payload : answer.further, std::move(scene),
                                     std::move(its_instances));
    const auto spent = std::chrono::steady_clock::now() - start;
    return answer.payload.size() + answer.further.size() < kAheadBytes &&
           spent * kAheadPart < std::chrono::milliseconds(arguments.milliseconds);
  });
}
answer.payload.put<std::uint64_t>(answer.scenes.size() - 1);
}  // namespace

Answer answer_for(const Arguments& arguments) {
  const mesh::InputFile input{arguments.file, Descriptor(mesh::kInputDescriptor), Descriptor(mesh::kFolderDescriptor)};
  mesh::note_opened_file(std::filesystem::absolute(input.name));
  try {
    Answer answer = message(mesh::HelperStatus::done);
    if (arguments.kind == "mesh") {
      answer.mesh = read_mesh(input, arguments);
      mesh::put_mesh(answer.payload, answer.mesh);
      if (arguments.uv) answer.payload.put_array(std::span<const glm::dvec2>(answer.mesh.places));
    } else if (arguments.kind == "scene") {
      put_scenes(answer, input, arguments);
    } else {
      answer.texture = arguments.kind == "sky" ? import::read_sky_file(input) : import::read_texture_file(input);
      scenes::put_texture(answer.payload, answer.texture);
    }
    answer.head.put_strings(mesh::opened_files());
    return answer;
  } catch (const std::bad_alloc&) {
    return message(mesh::HelperStatus::out_of_memory);
  } catch (const std::length_error&) {  // a size larger than any memory
    return message(mesh::HelperStatus::out_of_memory);
  } catch (const std::exception& error) {
    // An exception that a library caught itself is known only by its text.
    if (std::string_view(error.what()).find("std::bad_alloc") != std::string_view::npos) {
      return message(mesh::HelperStatus::out_of_memory);
    }
    const bool ours = dynamic_cast<const Error*>(&error) != nullptr;
    Answer answer = message(mesh::HelperStatus::bad_input);
    answer.payload.put_string(ours ? error.what() : fmt::format("{}: {}", arguments.file, error.what()));
    return answer;
  }
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  if (!parse(argc, argv, arguments)) {
    fmt::print(stderr, "penumbra-import reads meshes and scenes for penumbra; it is not meant to be called by hand.\n");
    return static_cast<int>(ExitCode::usage);
  }
  const int output = mesh::begin_helper({arguments.asker, arguments.milliseconds, arguments.bytes});
  keep_freed_memory();
  const Answer answer = answer_for(arguments);
  // Uses _exit: cleanup by libraries after a hostile file could crash.
  const bool told = mesh::write_all(output, answer.head) && mesh::write_all(output, answer.payload) &&
                    mesh::write_all(output, answer.further);
  _exit(told ? 0 : static_cast<int>(ExitCode::resource));
}
