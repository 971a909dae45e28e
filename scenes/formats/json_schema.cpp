#include "scenes/formats/json_schema.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

/// The only file that sees valijson: its templates take long to compile.
namespace penumbra::scenes {
namespace {

using nlohmann::json;

/// The library's own words, for what explain_violation has none for. Its context is a list such as "<root>",
/// "[meshes]", "[0]"; its last error is the outermost, so the first says most.
std::string librarys_words(valijson::ValidationResults& results, const std::string& file) {
  valijson::ValidationResults::Error error;
  if (!results.popError(error)) return file + ": does not fit the schema";
  std::string pointer;
  for (const std::string& part : error.context) {
    if (part.size() > 2 && part.front() == '[') pointer += "/" + part.substr(1, part.size() - 2);
  }
  return fmt::format("{}: {}: {}", file, pointer, error.description);
}

bool is_triangle_list(const json& list) {
  return list.is_array() && !list.empty() && std::all_of(list.begin(), list.end(), [](const json& triangle) {
           return triangle.is_array() && triangle.size() == 9 &&
                  std::all_of(triangle.begin(), triangle.end(), [](const json& value) { return value.is_number(); });
         });
}

/// Sets long lists of triangles aside while the rest is validated: a general validator takes a microsecond a number,
/// and a scene may have millions. Only lists that are what the schema demands of "triangles" are set aside; of each,
/// one triangle stays. Everything is back when this goes.
class ShelvedTriangles {
 public:
  explicit ShelvedTriangles(json& document) {
    if (!document.is_object() || !document.contains("meshes") || !document["meshes"].is_array()) return;
    for (json& mesh : document["meshes"]) {
      if (!mesh.is_object() || !mesh.contains("triangles") || !is_triangle_list(mesh["triangles"])) continue;
      json& list = mesh["triangles"];
      json one = json::array({list[0]});
      shelf_.emplace_back(&list, std::exchange(list, std::move(one)));
    }
  }
  ShelvedTriangles(const ShelvedTriangles&) = delete;
  ShelvedTriangles& operator=(const ShelvedTriangles&) = delete;
  ~ShelvedTriangles() {
    for (auto& [place, list] : shelf_) *place = std::move(list);
  }

 private:
  std::vector<std::pair<json*, json>> shelf_;
};

}  // namespace

void enforce_schema(json& document, const std::string& file) {
  const ShelvedTriangles shelved(document);
  using Adapter = valijson::adapters::NlohmannJsonAdapter;
  const json schema_json = json::parse(kSceneSchemaText);
  valijson::Schema schema;
  valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(Adapter(schema_json), schema);

  valijson::Validator validator(valijson::Validator::kStrongTypes);
  if (validator.validate(schema, Adapter(document), nullptr)) return;
  // Slower, and only for the message: the same again with a list of what is wrong.
  if (const auto words = explain_violation(schema_json, document, file)) throw InputError("{}", *words);
  valijson::ValidationResults results;
  validator.validate(schema, Adapter(document), &results);
  throw InputError("{}", librarys_words(results, file));
}

}  // namespace penumbra::scenes
