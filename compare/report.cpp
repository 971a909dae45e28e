// SPDX-License-Identifier: Apache-2.0
// Assembles the report: one self-contained HTML page. Its script draws all that the page shows from the JSON in it.

#include "compare/report.hpp"

#include "base/assert.hpp"
#include "base/atomic_file.hpp"
#include "base/png.hpp"
#include "compare/error_picture.hpp"
#include "compare/question.hpp"
#include "compare/report_text.hpp"
#include "visibility/view_samples.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

namespace penumbra::compare {
namespace {

using Json = nlohmann::ordered_json;

/// Writes the packed numbers, each in an element that no browser runs; the JSON names them. Exact methods share their
/// numbers.
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

/// Returns whether the entry carries V of each pixel under every light.
bool has_packed_numbers(const ReportEntry& entry) {
  return !entry.lights.empty() && std::ranges::none_of(entry.lights, [](const ReportLightView& light) {
    return light.packed_visibility.empty();
  });
}

/// Role of an entry. `samples`: the set of light samples of its masks. `judges_pairs`: the entry has the rays with
/// which other entries on this set are compared. Masks with which no other entry is compared are left out: masks of
/// 1,024 light samples are a tenth of a page.
struct EntryRole {
  const char* role;
  const char* samples;
  bool judges_pairs = false;
  bool has_masks = true;
  std::optional<std::size_t> method = {};  ///< index into the methods
};

Json entry_json(const ReportEntry& entry, const EntryRole& role, Blobs& blobs) {
  Json lights = Json::array();
  for (const ReportLightView& light : entry.lights) {
    lights.push_back({{"v", blobs.add(light.packed_visibility)},
                      {"masks", role.has_masks ? blobs.add(light.packed_masks) : nullptr}});
  }
  return {{"role", role.role},
          {"method", role.method ? Json(*role.method) : Json()},
          {"samples", role.samples},
          {"judgesPairs", role.judges_pairs},
          {"beauty", blobs.add(entry.packed_beauty)},
          {"lights", lights}};
}

/// Returns the entries whose values the page shows pixel by pixel: the reference, the rays and the methods that have
/// packed numbers. Empty if the reference has none.
Json entries_json(const ReportInput& in, Blobs& blobs) {
  Json entries = Json::array();
  if (!has_packed_numbers(in.reference)) return entries;
  const bool same = in.same_samples;
  entries.push_back(entry_json(in.reference,
                               {"reference", same ? "samples" : "referenceSamples",
                                same && in.reference.description.output == visibility::Output::mask, same || !in.rays},
                               blobs));
  if (in.rays && has_packed_numbers(*in.rays))
    entries.push_back(entry_json(*in.rays, {"rays", "samples", true}, blobs));
  for (std::size_t i = 0; i < in.methods.size(); ++i) {
    if (has_packed_numbers(in.methods[i]))
      entries.push_back(entry_json(in.methods[i], {.role = "method", .samples = "samples", .method = i}, blobs));
  }
  return entries;
}

Json lights_json(const ReportInput& in, Blobs& blobs) {
  Json lights = Json::array();
  for (const ReportLight& light : in.lights) {
    lights.push_back({{"name", light.name},
                      {"classes", blobs.add(light.packed_classes)},
                      {"round", light.round},
                      {"aspect", light.aspect},
                      {"samples", points(light.samples)}});
    if (!light.reference_samples.empty()) lights.back()["referenceSamples"] = points(light.reference_samples);
  }
  return lights;
}

/// Returns a method's description, the quantity that it computed, and pictures of its repairs, light by light.
Json method_json(const ReportInput& in, const ReportEntry& entry, const Stats& stats) {
  const visibility::MethodDescription& method = entry.description;
  Json options = Json::array(), repairs = Json::array();
  for (const visibility::OptionDescription& option : method.options) {
    options.push_back(
        {{"name", option.name}, {"values", option.values()}, {"default", option.default_value}, {"help", option.help}});
  }
  for (const ReportLightView& light : entry.lights) {
    Json pictures = Json::array();
    for (const BudgetPicture& shown : light.budget_pictures)
      pictures.push_back({{"repaired", shown.repaired}, {"png", png_data_uri(shown.picture)}});
    repairs.push_back(pictures);
  }
  const Asked asked{method, stats};
  return {
      {"family", visibility::name_of(method.family)},
      {"output", visibility::name_of(method.output)},
      {"paper", method.paper},
      {"exactFor", method.exact_for},
      {"onRequest", method.on_request},
      {"options", options},
      {"question", question_of(asked)},
      {"sameQuestion", same_question(asked, {in.reference.description, in.metrics.reference}, in.sampled_pixels != 0)},
      {"repairs", repairs}};
}

Json machine_json(const Machine& machine) {
  return {{"processor", machine.processor},
          {"threads", machine.threads},
          {"memoryBytes", machine.memory_bytes},
          {"system", machine.operating_system}};
}

Json report_json(const ReportInput& in, Blobs& blobs) {
  Json scene = Json::array(), methods = Json::array();
  for (const ReportFact& fact : in.scene) scene.push_back({fact.name, fact.value});
  for (std::size_t i = 0; i < in.methods.size(); ++i)
    methods.push_back(method_json(in, in.methods[i], in.metrics.methods[i].stats));
  return {{"version", in.version},
          {"command", shell_text(in.arguments)},
          {"view", shell_text(in.view_arguments)},
          {"metrics", to_json(in.metrics)},
          {"scene", scene},
          {"reference", method_json(in, in.reference, in.metrics.reference)},
          {"methods", methods},
          {"sameSamples", in.same_samples},
          {"sampledPixels", in.sampled_pixels},
          {"machine", machine_json(in.machine)},
          {"warnings", in.warnings},
          {"width", in.metrics.reference.width},
          {"height", in.metrics.reference.height},
          {"exposure", in.exposure},
          {"errorLimit", in.error_limit},
          {"background", kBackgroundColor},
          {"tooBright", colors(error_colors(true))},
          {"tooDark", colors(error_colors(false))},
          {"classNames",
           {"background", "a light’s body", "receives no shadow", "judged", "at the horizon", "behind the light",
            "not lit by this light", "another light’s body"}},
          {"lights", lights_json(in, blobs)},
          {"entries", entries_json(in, blobs)}};
}

/// Returns the script's input as elements of the page: the JSON object, and the packed numbers named in it.
std::string data_html(const ReportInput& in) {
  Blobs blobs;
  // Names may hold bytes that are not UTF-8, and "</script": the only text that could end the element.
  const std::string text = report_json(in, blobs).dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string safe;
  for (const char c : text) safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return "<script type=\"application/json\" id=\"report-data\">" + safe + "</script>\n" + blobs.html();
}

}  // namespace

std::string report_html(const ReportInput& in) {
  PENUMBRA_ASSERT(in.methods.size() == in.metrics.methods.size(), "{} entries for {} results", in.methods.size(),
                  in.metrics.methods.size());
  const std::size_t count = in.methods.size();
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      // The policy forbids any external resource, whatever the page contains: no network, and no text is ever run as a
      // program.
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n"
      "<title>Soft shadows of {}: {} method{} compared</title>\n<style>",
      escape_html(in.metrics.reference.scene), count, count == 1 ? "" : "s");
  html += kReportStyle;
  html += "</style>\n</head>\n<body>\n";
  html += kReportMarkup;
  html += data_html(in) + "<script>\n";
  html += kReportScript;
  return html + "</script>\n</body>\n</html>\n";
}

void write_report(const std::filesystem::path& path, const ReportInput& input) {
  write_file_atomically(path, report_html(input));
}

}  // namespace penumbra::compare
