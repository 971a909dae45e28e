// SPDX-License-Identifier: Apache-2.0
// Writes OUT.exr: channels, header attributes, matrices.

#include "session/pictures/picture_file.hpp"

#include "base/assert.hpp"
#include "base/exr.hpp"
#include "session/pictures/cryptomatte.hpp"
#include "session/pictures/surfaces.hpp"

#include <glm/mat4x4.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>

namespace penumbra::session {
namespace {

constexpr float kFar = 1e10f;  // Z of the background, as in Blender

std::string options_text(const visibility::MethodOptions& options) {
  std::string text;
  for (const auto& [key, value] : options) text += fmt::format("{}{}={}", text.empty() ? "" : " ", key, value);
  return text;
}

const char* beauty_text(visibility::Output output) {
  switch (output) {
    case visibility::Output::mask:
      return "radiance and cosines integrated sample by sample, each with its cell of the light";
    case visibility::Output::scalar:
      return "V times the unshadowed integral";
    case visibility::Output::radiance:
      return "radiance and cosines integrated over the visible part of the light";
  }
  return "?";
}

std::string text_of(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// Returns `lights` of stats.json without the seconds (so that the same command gives the same bytes), each with its
/// layer and its emission.
std::string lights_text(const Session& session, const LabelledLights& all, std::span<const std::string> layers) {
  auto rows = nlohmann::ordered_json::array();
  for (const WholeLight& whole : whole_lights(all.lights)) {
    const visibility::Light& light = all.lights[whole.first];
    const std::string& layer = layers[rows.size()];
    rows.push_back(compare::to_json(light_stats(all, whole)));
    auto& row = rows.back();
    row.erase("seconds");
    row["layer"] = layer;
    row["kind"] = whole.count == 1 ? visibility::name_of(light.kind) : "pieces";
    if (whole.count > 1) row["pieces"] = whole.count;
    const glm::dvec3& radiance = session.scene.lights[static_cast<std::size_t>(light.index)].radiance;
    row["radiance"] = {radiance.r, radiance.g, radiance.b};
  }
  return text_of(rows);
}

/// Requested channels of a picture, each in the format's type.
class Channels {
 public:
  Channels(ExrImage& image, std::set<std::string> wanted, bool half)
      : image_(image), wanted_(std::move(wanted)), half_(half) {}

  [[nodiscard]] bool wants(const std::string& layer) const {
    return std::ranges::any_of(wanted_, [&](const std::string& name) { return name.starts_with(layer); });
  }
  void add(ExrChannel channel) {
    if (!wanted_.contains(channel.name)) return;
    channel.half = half_ && stands_half(channel.name);
    channel.exact = must_be_exact(channel.name);
    image_.channels.push_back(std::move(channel));
  }
  /// Adds the components of interleaved vectors or colours, without a copy.
  void add(const std::string& prefix, const char* letters, std::span<const glm::vec3> values) {
    if (values.empty()) return;
    const auto* floats = &values.front().x;
    for (std::size_t c = 0; c < 3; ++c)
      add({prefix + letters[c], std::span<const float>(floats + c, 3 * values.size() - 2), 3});
  }
  /// Adds a channel whose values are computed pixel by pixel when its lines are written.
  template <typename ValueOf>
  void add_made(const std::string& name, ValueOf value_of) {
    add({name, [value_of](std::size_t first, std::span<float> values) {
           for (std::size_t i = 0; i < values.size(); ++i) values[i] = value_of(first + i);
         }});
  }
  /// Asserts that all requested channels have been added.
  void check() const {
    PENUMBRA_ASSERT(image_.channels.size() == wanted_.size(), "{} channels of {}", image_.channels.size(),
                    wanted_.size());
  }

 private:
  ExrImage& image_;
  std::set<std::string> wanted_;
  bool half_;
};

/// Returns the number by which the picture identifies a name: 1 or more; 0 for background.
float picture_number(std::uint32_t index) {
  return index == Surfaces::kNothing ? 0.0f : static_cast<float>(index) + 1;
}

/// Matrices from world space to the camera's (X right, Y up, looking along −Z), and to [−1, 1] over the picture.
struct CameraMatrices {
  glm::mat4 to_camera, to_picture;
};

CameraMatrices matrices_of(const Session& session) {
  const visibility::PinholeCamera& camera = session.camera;
  const glm::dvec3 eye = camera.eye + session.floats.origin;
  const std::array axes = {camera.right, camera.up, -camera.forward};
  glm::dmat4 to_camera(1);
  for (glm::length_t row = 0; row < 3; ++row) {
    const glm::dvec3& axis = axes[static_cast<std::size_t>(row)];
    for (glm::length_t column = 0; column < 3; ++column) to_camera[column][row] = axis[column];
    to_camera[3][row] = -glm::dot(axis, eye);
  }
  // OpenGL's projection, with the far plane at infinity and the near plane, which the camera lacks, at 1.
  const double aspect = static_cast<double>(session.width) / session.height;
  glm::dmat4 projection(0);
  const double half = camera.half_height.value_or(camera.tan_half_fov);
  projection[0][0] = 1 / (aspect * half);
  projection[1][1] = 1 / half;
  projection[2][2] = -1;
  if (camera.half_height) {  // no far plane: depth stays a length
    projection[3][3] = 1;
  } else {
    projection[2][3] = -1;
    projection[3][2] = -2;
    projection[2][0] = glm::dot(camera.middle, camera.right) / (aspect * half);  // for a shifted lens
    projection[2][1] = glm::dot(camera.middle, camera.up) / half;
  }
  return {glm::mat4(to_camera), glm::mat4(projection * to_camera)};
}

}  // namespace

void check_layers(const PictureFormat& format, const Session& session, bool several) {
  wanted_channels(format, picture_channels(layer_names(session.lights), several, session.triangle_count()));
}

std::vector<std::string> write_picture(const std::filesystem::path& path, const PictureContent& content,
                                       const PictureFormat& format) {
  AtomicFile file(path);
  std::vector<std::string> warnings = write_picture(file, content, format);
  file.commit();
  return warnings;
}

std::vector<std::string> write_picture(AtomicFile& file, const PictureContent& content, const PictureFormat& format) {
  const Session& session = content.session;
  const LabelledLights& all = content.lights;
  const MethodLabel& label = all.label(0);
  const visibility::ViewSamples& samples = session.samples;
  const auto is_background = [&samples](std::size_t i) {
    return samples.triangle[i] == visibility::ViewSamples::kBackground;
  };

  ExrImage image;
  image.width = session.width;
  image.height = session.height;
  image.compression = format.compression;
  const std::vector<std::string> layers = layer_names(all.lights);
  const std::uint64_t triangles = session.triangle_count();
  Channels channels(image, wanted_channels(format, picture_channels(layers, content.mattes != nullptr, triangles)),
                    format.half);
  channels.add("", "RGB", content.sum);
  channels.add_made("A", [&content, is_background](std::size_t i) {
    return !content.alpha.empty() ? content.alpha[i] : is_background(i) ? 0.0f : 1.0f;
  });
  channels.add({"V", std::span<const float>(content.visibility.front()), 1});
  for (std::size_t light = 0; light < layers.size(); ++light) {
    for (const char* const end : {".V", "_V.V"})
      channels.add({layers[light] + end, std::span<const float>(content.visibility[light]), 1});
    for (const char* const end : {".", "_light."}) channels.add(layers[light] + end, "RGB", content.beauty[light]);
  }
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    channels.add_made(std::string("P.") + "XYZ"[axis], [&, is_background, axis](std::size_t i) {
      return is_background(i) ? 0.0f : static_cast<float>(double{samples.p[i][axis]} + session.floats.origin[axis]);
    });
  }
  channels.add("Prel.", "XYZ", samples.p);
  channels.add("N.", "XYZ", samples.n);
  channels.add_made("Z", [&, is_background](std::size_t i) { return is_background(i) ? kFar : samples.depth[i]; });
  // The background's number, −1, is stored as 4294967295.
  std::vector<std::int32_t> numbers;
  if (!session.numbers.empty())
    for (const std::int32_t triangle : samples.triangle) numbers.push_back(session.number_of(triangle));
  const std::span<const std::int32_t> carriers = numbers.empty() ? samples.triangle : numbers;
  const auto* const id = reinterpret_cast<const std::uint32_t*>(carriers.data());
  channels.add({"id", std::span(id, samples.size()), 1});
  channels.add_made("triangle.X", [carriers](std::size_t i) { return low_number(carriers[i]); });
  channels.add_made("triangle_high.X", [carriers](std::size_t i) { return high_number(carriers[i]); });
  const Surfaces surfaces(session);
  const auto object = [&surfaces](std::size_t i) { return surfaces.object(i); };
  const auto material = [&surfaces](std::size_t i) { return surfaces.material(i); };
  channels.add_made("object.X", [object](std::size_t i) { return picture_number(object(i)); });
  channels.add_made("material.X", [material](std::size_t i) { return picture_number(material(i)); });

