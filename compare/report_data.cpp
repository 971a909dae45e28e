// Packs the report's numbers for its script: planes of bytes, deflated, as base64.

#include "compare/report_data.hpp"

#include "base/packed.hpp"
#include "compare/error_picture.hpp"
#include "compare/report_tables.hpp"
#include "visibility/view_samples.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <vector>

namespace penumbra::compare {
namespace {

using Json = nlohmann::ordered_json;

template <typename Number>
std::string pack_planes(std::span<const Number> numbers) {
  std::vector<std::byte> plane(numbers.size());
  Deflated deflated;
  for (std::size_t place = sizeof(Number); place-- > 0;) {
    std::ranges::transform(numbers, plane.begin(),
                           [&](Number number) { return static_cast<std::byte>(number >> (8 * place) & 0xff); });
    deflated.add(plane);
  }
  return base64(deflated.finish());
}

std::uint16_t radiance_code(float linear) {
  if (!(linear > 0)) return 0;
  // Floats, including denormal ones, lie between 2^−149 and 2^128.
  const double code = 1 + 256 * (std::log2(static_cast<double>(linear)) + 64);
  return static_cast<std::uint16_t>(std::lround(std::clamp(code, 1.0, 32767.0)));
}

/// Number of steps of four codes from one code to another, accurate to two codes. Black stays as dark as possible.
int steps_between(int from, int to) {
  const int away = to - from;
  return away < 0 ? -((1 - away) / 4) : (away + 1) / 4;
}

std::uint16_t folded(int steps) {
  return static_cast<std::uint16_t>(steps < 0 ? -2 * steps - 1 : 2 * steps);
}

/// Writes the packed numbers, each in an element that no browser runs; the JSON names them. Exact methods share theirs.
class Blobs {
 public:
  Json add(const std::string& packed) {
    if (packed.empty()) return nullptr;
    const auto [known, is_new] = names_.try_emplace(packed, fmt::format("packed-{}", names_.size()));
    if (is_new) html_ += fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", known->second, packed);
    return known->second;
  }
  [[nodiscard]] const std::string& html() const { return html_; }

 private:
  std::string html_;
  std::map<std::string, std::string> names_;
};

Json colors(std::span<const Color8> colors) {
  Json json = Json::array();
  for (const Color8& color : colors) json.push_back(color);
  return json;
}

Json points(std::span<const glm::dvec2> samples) {
  const auto short_number = [](double x) { return std::round(x * 1e4) / 1e4; };
  Json json = Json::array();
  for (const glm::dvec2& at : samples) json.push_back({short_number(at.x), short_number(at.y)});
  return json;
}

/// Role of an entry. `samples`: the light's sample set of its masks; `judges_pairs`: the entry is the rays to which
/// others on this set are compared. Masks to which no other entry is compared are left out: masks of 1,024 light
/// samples are a tenth of a page.
struct EntryRole {
  std::string label;
  const char* samples;
  bool judges_pairs;
  bool has_masks = true;
};

Json entry_json(const ReportEntry& entry, const EntryRole& role, Blobs& blobs) {
  Json lights = Json::array();
  for (const ReportLightView& light : entry.lights) {
    lights.push_back({{"v", blobs.add(light.packed_visibility)},
                      {"masks", role.has_masks ? blobs.add(light.packed_masks) : nullptr}});
  }
  return {{"label", role.label},
          {"samples", role.samples},
          {"judgesPairs", role.judges_pairs},
          {"beauty", blobs.add(entry.packed_beauty)},
          {"lights", lights}};
}

}  // namespace

bool has_packed_numbers(const ReportEntry& entry) {
  return !entry.lights.empty() && std::ranges::none_of(entry.lights, [](const ReportLightView& light) {
    return light.packed_visibility.empty();
  });
}

bool report_data_is_empty(const ReportInput& in) {
  return !has_packed_numbers(in.reference);
}

std::string pack_bytes(std::span<const std::byte> bytes) {
  Deflated deflated;
  deflated.add(bytes);
  return base64(deflated.finish());
}

std::string pack_floats(std::span<const float> values) {
  std::vector<std::uint32_t> bits(values.size());
  std::ranges::transform(values, bits.begin(), [](float value) { return std::bit_cast<std::uint32_t>(value); });
  return pack_planes<std::uint32_t>(bits);
}

std::string pack_radiance(std::uint32_t width, std::span<const glm::vec3> linear) {
  std::vector<std::uint16_t> steps(3 * linear.size());
  std::array<std::uint16_t, 3> left{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    if (i % width == 0) left = {};
    const std::uint16_t green = radiance_code(linear[i].g);
    const std::array<std::uint16_t, 3> here{green, static_cast<std::uint16_t>(radiance_code(linear[i].r) - green),
                                            static_cast<std::uint16_t>(radiance_code(linear[i].b) - green)};
    for (std::size_t plane = 0; plane < 3; ++plane) {
      steps[plane * linear.size() + i] = static_cast<std::uint16_t>(here[plane] - left[plane]);
    }
    left = here;
  }
  return pack_planes<std::uint16_t>(steps);
}

std::string pack_radiance_over(std::span<const glm::vec3> reference, std::span<const glm::vec3> linear) {
  std::vector<std::uint16_t> steps(3 * linear.size());
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const int green = steps_between(radiance_code(reference[i].g), radiance_code(linear[i].g));
    const int red = steps_between(radiance_code(reference[i].r) + 4 * green, radiance_code(linear[i].r));
    const int blue = steps_between(radiance_code(reference[i].b) + 4 * green, radiance_code(linear[i].b));
    steps[i] = folded(green);
    steps[linear.size() + i] = folded(red);
    steps[2 * linear.size() + i] = folded(blue);
  }
  return pack_planes<std::uint16_t>(steps);
}

