// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/formats/json_document.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <string_view>

/// The schema of penumbra-scene/1. Internal to scenes/.
namespace penumbra::scenes {

/// Content of scenes/penumbra-scene.schema.json when the program was built.
extern const std::string_view kSceneSchemaText;

/// Throws InputError for the first violation of the schema in the document: its place, the value found, and the
/// expected value. The document is unchanged on return.
void enforce_schema(nlohmann::json& document, const std::string& file);

/// Returns the first place, in document order, where `instance` violates the schema, in words for people; nullopt for a
/// valid document. Supports the keywords of JSON Schema that this project's schema uses, in the forms in which it uses
/// them; a test compares its verdicts with those of a JSON Schema library.
std::optional<std::string> find_violation(const nlohmann::json& schema, const nlohmann::json& instance,
                                          const std::string& file);

}  // namespace penumbra::scenes