  const CameraMatrices matrices = matrices_of(session);
  image.attributes = {{"penumbra.method", label.description.name},
                      {"penumbra.options", options_text(label.options)},
                      {"penumbra.output", visibility::name_of(label.description.output)},
                      {"penumbra.beauty", beauty_text(label.description.output)},
                      {"penumbra.lightSamples", fmt::format("{}", samples_of(all, whole_lights(all.lights).front()))},
                      {"penumbra.samplePattern", pattern_of(all, whole_lights(all.lights).front()).value_or("null")},
                      {"penumbra.lights", lights_text(session, all, layers)},
                      {"penumbra.objects", text_of(surfaces.objects())},
                      {"penumbra.materials", text_of(surfaces.materials())},
                      {"penumbra.camera", session.scene.cameras[session.camera_index].name},
                      {"penumbra.axes", "world: right-handed, Y up; camera: X right, Y up, looking along -Z"},
                      {"penumbra.scene", session.scene.name},
                      {"penumbra.version", PENUMBRA_VERSION},
                      {"penumbra.device", label.device}};
  image.attributes.insert(content.more_attributes.begin(), content.more_attributes.end());
  image.vectors = {{"penumbra.origin", session.floats.origin}};
  image.matrices = {{"worldToCamera", matrices.to_camera}, {"worldToNDC", matrices.to_picture}};
  std::vector<std::string> warnings;
  if (triangles >= kFloatNumbers) {
    image.attributes["penumbra.triangle"] = "id + 1 = triangle.X + 16777216 * triangle_high.X; 0: no triangle";
    warnings.push_back(
        fmt::format("{} triangles: more than a float can count, so triangle.X has the number modulo 16777216, and "
                    "triangle_high.X the quotient (id has the whole number)",
                    triangles));
  }
  const Mattes* const mattes = content.mattes;
  std::optional<Cryptomatte> objects, materials;
  const auto add_matte = [&](std::optional<Cryptomatte>& matte, const char* layer, auto make) {
    if (!channels.wants(layer)) return;
    ExrImage all_ranks;
    matte.emplace(make());
    matte->add_to(all_ranks);
    for (ExrChannel& channel : all_ranks.channels) channels.add(std::move(channel));
    image.attributes.merge(all_ranks.attributes);
  };
  add_matte(objects, "CryptoObject", [&] {
    return mattes != nullptr ? Cryptomatte("CryptoObject", mattes->objects)
                             : Cryptomatte("CryptoObject", surfaces.objects(), object);
  });
  add_matte(materials, "CryptoMaterial", [&] {
    return mattes != nullptr ? Cryptomatte("CryptoMaterial", mattes->materials)
                             : Cryptomatte("CryptoMaterial", surfaces.materials(), material);
  });
  channels.check();
  if (const std::uint64_t count = write_exr(file, image); count != 0) {
    warnings.push_back(
        fmt::format("{} of {} values were above 65504, the largest 16-bit float, and are limited to it in {}", count,
                    std::uint64_t{image.width} * image.height * image.channels.size(), file.path().string()));
  }
  return warnings;
}

}  // namespace penumbra::session
