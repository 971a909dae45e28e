// SPDX-License-Identifier: Apache-2.0
// Finds the first violation of a JSON Schema in a document, and words it for the user.

#include "scenes/formats/json_schema.hpp"

#include "base/assert.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

/// Describes a violation of the schema in a sentence that helps a user to repair it. General validators report that no
/// branch of a `oneOf` fits; this one determines the intended branch (by the key that is present, or by "type"), and
/// reports the innermost wrong value in it.
namespace penumbra::scenes {
namespace {

using nlohmann::json;

using Words = std::optional<std::string>;

class Validator {
 public:
  explicit Validator(const json& root) : root_(root) {}

  Words find(const json& unresolved, const json& instance, const Place& place) const {
    const json& schema = resolve(unresolved);
    if (!fits_type(schema, instance) || !fits_constant(schema, instance)) return mismatch(schema, instance, place);
    if (instance.is_object()) return find_in_object(schema, instance, place);
    if (schema.contains("oneOf")) return find_in_choice(schema, instance, place);
    if (instance.is_array()) return find_in_array(schema, instance, place);
    if (instance.is_number() && !fits_bounds(schema, instance.get<double>())) return mismatch(schema, instance, place);
    if (instance.is_string() && !fits_length(schema, instance.get_ref<const std::string&>())) {
      return mismatch(schema, instance, place);
    }
    return {};
  }

 private:
  [[nodiscard]] const json& resolve(const json& schema) const {
    const auto reference = schema.find("$ref");
    if (reference == schema.end()) return schema;
    return resolve(root_.at(json::json_pointer(reference->get<std::string>().substr(1))));  // "#/definitions/x"
  }

  // --- what is expected, in words -------------------------------------------------------------------------------

  [[nodiscard]] std::string expected(const json& unresolved) const {
    const json& schema = resolve(unresolved);
    if (schema.contains("title") && &schema != &root_) return schema["title"].get<std::string>();
    if (schema.contains("const")) return schema["const"].dump();
    if (schema.contains("enum")) return "one of " + schema["enum"].dump();
    if (schema.contains("type")) {
      const std::string type = schema["type"].get<std::string>();
      if (type == "number" || type == "integer") return (type == "number" ? "a number" : "an integer") + bounds(schema);
      if (type == "boolean") return "true or false";
      if (type == "array") return fmt::format("an array of at least {}", schema.value("minItems", 0));
      if (type == "string") return "a string" + lengths(schema);
      return "an object" + example(schema);
    }
    if (schema.contains("oneOf")) {
      std::string text;
      for (const json& branch : schema["oneOf"]) {
        if (!discriminator(branch).empty()) return "an object with a \"type\"";
        text += (text.empty() ? "" : " or ") + expected(branch);
      }
      return text;
    }
    return "something else";
  }

  static std::string bounds(const json& schema) {
    const auto number = [&](const char* key) { return schema[key].dump(); };
    if (schema.contains("minimum") && schema.contains("maximum")) {
      return " from " + number("minimum") + " to " + number("maximum");
    }
    if (schema.contains("exclusiveMinimum") && schema.contains("exclusiveMaximum")) {
      return " above " + number("exclusiveMinimum") + " and below " + number("exclusiveMaximum");
    }
    if (schema.contains("minimum") && schema.contains("exclusiveMaximum")) {
      return " from " + number("minimum") + " up and below " + number("exclusiveMaximum");
    }
    if (schema.contains("minimum")) return " from " + number("minimum") + " up";
    if (schema.contains("exclusiveMinimum")) return " above " + number("exclusiveMinimum");
    return "";
  }

  static std::string lengths(const json& schema) {
    const bool has_least = schema.contains("minLength"), has_most = schema.contains("maxLength");
    if (has_least && has_most) {
      return fmt::format(" of {} to {} characters", schema["minLength"].dump(), schema["maxLength"].dump());
    }
    return has_least ? fmt::format(" of at least {} character(s)", schema["minLength"].dump()) : "";
  }

  static std::string example(const json& schema) {
    return schema.contains("examples") ? ", for example " + schema["examples"][0].dump() : "";
  }

  Words mismatch(const json& schema, const json& instance, const Place& place) const {
    return fmt::format("{}: expected {}, found {}", place.str(), expected(schema), describe_value(instance));
  }

  // --- single values --------------------------------------------------------------------------------------------

  static bool fits_type(const json& schema, const json& instance) {
    const auto type = schema.find("type");
    if (type == schema.end()) return true;
    if (*type == "number") return instance.is_number();
    if (*type == "integer") return instance.is_number_integer();
    if (*type == "string") return instance.is_string();
    if (*type == "boolean") return instance.is_boolean();
    if (*type == "array") return instance.is_array();
    PENUMBRA_ASSERT(*type == "object", "the schema uses a type that is not explained: {}", type->dump());
    return instance.is_object();
  }

  static bool fits_constant(const json& schema, const json& instance) {
    if (const auto values = schema.find("enum"); values != schema.end()) {
      if (std::ranges::find(*values, instance) == values->end()) return false;
    }
    return !schema.contains("const") || schema["const"] == instance;
  }

