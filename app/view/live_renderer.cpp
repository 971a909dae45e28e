// SPDX-License-Identifier: Apache-2.0
// Interface of the live renderer; its thread is in live_thread.cpp.

#include "app/view/live_renderer.hpp"

#include "app/view/light_outline.hpp"
#include "app/view/live_steps.hpp"
#include "base/error.hpp"
#include "base/scratch_folder.hpp"
#include "scenes/formats/writer.hpp"
#include "scenes/light_texture.hpp"
#include "session/machine.hpp"
#include "session/process/interrupt.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <tuple>
#include <utility>

namespace penumbra::app {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// Returns what `write` writes to a file of this name.
template <typename Write>
std::string written(const std::string& name, Write write) {
  const session::UnwindsAfterSignals unwinds;
  const ScratchFolder folder(std::filesystem::temp_directory_path());
  const std::filesystem::path file = folder.path() / name;
  write(file);
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Returns the name without characters that browsers replace in names of files that they save.
std::string plain_name(std::string name) {
  for (char& c : name) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-';
    if (!is_plain) c = '_';
  }
  return name;
}

}  // namespace

LiveRenderer::LiveRenderer(session::RunOptions options, WholeScene whole, LiveEvents events)
    : options_(std::move(options)),
      events_(std::move(events)),
      machine_(session::make_machine(options_.device)),
      state_(live_state(session::without_meshes(whole.scene), options_.camera)),
      run_(options_),
      steps_(std::make_unique<Steps>(*this)) {
  file_ = std::make_shared<const scenes::Scene>(session::without_meshes(whole.scene));
  whole_ = std::make_shared<const WholeScene>(std::move(whole));
  if (!options_.size.empty()) std::tie(state_.width, state_.height) = session::parse_size(options_.size);
  thread_ = std::thread([this] { work(); });
}

LiveRenderer::~LiveRenderer() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    ++revision_;  // cancels the current picture
  }
  wake_.notify_all();
  thread_.join();
}

LiveChange LiveRenderer::apply(const json& message, std::uint64_t client) {
  const std::lock_guard lock(mutex_);
  const LiveChange change = app::apply(state_, message);
  if (change == LiveChange::picture) {
    ++revision_;
    if (const auto stamp = message.find("stamp"); stamp != message.end() && stamp->is_number())
      stamps_[client] = stamp->get<double>();
  } else {
    wants_show_ = wants_show_ || message["type"] == "display";
  }
  wake_.notify_all();
  return change;
}

void LiveRenderer::update(LiveUpdate update, std::uint64_t client) {
  const std::lock_guard lock(mutex_);
  LiveState state = state_;
  if (update.scene) {
    state.scene = session::without_meshes(update.scene->scene);
    const auto& lights = state.scene.lights;
    if (std::ranges::find(lights, state.display.light, &scenes::AreaLight::name) == lights.end())
      state.display.light = lights.front().name;
  }
  for (const json& change : update.changes) static_cast<void>(app::apply(state, change));
  state.moving = update.moving;
  state_ = std::move(state);
  if (update.scene && !update.scene->same_meshes) {
    whole_ = std::make_shared<const WholeScene>(WholeScene{std::move(update.scene->scene)});
    ++meshes_;
  }
  if (update.stamp) stamps_[client] = *update.stamp;
  ++revision_;
  wake_.notify_all();
}

ordered_json LiveRenderer::state() const {
  const std::lock_guard lock(mutex_);
  ordered_json state = to_json(state_);
  state["meshes"] = meshes_;
  auto pictures = ordered_json::object();
  const std::vector<std::filesystem::path> files = scenes::texture_files(state_.scene, saved_name());
  for (const scenes::AreaLight& light : state_.scene.lights) {
    if (light.texture) pictures[light.name] = files[pictures.size()].string();
  }
  state["saved"] = {{"scene", saved_name()}, {"pictures", std::move(pictures)}};
  return state;
}

