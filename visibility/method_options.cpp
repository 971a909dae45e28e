// SPDX-License-Identifier: Apache-2.0
// Parses a method's options, KEY=VALUE, and checks them against their declarations. A wrong key or value is refused;
// the message lists the possible ones and names the closest.

#include "visibility/method_options.hpp"

#include "base/assert.hpp"
#include "base/did_you_mean.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace penumbra::visibility {
namespace {

/// Returns the whole text as a finite number, or nullopt. `12.` and `1e3` are numbers.
std::optional<double> number_in(std::string_view text) {
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

/// Returns the index of the choice, or the number, that the text stands for; nullopt if the option cannot have this
/// value.
std::optional<double> parse_value(const OptionDescription& option, const std::string& text) {
  if (!option.choices.empty()) {
    const auto choice = std::ranges::find(option.choices, text);
    if (choice == option.choices.end()) return std::nullopt;
    return static_cast<double>(choice - option.choices.begin());
  }
  if (option.whole && text.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  const std::optional<double> number = number_in(text);
  return number && *number >= option.least && *number <= option.most ? number : std::nullopt;
}

}  // namespace

std::string OptionDescription::values() const {
  if (choices.empty()) return whole ? fmt::format("{} … {}", least, most) : fmt::format("{:#} … {:#}", least, most);
  std::string text;
  for (const std::string& choice : choices) text += (text.empty() ? "" : "|") + choice;
  return text;
}

template <typename V>
OptionDescription NumberOption<V>::description() const {
  return {.name = key,
          .least = static_cast<double>(least),
          .most = static_cast<double>(most),
          .whole = std::is_integral_v<V>,
          .default_value = fmt::format("{}", otherwise),
          .help = help};
}
template struct NumberOption<std::uint32_t>;
template struct NumberOption<double>;

ParsedOptions::ParsedOptions(std::string_view method, std::span<const OptionDescription> options,
                             const MethodOptions& given) {
  for (const OptionDescription& option : options) {
    const std::optional<double> otherwise = parse_value(option, option.default_value);
    PENUMBRA_ASSERT(otherwise, "method {}: the default of {} is \"{}\", which is not {}", method, option.name,
                    option.default_value, option.values());
    entries_[option.name] = {.number = *otherwise};
  }
  for (const auto& [key, value] : given) {
    const auto option = std::ranges::find(options, key, &OptionDescription::name);
    if (option == options.end()) {
      std::string known;
      std::vector<std::string> names;
      for (const OptionDescription& has : options) {
        known += fmt::format("{}{} ({})", known.empty() ? "" : ", ", has.name, has.values());
        names.push_back(has.name);
      }
      throw UsageError("method {} has no option \"{}\"; it has {}{}", method, key, known.empty() ? "none" : known,
                       did_you_mean(key, names));
    }
    const std::optional<double> number = parse_value(*option, value);
    if (!number) {
      throw UsageError("method {}: option {} is \"{}\"; it must be {}{}", method, key, value, option->values(),
                       did_you_mean(value, option->choices));
    }
    entries_[key] = {.number = *number, .given = true};
  }
}

const ParsedOptions::Entry& ParsedOptions::find(std::string_view name) const {
  const auto entry = entries_.find(name);
  PENUMBRA_ASSERT(entry != entries_.end(), "the method declares no option {}", name);
  return entry->second;
}

}  // namespace penumbra::visibility
