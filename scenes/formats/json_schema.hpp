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

/// The first place, in the document's order, where `instance` departs from the schema, in words for people. Knows the
/// keywords that our schema uses; whether a document is valid is decided by the JSON Schema library, not here.
std::optional<std::string> explain_violation(const nlohmann::json& schema, const nlohmann::json& instance,
                                             const std::string& file);

}  // namespace penumbra::scenes
