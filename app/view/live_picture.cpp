// SPDX-License-Identifier: Apache-2.0
// Converts live pictures to messages and pixels to JSON.

#include "app/view/live_picture.hpp"

#include "app/view/message_text.hpp"
#include "base/error.hpp"
#include "base/jpeg.hpp"
#include "base/png.hpp"
#include "compare/error_picture.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace penumbra::app {
namespace {

using nlohmann::ordered_json;
using visibility::ViewSamples;

constexpr int kQuality = 88;  // of JPEG, during changes

/// Returns the index of the picture's light with this name; the first if there is none.
std::size_t light_number(const LivePicture& picture, const std::string& name) {
  const auto found = std::ranges::find(picture.lights, name);
  return found == picture.lights.end() ? 0 : static_cast<std::size_t>(found - picture.lights.begin());
}

const std::vector<float>& visibility_of(const LivePicture& picture, std::size_t answer, const std::string& light) {
  return picture.answers[answer].frame.visibility[light_number(picture, light)];
}

template <typename Color>
Image8 colored(const ViewSamples& samples, Color color) {
  Image8 image{samples.width, samples.height, std::vector<Color8>(samples.size(), compare::kBackgroundColor)};
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    if (samples.triangle[i] != ViewSamples::kBackground) image.pixels[i] = color(i);
  });
  return image;
}

/// Returns a distinct colour for each number, none of them dark.
Color8 color_of_number(std::uint32_t number) {
  std::uint32_t mixed = number * 2654435761U;  // Knuth's multiplicative hash
  mixed ^= mixed >> 15U;
  mixed *= 2246822519U;
  mixed ^= mixed >> 13U;
  const auto part = [&](unsigned shift) { return static_cast<std::uint8_t>(80 + (mixed >> shift & 0xffU) % 176); };
  return {part(0), part(8), part(16)};
}

Image8 normals_image(const ViewSamples& samples) {
  return colored(samples, [&](std::size_t i) {
    const glm::vec3 n = (samples.n[i] + 1.0F) * 127.5F;
    return Color8{static_cast<std::uint8_t>(n.x), static_cast<std::uint8_t>(n.y), static_cast<std::uint8_t>(n.z)};
  });
}

Image8 depth_image(const ViewSamples& samples) {
  float nearest = std::numeric_limits<float>::max(), farthest = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.triangle[i] == ViewSamples::kBackground) continue;
    nearest = std::min(nearest, samples.depth[i]);
    farthest = std::max(farthest, samples.depth[i]);
  }
  const float range = std::max(farthest - nearest, std::numeric_limits<float>::min());
  return colored(samples, [&](std::size_t i) {
    const auto grey = static_cast<std::uint8_t>(250 - 230 * (samples.depth[i] - nearest) / range);
    return Color8{grey, grey, grey};
  });
}

/// Returns the pictures of a channel, each with the index of its answer.
std::vector<std::pair<const char*, Image8>> images_of(const LivePicture& picture, const LiveDisplay& display,
                                                      std::optional<double>& limit) {
  const ViewSamples& samples = picture.samples;
  std::vector<std::pair<const char*, Image8>> images;
  switch (display.channel) {
    case LiveChannel::error:
      if (picture.answers.size() == 2) {
        if (!limit) {
          const auto found = difference(picture, display.light);
          limit = compare::error_scale_limit(found ? found->largest : 1);
        }
        images.emplace_back("difference", compare::error_picture(samples, visibility_of(picture, 0, display.light),
                                                                 visibility_of(picture, 1, display.light), *limit));
        return images;
      }
      [[fallthrough]];  // there is no second method to compare with
    case LiveChannel::visibility:
      for (std::size_t i = 0; i < picture.answers.size(); ++i)
        images.emplace_back(i == 0 ? "a" : "b",
                            compare::visibility_picture(samples, visibility_of(picture, i, display.light)));
      return images;
    case LiveChannel::beauty: {
      const float exposure = std::exp2(display.stops.value_or(picture.automatic_stops));
      for (std::size_t i = 0; i < picture.answers.size(); ++i)
        images.emplace_back(i == 0 ? "a" : "b",
                            to_srgb(samples.width, samples.height, picture.answers[i].frame.sum, exposure));
      return images;
    }
    case LiveChannel::ids:
      images.emplace_back("all", colored(samples, [&](std::size_t i) {
                            return color_of_number(static_cast<std::uint32_t>(samples.triangle[i]));
                          }));
      return images;
    case LiveChannel::normals:
      images.emplace_back("all", normals_image(samples));
      return images;
    case LiveChannel::depth:
      images.emplace_back("all", depth_image(samples));
      return images;
  }
  return images;
}

}  // namespace

std::optional<LiveDifference> difference(const LivePicture& picture, const std::string& light) {
  if (picture.answers.size() != 2 || picture.lights.empty()) return std::nullopt;
  const std::vector<float>& a = visibility_of(picture, 0, light);
  const std::vector<float>& b = visibility_of(picture, 1, light);
  LiveDifference found;
  double squares = 0, sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (picture.samples.triangle[i] == ViewSamples::kBackground) continue;
    const double off = double{a[i]} - double{b[i]};
    squares += off * off;
    sum += off;
    found.largest = std::max(found.largest, std::abs(off));
    ++count;
  }
  if (count == 0) return std::nullopt;
  found.rmse = std::sqrt(squares / static_cast<double>(count));
  found.bias = sum / static_cast<double>(count);
  return found;
}