void LiveRenderer::show_again() {
  const std::lock_guard lock(mutex_);
  wants_show_ = true;
  wake_.notify_all();
}

void LiveRenderer::shown() {
  const std::lock_guard lock(mutex_);
  is_awaited_ = false;
  wake_.notify_all();
}

void LiveRenderer::reload() {
  const std::lock_guard lock(mutex_);
  wants_reload_ = true;
  wake_.notify_all();
}

std::vector<std::filesystem::path> LiveRenderer::sources() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::filesystem::path> files = file_->sources;
  files.push_back(options_.scene);  // for a JSON scene, the list only contains files named in it
  return files;
}

LiveScenery LiveRenderer::scenery() const {
  const std::lock_guard lock(mutex_);
  return {whole_, state_.scene, picture_};
}

ordered_json LiveRenderer::pixel(std::uint32_t x, std::uint32_t y) const {
  std::shared_ptr<const LivePicture> picture;
  std::shared_ptr<const LiveMasks> masks;
  std::shared_ptr<const WholeScene> whole;
  std::optional<scenes::AreaLight> light;  // light whose outline at the pixel is requested
  {
    const std::lock_guard lock(mutex_);
    picture = picture_;
    masks = masks_;
    whole = whole_;
    const auto& lights = state_.scene.lights;
    const auto shown = std::ranges::find(lights, state_.display.light, &scenes::AreaLight::name);
    if (state_.masks && shown != lights.end()) light = *shown;
  }
  if (!picture || picture->triangles != scenes::triangle_count(whole->scene, whole->instances))
    return {{"type", "pixel"}, {"x", x}, {"y", y}};
  ordered_json made = pixel_json(*picture, {x, y}, *whole, masks.get());
  if (light && made["surface"] && whole->instances.empty()) {  // the outline needs all triangles
    const ordered_json& p = made["position"];
    const auto triangle = made["id"].get<std::size_t>();
    if (const auto outline = light_outline(whole->scene, *light, {{p[0], p[1], p[2]}, triangle}))
      made["outline"] = outline_json(*outline, light->name);
  }
  return made;
}

std::string LiveRenderer::saved_name() const {
  return plain_name(options_.scene.stem().string()) + "-view.json";
}

std::string LiveRenderer::scene_text() const {
  scenes::Scene scene;
  std::shared_ptr<const WholeScene> whole;
  {
    const std::lock_guard lock(mutex_);
    whole = whole_;
    scene = with_meshes(state_.scene, whole->scene);
    const std::vector<std::string> on = lights_on(state_);
    for (scenes::AreaLight& light : scene.lights) {
      if (std::ranges::find(on, light.name) == on.end()) light.radiance = glm::dvec3(0);
    }
    std::erase_if(scene.cameras, [&](const scenes::Camera& camera) { return camera.name == state_.camera.name; });
    scene.cameras.insert(scene.cameras.begin(), state_.camera);
    if (state_.width != 0) {
      scene.width = state_.width;
      scene.height = state_.height;
      scene.cameras.front().aspect.reset();
    }
  }
  return written(saved_name(),
                 [&](const std::filesystem::path& file) { scenes::write_scene(scene, file, {}, whole->instances); });
}

std::string LiveRenderer::light_picture(const std::string& light) const {
  std::optional<scenes::Texture> texture;
  {
    const std::lock_guard lock(mutex_);
    const auto& lights = state_.scene.lights;
    const auto found = std::ranges::find(lights, light, &scenes::AreaLight::name);
    if (found != lights.end()) texture = found->texture;
  }
  if (!texture) throw UsageError("light={}: the scene has no light of this name with a picture", light);
  return written("light.exr", [&](const std::filesystem::path& file) { scenes::write_texture(*texture, file); });
}

void LiveRenderer::watch(std::chrono::milliseconds time) const {
  std::unique_lock lock(mutex_);
  ended_.wait_for(lock, time, [&] { return thrown_ != nullptr; });
  if (thrown_) std::rethrow_exception(thrown_);
}

}  // namespace penumbra::app
