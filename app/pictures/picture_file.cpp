#include "app/pictures/picture_file.hpp"

#include "app/pictures/cryptomatte.hpp"
#include "app/pictures/surfaces.hpp"
#include "base/exr.hpp"

#include <glm/mat4x4.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>

namespace penumbra::app {
namespace {

constexpr float kFar = 1e10f;  // Z of the background, as Blender has it

/// What the picture has beside lights.
constexpr std::array kOwnLayers = {"P",
                                   "Prel",
                                   "N",
                                   "object",
                                   "material",
                                   "CryptoObject00",
                                   "CryptoObject01",
                                   "CryptoObject02",
                                   "CryptoMaterial00",
                                   "CryptoMaterial01",
                                   "CryptoMaterial02"};

/// A light's layers: of all that it has, and each of its two parts for Blender's compositor, which has room for one
/// kind of channels in a layer: of R, G, B and V it takes V for R.
constexpr std::array kEndings = {"", "_V", "_light"};

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

/// `lights` of stats.json without the seconds (the same command gives the same bytes), each with its layer and what it
/// emits.
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

/// The components of interleaved vectors or colours as channels that need no copy.
void add_components(ExrImage& image, const std::string& prefix, std::span<const glm::vec3> values) {
  const auto* floats = &values.front().x;
  for (std::size_t c = 0; c < 3; ++c) {
    image.channels.push_back({prefix + "RGB"[c], std::span<const float>(floats + c, 3 * values.size() - 2), 3});
  }
}

/// A channel whose values are made pixel by pixel when its lines are written.
template <typename ValueOf>
void add_made(ExrImage& image, const std::string& name, ValueOf value_of) {
  image.channels.push_back({name, [value_of](std::size_t first, std::span<float> values) {
                              for (std::size_t i = 0; i < values.size(); ++i) values[i] = value_of(first + i);
                            }});
}

/// The number that the picture has of a name: from 1; 0: nothing.
float picture_number(std::uint32_t index) {
  return index == Surfaces::kNothing ? 0.0f : static_cast<float>(index) + 1;
}

/// World space to the camera's (X right, Y up, looking along −Z), and on to [−1, 1] over the picture.
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
  // OpenGL's projection, with the far plane at infinity and, for want of one, the near plane at 1.
  const double aspect = static_cast<double>(session.width) / session.height;
  glm::dmat4 projection(0);
  const double half = camera.half_height.value_or(camera.tan_half_fov);
  projection[0][0] = 1 / (aspect * half);
  projection[1][1] = 1 / half;
  projection[2][2] = -1;
  if (camera.half_height) {  // no plane is far: depth stays a length
    projection[3][3] = 1;
  } else {
    projection[2][3] = -1;
    projection[3][2] = -2;
    projection[2][0] = glm::dot(camera.middle, camera.right) / (aspect * half);  // of a shifted lens
    projection[2][1] = glm::dot(camera.middle, camera.up) / half;
  }
  return {glm::mat4(to_camera), glm::mat4(projection * to_camera)};
}

}  // namespace

std::vector<std::string> layer_names(std::span<const visibility::Light> lights) {
  std::set<std::string> taken(kOwnLayers.begin(), kOwnLayers.end());
  std::vector<std::string> names;
  for (std::string plain : whole_names(lights)) {
    std::ranges::replace_if(
        plain, [](char c) { return c == '.' || c == '/'; }, '_');
    std::string name = plain;
    const auto is_taken = [&] {
      return std::ranges::any_of(kEndings, [&](const char* end) { return taken.contains(name + end); });
    };
    for (int number = 2; is_taken(); ++number) name = fmt::format("{}_{}", plain, number);
    for (const char* const end : kEndings) taken.insert(name + end);
    names.push_back(name);
  }
  return names;
}

void write_picture(const std::filesystem::path& path, const PictureContent& content) {
  AtomicFile file(path);
  write_picture(file, content);
  file.commit();
}

void write_picture(AtomicFile& file, const PictureContent& content) {
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
  add_components(image, "", content.sum);
  add_made(image, "A", [&content, is_background](std::size_t i) {
    return !content.alpha.empty() ? content.alpha[i] : is_background(i) ? 0.0f : 1.0f;
  });
  image.channels.push_back({"V", std::span<const float>(content.visibility.front()), 1});
  const std::vector<std::string> layers = layer_names(all.lights);
  for (std::size_t light = 0; light < layers.size(); ++light) {
    for (const char* const end : {".V", "_V.V"})
      image.channels.push_back({layers[light] + end, std::span<const float>(content.visibility[light]), 1});
    for (const char* const end : {".", "_light."}) add_components(image, layers[light] + end, content.beauty[light]);
  }
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    add_made(image, std::string("P.") + "XYZ"[axis], [&, is_background, axis](std::size_t i) {
      return is_background(i) ? 0.0f : static_cast<float>(double{samples.p[i][axis]} + session.floats.origin[axis]);
    });
  }
  add_vector_channels(image, "Prel", samples.p);
  add_vector_channels(image, "N", samples.n);
  add_made(image, "Z", [&, is_background](std::size_t i) { return is_background(i) ? kFar : samples.depth[i]; });
  // The background's, −1, is 4294967295 there.
  const auto* const id = reinterpret_cast<const std::uint32_t*>(samples.triangle.data());
  image.channels.push_back({"id", std::span(id, samples.size()), 1});
  const Surfaces surfaces(session);
  const auto object = [&surfaces](std::size_t i) { return surfaces.object(i); };
  const auto material = [&surfaces](std::size_t i) { return surfaces.material(i); };
  add_made(image, "object.X", [object](std::size_t i) { return picture_number(object(i)); });
  add_made(image, "material.X", [material](std::size_t i) { return picture_number(material(i)); });

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
  const Mattes* const mattes = content.mattes;
  const Cryptomatte objects = mattes != nullptr ? Cryptomatte("CryptoObject", mattes->objects)
                                                : Cryptomatte("CryptoObject", surfaces.objects(), object);
  const Cryptomatte materials = mattes != nullptr ? Cryptomatte("CryptoMaterial", mattes->materials)
                                                  : Cryptomatte("CryptoMaterial", surfaces.materials(), material);
  objects.add_to(image);
  materials.add_to(image);
  write_exr(file, image);
}

}  // namespace penumbra::app
