#include "visibility/method.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace penumbra::visibility {
namespace {

/// The whole text as a finite number, or nothing. `12.` and `1e3` are numbers; whether they are whole is another
/// question.
std::optional<double> number_in(std::string_view text) {
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

const OptionDescription* find_option(const MethodDescription& description, const std::string& name) {
  const auto found = std::ranges::find(description.options, name, &OptionDescription::name);
  return found == description.options.end() ? nullptr : &*found;
}

}  // namespace

const char* name_of(Family family) {
  switch (family) {
    case Family::reference:
      return "reference";
    case Family::geometry:
      return "geometry";
    case Family::image:
      return "image";
  }
  return "?";
}

const char* name_of(Output output) {
  switch (output) {
    case Output::mask:
      return "mask";
    case Output::scalar:
      return "scalar";
    case Output::radiance:
      return "radiance";
  }
  return "?";
}

bool OptionValues::permit(const std::string& value) const {
  if (!choices.empty()) return std::ranges::find(choices, value) != choices.end();
  if (whole && value.find_first_not_of("0123456789") != std::string::npos) return false;
  const std::optional<double> number = number_in(value);
  return number && *number >= least && *number <= most;
}

OptionValues values_of(const OptionDescription& option) {
  static constexpr std::string_view kTo = " … ";
  const std::string_view text = option.values;
  OptionValues values;
  if (const auto to = text.find(kTo); to != std::string_view::npos) {
    const std::optional<double> least = number_in(text.substr(0, to)), most = number_in(text.substr(to + kTo.size()));
    PENUMBRA_ASSERT(least && most && *least <= *most, "option {} has the range \"{}\"", option.name, text);
    values.least = *least;
    values.most = *most;
    values.whole = text.find('.') == std::string_view::npos;
    return values;
  }
  for (std::size_t first = 0; first <= text.size();) {
    const std::size_t end = std::min(text.find('|', first), text.size());
    values.choices.emplace_back(text.substr(first, end - first));
    first = end + 1;
  }
  return values;
}

void Method::read_masks(std::span<std::uint32_t> masks) {
  throw UsageError(
      "method {} gives V alone, not one bit a light sample ({} words asked for); take a method whose output "
      "is a mask (see `penumbra methods`)",
      description().name, masks.size());
}

void Method::read_form_factors(std::span<glm::dvec3> form_factors) {
  throw UsageError("method {} does not integrate radiance itself ({} form factors asked for)", description().name,
                   form_factors.size());
}

void check_light(const MethodDescription& description, const Light& light) {
  const std::vector<LightKind>& can = description.lights;
  if (light.texture && !description.textures) {
    throw InputError(
        "light \"{}\" has a texture; method {} knows none. Take another light (--light) or method (--method; raytrace "
        "does textures)",
        light.name, description.name);
  }
  if (light.rows == 0 && !description.any_pattern && light.kind == LightKind::rectangle) {
    throw InputError(
        "light \"{}\": method {} takes light samples in rows (--sample-pattern rows or grid), not {}; view-sample and "
        "raytrace take any",
        light.name, description.name, name_of(light.pattern));
  }
  if (std::find(can.begin(), can.end(), light.kind) != can.end()) return;
  std::string kinds;
  for (const LightKind kind : can) kinds += (kinds.empty() ? "" : ", ") + std::string(name_of(kind));
  throw InputError(
      "light \"{}\" is a {}; method {} can do: {}. Take another light (--light) or method (--method; raytrace "
      "does every kind)",
      light.name, name_of(light.kind), description.name, kinds);
}

void check_options(const MethodDescription& description, const MethodOptions& options) {
  for (const auto& [key, value] : options) {
    if (const OptionDescription* option = find_option(description, key)) {
      if (values_of(*option).permit(value)) continue;
      throw UsageError("method {}: option {} is \"{}\"; it must be {}", description.name, key, value, option->values);
    }
    std::string known;
    for (const OptionDescription& option : description.options) {
      known += fmt::format("{}{} ({})", known.empty() ? "" : ", ", option.name, option.values);
    }
    throw UsageError("method {} has no option \"{}\"; it has {}", description.name, key,
                     known.empty() ? "none" : known);
  }
}

}  // namespace penumbra::visibility
