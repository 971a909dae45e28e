// SPDX-License-Identifier: Apache-2.0
// Tests the validator of scene files (scenes::find_violation) against a JSON Schema library.

#include "scenes/formats/json_schema.hpp"
#include "tests/unit/scenes/support.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace penumbra::test {
namespace {

/// Validator from the library valijson, which implements all of JSON Schema.
class Library {
 public:
  explicit Library(const nlohmann::json& schema) {
    valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(Adapter(schema), schema_);
  }
  [[nodiscard]] bool accepts(const nlohmann::json& document) const {
    valijson::Validator validator(valijson::Validator::kStrongTypes);
    return validator.validate(schema_, Adapter(document), nullptr);
  }

 private:
  using Adapter = valijson::adapters::NlohmannJsonAdapter;
  valijson::Schema schema_;
};

/// Lists all values in a document, the outermost first.
void list_values(nlohmann::json& document, std::vector<nlohmann::json*>& values) {
  values.push_back(&document);
  if (!document.is_structured()) return;
  for (nlohmann::json& child : document) list_values(child, values);
}

std::vector<std::string> property_names(const nlohmann::json& schema) {
  std::set<std::string> names;
  const auto visit = [&](const auto& self, const nlohmann::json& node) -> void {
    if (!node.is_structured()) return;
    if (node.is_object() && node.contains("properties")) {
      for (const auto& [name, value] : node["properties"].items()) names.insert(name);
    }
    for (const nlohmann::json& child : node) self(self, child);
  };
  visit(visit, schema);
  return {names.begin(), names.end()};
}

/// Changes one value of a shipped scene at random (replaced, removed, or added) and compares both verdicts.
TEST(JsonSchema, DecidesAsALibraryDoes) {
  const nlohmann::json schema = nlohmann::json::parse(scenes::kSceneSchemaText);
  const Library library(schema);
  const std::vector<std::string> names = property_names(schema);
  std::vector<nlohmann::json> others = {nullptr,
                                        true,
                                        0,
                                        1,
                                        -1,
                                        0.5,
                                        4096,
                                        1e300,
                                        "",
                                        "x",
                                        "key",
                                        nlohmann::json::array(),
                                        nlohmann::json::object(),
                                        nlohmann::json::array({0, 1, 0}),
                                        nlohmann::json::array({1, 0, 0, 0, 1, 0, 0, 0, 1}),
                                        "opaque",
                                        "rows"};
  std::mt19937 random(7);
  const auto one_of = [&](const auto& list) -> const auto& {
    return list[random() % list.size()];
  };
  int accepted = 0, refused = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PENUMBRA_SCENES)) {
    if (entry.path().extension() != ".json" || entry.path().stem().extension() == ".schema") continue;
    std::ifstream stream(entry.path());
    const nlohmann::json scene = nlohmann::json::parse(stream);
    ASSERT_TRUE(library.accepts(scene)) << entry.path();
    for (int i = 0; i < 400; ++i) {
      nlohmann::json document = scene;
      std::vector<nlohmann::json*> values;
      list_values(document, values);
      nlohmann::json& place = *one_of(values);
      switch (random() % 4) {
        case 0:
          place = one_of(others);
          break;
        case 1:
          place = nlohmann::json(*one_of(values));
          break;
        case 2:
          if (place.is_object() && !place.empty())
            place.erase(std::next(place.begin(), static_cast<std::ptrdiff_t>(random() % place.size())).key());
          else if (place.is_array() && !place.empty())
            place.erase(random() % place.size());
          break;
        default:
          if (place.is_object())
            place[one_of(names)] = random() % 2 == 0 ? one_of(others) : nlohmann::json(*one_of(values));
          else if (place.is_array())
            place.push_back(one_of(others));
      }
      const auto violation = scenes::find_violation(schema, document, "f");
      const bool accepts = library.accepts(document);
      EXPECT_EQ(!violation.has_value(), accepts) << violation.value_or("accepted") << ": " << document.dump();
      ++(accepts ? accepted : refused);
    }
  }
  EXPECT_GT(accepted, 500);
  EXPECT_GT(refused, 1500);
}

/// Every object with properties in the schema refuses other keys.
TEST(JsonSchema, NoObjectTakesUnknownKeys) {
  const auto schema = nlohmann::json::parse(scenes::kSceneSchemaText);
  int objects = 0;
  const auto visit = [&](const auto& self, const nlohmann::json& node) -> void {
    if (node.is_object() && node.value("type", nlohmann::json()) == "object" && node.contains("properties")) {
      EXPECT_EQ(node.value("additionalProperties", nlohmann::json()), false) << node.dump();
      ++objects;
    }
    if (node.is_structured()) {
      for (const auto& child : node) self(self, child);
    }
  };
  visit(visit, schema);
  EXPECT_GT(objects, 20);
}

}  // namespace
}  // namespace penumbra::test