std::string frame_message(const LivePicture& picture, const LiveDisplay& display, const ordered_json& more) {
  std::optional<double> limit = display.limit;
  const auto images = images_of(picture, display, limit);
  std::vector<std::vector<std::byte>> bytes(images.size());
  tbb::parallel_for(std::size_t{0}, images.size(), [&](std::size_t i) {
    bytes[i] = picture.is_final ? encode_png_fast(images[i].second) : encode_jpeg(images[i].second, kQuality);
  });
  auto listed = ordered_json::array(), answers = ordered_json::array();
  for (std::size_t i = 0; i < images.size(); ++i) {
    listed.push_back({{"shows", images[i].first},
                      {"type", picture.is_final ? "image/png" : "image/jpeg"},
                      {"width", images[i].second.width},
                      {"height", images[i].second.height},
                      {"bytes", bytes[i].size()}});
  }
  for (const LiveAnswer& answer : picture.answers) {
    answers.push_back({{"method", answer.method},
                       {"lightSamples", answer.light_samples},
                       {"milliseconds", answer.milliseconds},
                       {"seconds", answer.seconds}});
  }
  ordered_json header = {{"type", "frame"},
                         {"final", picture.is_final},
                         {"width", picture.full_width},
                         {"height", picture.full_height},
                         {"triangles", picture.triangles},
                         {"milliseconds", picture.milliseconds},
                         {"stops", display.stops.value_or(picture.automatic_stops)},
                         {"limit", limit ? ordered_json(*limit) : ordered_json(nullptr)},
                         {"images", std::move(listed)},
                         {"answers", std::move(answers)}};
  if (const auto found = difference(picture, display.light))
    header["difference"] = {{"rmse", found->rmse}, {"bias", found->bias}, {"largest", found->largest}};
  header.update(more);
  std::string message = message_start(header);
  for (const std::vector<std::byte>& image : bytes)
    message.append(reinterpret_cast<const char*>(image.data()), image.size());
  return message;
}

ordered_json pixel_json(const LivePicture& picture, glm::uvec2 pixel, const WholeScene& whole, const LiveMasks* masks) {
  if (pixel.x >= picture.full_width || pixel.y >= picture.full_height)
    throw InputError("pixel {},{}: the picture has {}x{}", pixel.x, pixel.y, picture.full_width, picture.full_height);
  const ViewSamples& samples = picture.samples;
  const std::uint32_t x = std::min(pixel.x * samples.width / picture.full_width, samples.width - 1);
  const std::uint32_t y = std::min(pixel.y * samples.height / picture.full_height, samples.height - 1);
  const std::size_t i = std::size_t{y} * samples.width + x;
  ordered_json made = {{"type", "pixel"}, {"x", pixel.x}, {"y", pixel.y}, {"final", picture.is_final}};
  const std::int32_t triangle = samples.triangle[i];
  made["surface"] = triangle != ViewSamples::kBackground;
  if (triangle != ViewSamples::kBackground) {
    const glm::dvec3 p = glm::dvec3(samples.p[i]) + picture.origin;
    made["id"] = triangle;
    const auto number = static_cast<std::uint64_t>(triangle);
    made["object"] = whole.scene.objects[scenes::object_of(whole.scene, whole.instances, number)].name;
    made["position"] = {p.x, p.y, p.z};
    made["normal"] = {samples.n[i].x, samples.n[i].y, samples.n[i].z};
    made["depth"] = samples.depth[i];
  }
  auto answers = ordered_json::array();
  for (const LiveAnswer& answer : picture.answers) {
    ordered_json v = ordered_json::object();
    for (std::size_t light = 0; light < picture.lights.size(); ++light)
      v[picture.lights[light]] = answer.frame.visibility[light][i];
    const glm::vec3& sum = answer.frame.sum[i];
    answers.push_back({{"method", answer.method},
                       {"lightSamples", answer.light_samples},
                       {"V", std::move(v)},
                       {"beauty", {sum.x, sum.y, sum.z}}});
  }
  made["answers"] = std::move(answers);
  if (masks != nullptr && picture.is_final && masks->revision == picture.revision &&
      masks->masks.size() == samples.size() * masks->words) {
    std::string bits;
    for (std::size_t j = 0; j < masks->places.size(); ++j)
      bits += (masks->masks[i * masks->words + j / 32] >> (j % 32) & 1U) != 0 ? '1' : '0';
    auto places = ordered_json::array();
    for (const glm::dvec2& place : masks->places)
      places.push_back({std::round(place.x * 1000) / 1000, std::round(place.y * 1000) / 1000});
    made["seen"] = {{"light", masks->light}, {"shape", masks->shape}, {"places", std::move(places)}, {"bits", bits}};
  }
  return made;
}

}  // namespace penumbra::app
