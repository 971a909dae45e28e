#pragma once

#include "scenes/formats/json_document.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <string_view>

/// The schema of penumbra-scene/1. Internal to scenes/.
namespace penumbra::scenes {

/// scenes/penumbra-scene.schema.json, as it was when the program was built.
extern const std::string_view kSceneSchemaText;

/// InputError for the first thing in the document that the schema forbids: where, what is there, what is expected.
/// The document is the same afterwards.
void enforce_schema(nlohmann::json& document, const std::string& file);

/// The first place, in the document's order, where `instance` departs from the schema, in words for people; nothing for
/// a document that is valid. Knows the keywords of JSON Schema that our schema uses, in the forms in which it uses
/// them; a test holds its verdicts against a JSON Schema library's.
std::optional<std::string> find_violation(const nlohmann::json& schema, const nlohmann::json& instance,
                                          const std::string& file);

}  // namespace penumbra::scenes
