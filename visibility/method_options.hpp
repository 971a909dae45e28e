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
///   constexpr visibility::ChoiceOption kCoverage{
///       "coverage", {{"analytic", Coverage::analytic}, {"table", Coverage::table}}, Coverage::analytic, "what it
///       does"};
///   constexpr visibility::IntegerOption kSize{"size", 8, 16384, 1024, "texels on a side of a map"};
///
/// lists `kCoverage.description()` in its MethodDescription, and reads typed values from what parse_options made of the
/// user's texts: `options[kCoverage]` is a Coverage. What `penumbra methods` prints, what is refused, the messages, and
/// the default all come from that one declaration.
namespace penumbra::visibility {

/// KEY=VALUE pairs as the user gave them.
using MethodOptions = std::map<std::string, std::string>;

/// An option as text: what `penumbra methods` prints, and what a value is checked against.
struct OptionDescription {
  std::string name;
  std::vector<std::string> choices{};  ///< the values it can have; empty: a number
  double least = 0, most = 0;          ///< of a number, both included
  bool whole = false;                  ///< only whole numbers, written in digits
  std::string default_value;
  std::string help;

  /// "on|off": one of these; "1 … 4096": a whole number; "0.0 … 8.0": any number, both ends included.
  [[nodiscard]] std::string values() const;
};

/// A name that the user may give, and what it stands for.
template <typename Value>
struct NamedValue {
  const char* name;
  Value value;
};

/// One of a few names, each of which stands for a value.
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
  /// `number`: which of the choices.
  [[nodiscard]] constexpr V value_of(double number) const { return choices_[static_cast<std::size_t>(number)].value; }

 private:
  const char* name_;
  std::array<NamedValue<V>, kCount> choices_;
  V otherwise_;
  const char* help_;
};
template <typename V, std::size_t kCount>
ChoiceOption(const char*, const NamedValue<V> (&)[kCount], V, const char*) -> ChoiceOption<V, kCount>;

/// on or off.
constexpr ChoiceOption<bool, 2> flag_option(const char* name, bool otherwise, const char* help) {
  return {name, {{"on", true}, {"off", false}}, otherwise, help};
}

/// A number from `least` to `most`, both included.
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

/// A method's options as given, each one that it has, with a value that it can have; defaults for the rest.
class ParsedOptions {
 public:
  /// Throws UsageError for a key that is none of `options` and for a value that its option cannot have; the message
  /// says what there is, and what was perhaps meant. `method` is for messages.
  ParsedOptions(std::string_view method, std::span<const OptionDescription> options, const MethodOptions& given);

  /// Asserts that the method has the option.
  template <typename Option>
  [[nodiscard]] typename Option::Value operator[](const Option& option) const {
    return option.value_of(find(option.name()).number);
  }
  /// Did the user give it?
  template <typename Option>
  [[nodiscard]] bool given(const Option& option) const {
    return find(option.name()).given;
  }

 private:
  struct Entry {
    double number = 0;  ///< of a choice, which one; else the number itself
    bool given = false;
  };
  [[nodiscard]] const Entry& find(std::string_view name) const;

  std::map<std::string, Entry, std::less<>> entries_;
};

}  // namespace penumbra::visibility
