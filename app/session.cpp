#include "app/session.hpp"

#include "app/process/interrupt.hpp"
#include "app/process/stopwatch.hpp"
#include "base/assert.hpp"
#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "base/memory.hpp"
#include "render/visibility_buffer.hpp"
#include "scenes/formats/reader.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace penumbra::app {
namespace {

/// The element whose name is wanted; the first one if none is. `what` and `scene` are for the message.
template <typename Named>
std::size_t find_named(const std::vector<Named>& elements, const std::string& wanted, std::string_view option,
                       const std::string& scene) {
  if (wanted.empty()) return 0;
  const auto found = std::ranges::find(elements, wanted, &Named::name);
  if (found != elements.end()) return static_cast<std::size_t>(found - elements.begin());
  std::vector<std::string> names;
  for (const Named& element : elements) names.push_back(element.name);
  throw UsageError("{} {}: {} has no such name; it has: {}{}", option, wanted, scene, fmt::join(names, ", "),
                   did_you_mean(wanted, names));
}

/// Refuses an image that this machine has no memory for, before minutes of work end in a killed process.
void require_image_memory(std::uint64_t width, std::uint64_t height, std::uint64_t lights) {
  // A pixel: view sample 48, scene colours and normals in the EXR 76, beauty 12 bytes; a light: V, class and its
  // channel 9.
  require_memory(width * height * (136 + 9 * lights), fmt::format("an image of {}x{} pixels", width, height),
                 "choose a smaller --size");
}

/// Lights with the same casters share a scene.
void link_casters(Session& session) {
  std::vector<const std::vector<std::uint8_t>*> known;
  for (const visibility::Light& light : session.lights) {
    std::optional<std::size_t>& own = session.linked_of.emplace_back();
    if (light.unshaded_by.empty()) continue;
    const auto same = std::ranges::find_if(known, [&](const auto* other) { return *other == light.unshaded_by; });
    own = static_cast<std::size_t>(same - known.begin());
    if (same != known.end()) continue;
    known.push_back(&light.unshaded_by);
    session.linked.push_back(cast_for(session.floats, light));
  }
}

}  // namespace

double median(std::vector<double> values) {
  PENUMBRA_ASSERT(!values.empty(), "median of nothing");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

Session open_session(const RunOptions& options, DeviceSource& devices, std::uint32_t runs, Progress& progress) {
  const Stopwatch open;
  Session session;
  progress.begin("reading " + options.scene.filename().string(), 1);
  // What is wrong with the command line is said before anything long begins.
  const visibility::SampleRequest request = parse_light_samples(options);
  const scenes::ReadOptions reading = read_options(options.lamps, options.allow_outside);
  const auto size = options.size.empty() ? std::pair<std::uint32_t, std::uint32_t>{} : parse_size(options.size);

  Stopwatch load;
  {
    const MayExitAtOnce at_once;
    session.scene = scenes::read_scene(options.scene, reading);
  }
  session.warnings = session.scene.warnings;
  session.width = options.size.empty() ? session.scene.width : size.first;
  session.height = options.size.empty() ? session.scene.height : size.second;
  const std::string scene_name = options.scene.string();
  const std::size_t first_light = find_named(session.scene.lights, options.light, "--light", scene_name);
  session.camera_index = find_named(session.scene.cameras, options.camera, "--camera", scene_name);
  require_image_memory(session.width, session.height, session.scene.lights.size());

  session.floats = visibility::make_scene_floats(session.scene);
  session.camera = visibility::make_camera(session.scene.cameras[session.camera_index], session.floats.origin,
                                           session.width, session.height);
  for (std::size_t i = 0; i < session.scene.lights.size(); ++i) {
    // The chosen light moves to the front; the others keep their order.
    const std::size_t index = i == 0 ? first_light : i <= first_light ? i - 1 : i;
    session.lights.push_back(visibility::make_light(session.scene, static_cast<std::uint32_t>(index),
                                                    session.floats.origin, request,
                                                    i == 0 ? &session.warnings : nullptr));
  }
  link_casters(session);
  double load_seconds = load.seconds();

  const render::Device& device = devices.device();  // its start-up is nobody's time
  load.restart();
  render::VisibilityBuffer buffer(device, session.floats);
  session.load_seconds = load_seconds + load.seconds();

  progress.begin("view samples", runs + 1);
  std::vector<double> view_seconds;
  for (std::uint32_t run = 0; run <= runs; ++run) {
    const MayExitAtOnce at_once;
    const Stopwatch view;
    session.samples = buffer.render(session.camera);
    view_seconds.push_back(view.seconds());
    progress.advance();
  }
  if (view_seconds.size() > 1) view_seconds.erase(view_seconds.begin());
  session.view_seconds = median(std::move(view_seconds));

  progress.begin("receivers", session.lights.size());
  for (const visibility::Light& light : session.lights) {
    const MayExitAtOnce at_once;
    session.classes.push_back(visibility::classify_pixels(session.floats, session.samples, light));
    progress.advance();
  }
  session.open_seconds = open.seconds();
  return session;
}

}  // namespace penumbra::app