std::string report_data_html(const ReportInput& in) {
  if (report_data_is_empty(in)) return {};
  Blobs blobs;
  Json lights = Json::array(), entries = Json::array();
  for (const ReportLight& light : in.lights) {
    Json samples = points(light.samples);
    lights.push_back({{"name", light.name},
                      {"classes", blobs.add(light.packed_classes)},
                      {"round", light.round},
                      {"aspect", light.aspect},
                      {"samples", samples}});
    if (!light.reference_samples.empty()) lights.back()["referenceSamples"] = points(light.reference_samples);
  }
  const bool same = in.same_samples;
  entries.push_back(entry_json(in.reference,
                               {in.metrics.reference.method + " (reference)", same ? "samples" : "referenceSamples",
                                same && in.reference.description.output == visibility::Output::mask, same || !in.rays},
                               blobs));
  if (in.rays && has_packed_numbers(*in.rays)) {
    entries.push_back(entry_json(*in.rays, {rays_label(in), "samples", true}, blobs));
  }
  for (std::size_t i = 0; i < in.methods.size(); ++i) {
    if (!has_packed_numbers(in.methods[i])) continue;
    entries.push_back(entry_json(in.methods[i], {in.metrics.methods[i].entry, "samples", false}, blobs));
  }
  const Json data{{"width", in.metrics.reference.width},
                  {"height", in.metrics.reference.height},
                  {"exposure", in.exposure},
                  {"errorLimit", in.error_limit},
                  {"background", kBackgroundColor},
                  {"tooBright", colors(error_colors(true))},
                  {"tooDark", colors(error_colors(false))},
                  {"classNames",
                   {"background", "a light’s body", "receives no shadow", "judged", "at the horizon",
                    "behind the light", "not lit by this light", "another light’s body"}},
                  {"lights", lights},
                  {"entries", entries}};
  // A name may contain "</script": the only text that could end the element.
  std::string text = data.dump(-1, ' ', false, Json::error_handler_t::replace), safe;
  for (const char c : text) safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return "<script type=\"application/json\" id=\"report-data\">" + safe + "</script>\n" + blobs.html();
}

}  // namespace penumbra::compare