  static bool fits_bounds(const json& schema, double value) {
    const auto bound = [&](const char* key, double none) { return schema.value(key, none); };
    constexpr double kNone = std::numeric_limits<double>::infinity();
    return value >= bound("minimum", -kNone) && value <= bound("maximum", kNone) &&
           value > bound("exclusiveMinimum", -kNone) && value < bound("exclusiveMaximum", kNone);
  }

  static bool fits_length(const json& schema, const std::string& text) {
    const auto characters = static_cast<std::size_t>(  // UTF-8: counts all bytes but continuations
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
    return characters >= schema.value("minLength", std::size_t{0}) &&
           characters <= schema.value("maxLength", std::numeric_limits<std::size_t>::max());
  }

  // --- containers -----------------------------------------------------------------------------------------------

  Words find_in_array(const json& schema, const json& instance, const Place& place) const {
    if (instance.size() < schema.value("minItems", std::size_t{0}) ||
        instance.size() > schema.value("maxItems", std::numeric_limits<std::size_t>::max())) {
      return mismatch(schema, instance, place);
    }
    for (std::size_t i = 0; schema.contains("items") && i < instance.size(); ++i) {
      if (Words words = find(schema["items"], instance[i], place / i)) return words;
    }
    return {};
  }

  Words find_in_object(const json& schema, const json& instance, const Place& place) const {
    const auto properties = schema.find("properties");
    if (properties != schema.end()) {
      for (const auto& [key, value] : instance.items()) {
        if (!properties->contains(key)) {
          return fmt::format("{}: unknown key \"{}\"; known here: {}", place.str(), key, list_of_keys(*properties));
        }
      }
      for (const json& key : schema.value("required", json::array())) {
        if (!instance.contains(key)) {
          const json& missing = (*properties)[key.get<std::string>()];
          return fmt::format("{}: missing key {}: expected {}{}", place.str(), key.dump(), expected(missing),
                             resolve(missing).value("type", "") == "array" ? example(resolve(missing)) : "");
        }
      }
    }
    if (const auto forbidden = schema.find("not"); forbidden != schema.end()) {
      const json& keys = (*forbidden)["required"];
      if (std::all_of(keys.begin(), keys.end(), [&](const json& key) { return instance.contains(key); })) {
        return fmt::format("{}: the keys {} exclude one another; remove one", place.str(), keys.dump());
      }
    }
    if (schema.contains("oneOf")) {
      if (Words words = find_in_choice(schema, instance, place)) return words;
    }
    if (properties != schema.end()) {
      for (const auto& [key, value] : instance.items()) {
        if (Words words = find((*properties)[key], value, place / key)) return words;
      }
    }
    return {};
  }

  static std::string list_of_keys(const json& properties) {
    std::string list;
    for (const auto& [key, value] : properties.items()) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", key);
    return list;
  }

  // --- oneOf ----------------------------------------------------------------------------------------------------

  /// Returns the value of "type" that a branch requires; empty for other branches.
  [[nodiscard]] std::string discriminator(const json& unresolved) const {
    const json& branch = resolve(unresolved);
    static const json::json_pointer type_constant("/properties/type/const");
    return branch.contains(type_constant) ? branch[type_constant].get<std::string>() : "";
  }

  Words find_in_choice(const json& schema, const json& instance, const Place& place) const {
    const json& branches = schema["oneOf"];
    if (branches[0].contains("required") && !branches[0].contains("properties")) {
      return find_in_exclusive_keys(schema, instance, place);
    }
    if (!discriminator(branches[0]).empty()) return find_in_types(branches, instance, place);
    for (const json& branch : branches) {
      if (fits_type(resolve(branch), instance)) return find(branch, instance, place);
    }
    return mismatch(schema, instance, place);
  }

  Words find_in_exclusive_keys(const json& schema, const json& instance, const Place& place) const {
    std::string wanted, present;
    int count = 0;
    for (const json& branch : schema["oneOf"]) {
      const std::string key = branch["required"][0].get<std::string>();
      wanted += fmt::format("{}\"{}\"", wanted.empty() ? "" : ", ", key);
      if (!instance.contains(key)) continue;
      present += fmt::format("{}\"{}\"", count++ == 0 ? "" : " and ", key);
    }
    if (count == 1) return {};
    const json& first = schema["properties"][schema["oneOf"][0]["required"][0].get<std::string>()];
    return fmt::format("{}: expected exactly one of the keys {}, found {}{}", place.str(), wanted,
                       count == 0 ? "none" : present,
                       count == 0 ? example(schema.contains("examples") ? schema : resolve(first)) : "");
  }

  Words find_in_types(const json& branches, const json& instance, const Place& place) const {
    if (!instance.is_object()) {
      return fmt::format("{}: expected an object with a \"type\", found {}", place.str(), describe_value(instance));
    }
    std::string known;
    for (const json& branch : branches) {
      const std::string type = discriminator(branch);
      if (instance.contains("type") && instance["type"] == type) return find(branch, instance, place);
      known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", type);
    }
    if (!instance.contains("type"))
      return fmt::format("{}: missing key \"type\": expected one of {}", place.str(), known);
    return fmt::format("{}: expected one of {}, found {}", (place / "type").str(), known,
                       describe_value(instance["type"]));
  }

  const json& root_;
};

}  // namespace

Words find_violation(const json& schema, const json& instance, const std::string& file) {
  return Validator(schema).find(schema, instance, Place{file, {}});
}

}  // namespace penumbra::scenes
