// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// The options of a method. A method declares each once, as a constant:
///
///     constexpr visibility::ChoiceOption kCoverage{
///         "coverage", {{"analytic", Coverage::analytic}, {"table", Coverage::table}}, Coverage::analytic, "what it
///         does"};
///     constexpr visibility::IntegerOption kSize{"size", 8, 16384, 1024, "texels on a side of a map"};
///
/// lists `kCoverage.description()` in its MethodDescription, and reads typed values from the result of parse_options:
/// `options[kCoverage]` is a Coverage. The output of `penumbra methods`, the accepted values, the messages, and the
/// default all derive from that one declaration.
namespace penumbra::visibility {

/// KEY=VALUE pairs as the user gave them.
using MethodOptions = std::map<std::string, std::string>;

/// An option as text: printed by `penumbra methods`, and used to check values.
struct OptionDescription {
  std::string name;
  std::vector<std::string> choices{};  ///< the possible values; empty: a number
  double least = 0, most = 0;          ///< range of a number, both ends included
  bool whole = false;                  ///< only integers, written in digits
  std::string default_value;
  std::string help;

  /// Returns "on|off": one of these; "1 … 4096": an integer; "0.0 … 8.0": any number, both ends included.
  [[nodiscard]] std::string values() const;
};

/// A name that the user may give, and the value that it stands for.
template <typename Value>
struct NamedValue {
  const char* name;
  Value value;
};

/// An option with a few named values.
template <typename V, std::size_t kCount>
class ChoiceOption {
 public:
  using Value = V;

  constexpr ChoiceOption(const char* name, const NamedValue<V> (&choices)[kCount], V otherwise, const char* help)
      : name_(name), choices_(std::to_array(choices)), otherwise_(otherwise), help_(help) {}

  [[nodiscard]] constexpr const char* name() const { return name_; }
  [[nodiscard]] constexpr const char* name_of(V value) const {
    for (const NamedValue<V>& choice : choices_) {
      if (choice.value == value) return choice.name;
    }
    return "?";
  }
  [[nodiscard]] OptionDescription description() const {
    OptionDescription text{.name = name_, .default_value = name_of(otherwise_), .help = help_};
    for (const NamedValue<V>& choice : choices_) text.choices.emplace_back(choice.name);
    return text;
  }
  /// `number`: index of the choice.
  [[nodiscard]] constexpr V value_of(double number) const { return choices_[static_cast<std::size_t>(number)].value; }

 private:
  const char* name_;
  std::array<NamedValue<V>, kCount> choices_;
  V otherwise_;
  const char* help_;
};
template <typename V, std::size_t kCount>
ChoiceOption(const char*, const NamedValue<V> (&)[kCount], V, const char*) -> ChoiceOption<V, kCount>;

/// Declares an option with the values on and off.
constexpr ChoiceOption<bool, 2> flag_option(const char* name, bool otherwise, const char* help) {
  return {name, {{"on", true}, {"off", false}}, otherwise, help};
}

/// An option that is a number from `least` to `most`, both included.
template <typename V>
struct NumberOption {
  using Value = V;

  const char* key;
  V least, most, otherwise;
  const char* help;

  [[nodiscard]] constexpr const char* name() const { return key; }
  [[nodiscard]] OptionDescription description() const;
  [[nodiscard]] constexpr V value_of(double number) const { return static_cast<V>(number); }
};
using IntegerOption = NumberOption<std::uint32_t>;
using RealOption = NumberOption<double>;

/// A method's options with checked values; defaults for those not given.
class ParsedOptions {
 public:
  /// Throws UsageError for a key that is not in `options` and for a value that its option cannot have; the message
  /// lists the possible ones and names the closest. `method` is for messages.
  ParsedOptions(std::string_view method, std::span<const OptionDescription> options, const MethodOptions& given);

  /// Returns the option's value. Asserts that the method has the option.
  template <typename Option>
  [[nodiscard]] typename Option::Value operator[](const Option& option) const {
    return option.value_of(find(option.name()).number);
  }
  /// Returns whether the user gave the option.
  template <typename Option>
  [[nodiscard]] bool given(const Option& option) const {
    return find(option.name()).given;
  }

 private:
  struct Entry {
    double number = 0;  ///< index of a choice; else the number itself
    bool given = false;
  };
  [[nodiscard]] const Entry& find(std::string_view name) const;

  std::map<std::string, Entry, std::less<>> entries_;
};

}  // namespace penumbra::visibility
