#include "bench/options.hpp"

#include "app/parse.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace penumbra::bench {

const char* const kHelp =
    R"(penumbra-bench: view-sample mapping, the speed peer (fastest plain Embree) and ray tracing, side by side

  --scene NAME|FILE    a shipped scene by name, or a scene file; may be given again
                       (default: all shipped scenes but terrain-1m, and bunny with light half sizes 0.3 and 2)
  --all                terrain-1m too
  --light-half H       half size of each scene's first rectangle light instead of the scene's; needs --scene;
                       may be given again
  --runs N             timed runs after one that is discarded (default 5)
  --size N             pixels on a side (default 512)
  --light-samples N    1 to 4096 (default 256)
  --device NAME|INDEX|cpu
  --json FILE          append one JSON line a scene and method
  --commit TEXT        instead of the commit that this was configured at
  --help

The table goes to stdout, what is going on to stderr. bench/README.md says how to read it.
)";

namespace {

/// The values that follow options, in order.
class Arguments {
 public:
  explicit Arguments(const std::vector<std::string>& all) : all_(all) {}
  [[nodiscard]] bool done() const { return next_ == all_.size(); }
  const std::string& take() { return all_[next_++]; }
  const std::string& value_of(const std::string& option) {
    if (done()) throw UsageError("{}: expected a value after it; --help lists the options", option);
    return take();
  }
  std::uint32_t number_of(const std::string& option, std::uint32_t most) {
    const std::string& text = value_of(option);
    const auto number = app::parse_integer<std::uint32_t>(text);
    if (!number || *number == 0 || *number > most)
      throw UsageError("{} {}: expected a whole number from 1 to {}", option, text, most);
    return *number;
  }

 private:
  const std::vector<std::string>& all_;
  std::size_t next_ = 0;
};

/// H as the user wrote it, because it becomes part of a stable name.
double parse_half(const std::string& text) {
  char* end = nullptr;
  const double half = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(half > 0 && half < 1e9))
    throw UsageError("--light-half {}: expected a length above 0, such as 0.3", text);
  return half;
}

std::filesystem::path find_scene(const std::string& name) {
  if (std::filesystem::is_regular_file(name)) return name;
  const std::filesystem::path shipped = std::filesystem::path(PENUMBRA_SCENES) / (name + ".json");
  if (std::filesystem::is_regular_file(shipped)) return shipped;
  throw UsageError("--scene {}: neither a file nor a scene of {}", name, PENUMBRA_SCENES);
}

constexpr const char* kLarge = "terrain-1m";

std::vector<std::string> shipped_scenes(bool all) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(PENUMBRA_SCENES)) {
    const std::filesystem::path& path = entry.path();
    const std::string stem = path.stem().string();
    if (path.extension() != ".json" || stem.ends_with(".schema") || (stem == kLarge && !all)) continue;
    names.push_back(stem);
  }
  std::ranges::sort(names);
  return names;
}

void add_subject(std::vector<Subject>& subjects, const std::string& scene, const std::string& half) {
  const std::filesystem::path path = find_scene(scene);
  Subject subject{.name = path.stem().string(), .scene = path, .light_half = std::nullopt};
  if (!half.empty()) {
    subject.light_half = parse_half(half);
    subject.name += "/half=" + half;
  }
  subjects.push_back(std::move(subject));
}

}  // namespace

Options parse_options(const std::vector<std::string>& arguments) {
  Options options;
  options.commit = PENUMBRA_COMMIT;
  std::vector<std::string> scenes, halves;
  bool all = false;
  Arguments left(arguments);
  while (!left.done()) {
    const std::string option = left.take();
    if (option == "--help" || option == "-h") {
      options.help = true;
      return options;
    }
    if (option == "--scene") {
      scenes.push_back(left.value_of(option));
    } else if (option == "--light-half") {
      halves.push_back(left.value_of(option));
    } else if (option == "--all") {
      all = true;
    } else if (option == "--runs") {
      options.runs = left.number_of(option, 1000);
    } else if (option == "--size") {
      options.size = left.number_of(option, 16384);
    } else if (option == "--light-samples") {
      options.light_samples = left.number_of(option, 4096);
    } else if (option == "--device") {
      options.device = left.value_of(option);
    } else if (option == "--json") {
      options.json = left.value_of(option);
    } else if (option == "--commit") {
      options.commit = left.value_of(option);
    } else {
      throw UsageError("{}: no such option; --help lists what there is", option);
    }
  }
  if (!halves.empty() && scenes.empty()) throw UsageError("--light-half needs --scene");
  if (halves.empty()) halves.emplace_back();
  const bool by_default = scenes.empty();
  if (by_default) scenes = shipped_scenes(all);
  for (const std::string& scene : scenes) {
    for (const std::string& half : halves) add_subject(options.subjects, scene, half);
    if (by_default && scene == "bunny") {
      for (const char* half : {"0.3", "2"}) add_subject(options.subjects, scene, half);
    }
  }
  return options;
}

}  // namespace penumbra::bench
