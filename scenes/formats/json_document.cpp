// SPDX-License-Identifier: Apache-2.0
// Parses JSON into a document in which every message can name its place: a pointer for values, line and column for
// syntax. Duplicate keys, NUL characters and deep nesting are refused.

#include "scenes/formats/json_document.hpp"

#include "base/file_error.hpp"
#include "base/memory.hpp"
#include "mesh/import_wire.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

namespace penumbra::scenes {
namespace {

using nlohmann::json;

constexpr std::size_t kDeepestNesting = 64;

/// Returns "parse error at line 3, column 7: …" without the library's prefix "[json.exception.parse_error.101]".
std::string without_library_prefix(std::string message) {
  if (message.starts_with('[')) message.erase(0, std::min(message.size(), message.find("] ") + 2));
  constexpr std::string_view kNoise = "parse error at ";
  if (message.starts_with(kNoise)) message.erase(0, kNoise.size());
  return message;
}

/// Builds the document event by event, so that every error message can name its place.
class DocumentBuilder : public nlohmann::json_sax<json> {
 public:
  DocumentBuilder(json& root, const std::string& file) : root_(root), file_(file) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override {
    refuse_zero(value, "string", open_.size());
    return add(std::move(value));
  }
  bool binary(binary_t&) override { return false; }  // does not occur in JSON text

  bool start_object(std::size_t) override { return open(json::object()); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    refuse_zero(name, "key", open_.size() - 1);
    if (open_.back().container->contains(name)) {
      throw InputError("{}: the key \"{}\" occurs twice; remove one", place_under(open_.size() - 1).str(), name);
    }
    open_.back().key = std::move(name);
    return true;
  }

  bool parse_error(std::size_t, const std::string& token, const json::exception& error) override {
    if (error.id == 406) {
      throw InputError("{}: the number {} is beyond the range of double precision", place_under(open_.size()).str(),
                       token);
    }
    throw InputError("{}: {}", file_, mesh::printable(without_library_prefix(error.what())));
  }

 private:
  struct Open {
    json* container;
    std::string key;  ///< key of the next value in an object
  };

  /// Refuses zero bytes: no valid name contains one, and a file's name or a message would end there.
  void refuse_zero(const std::string& text, const char* what, std::size_t levels) const {
    if (text.find('\0') == std::string::npos) return;
    throw InputError("{}: the {} holds the character U+0000; expected printable text", place_under(levels).str(), what);
  }

  json* place_value(json value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    json& container = *open_.back().container;
    if (container.is_array()) return &container.emplace_back(std::move(value));
    return &(container[open_.back().key] = std::move(value));
  }

  bool add(json value) {
    place_value(std::move(value));
    return true;
  }

  bool open(json value) {
    if (open_.size() >= kDeepestNesting) {
      throw InputError("{}: nested more than {} deep; no scene is", place_under(open_.size()).str(), kDeepestNesting);
    }
    // A parent does not grow while its child is open, so the pointer holds until the child is closed.
    json* container = place_value(std::move(value));
    open_.push_back({container, {}});
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  /// Returns the place inside the outermost `levels` open containers. If these are all open containers, it is the place
  /// of the value that is about to be added; with one level less, it is the place of the innermost container.
  [[nodiscard]] Place place_under(std::size_t levels) const {
    Place place{file_, {}};
    for (std::size_t i = 0; i < levels; ++i) {
      const json& container = *open_[i].container;
      if (container.is_object()) {
        place = place / open_[i].key;
      } else {  // an open child is already stored in its parent
        place = place / (container.size() - (i + 1 < open_.size() ? 1 : 0));
      }
    }
    return place;
  }

  json& root_;
  const std::string& file_;
  std::vector<Open> open_;
};

}  // namespace

Place Place::operator/(std::string_view key) const {
  Place place{file, pointer + "/"};
  for (const char c : key) {  // RFC 6901, section 3
    if (c == '~') {
      place.pointer += "~0";
    } else if (c == '/') {
      place.pointer += "~1";
    } else {
      place.pointer += c;
    }
  }
  return place;
}

Place Place::operator/(std::size_t index) const {
  return {file, fmt::format("{}/{}", pointer, index)};
}

std::string Place::str() const {
  return pointer.empty() ? file : fmt::format("{}: {}", file, pointer);
}

json parse_json(std::string_view text, const std::string& file) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw InputError("{}: this is UTF-16; save it as UTF-8", file);
  json document;
  DocumentBuilder builder(document, file);
  json::sax_parse(text.begin(), text.end(), &builder);
  return document;
}

std::string read_text_file(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw InputError("{}: no such file", file.string());
  if (std::filesystem::is_directory(status)) throw InputError("{}: this is a folder; expected a file", file.string());
  // Reading a pipe or a device might never end.
  if (!std::filesystem::is_regular_file(status)) throw InputError("{}: not a regular file", file.string());
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw_file_error(errno, file.string() + ": cannot be read");
  const std::uintmax_t size = std::filesystem::file_size(file);
  // Memory for the text, for its values (a number of eight characters takes sixteen bytes), and for the objects made
  // from them.
  require_memory(3 * size, fmt::format("{}: a text of {}", file.string(), in_bytes(size)),
                 "name mesh files in place of listing triangles");
  std::string text(size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) throw InputError("{}: reading failed after {} bytes", file.string(), stream.gcount());
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

std::string describe_value(const json& value) {
  switch (value.type()) {
    case json::value_t::null:
      return "null";
    case json::value_t::boolean:
      return value.get<bool>() ? "true" : "false";
    case json::value_t::object:
      return "an object";
    case json::value_t::array:
      return fmt::format("an array of {} value{}", value.size(), value.size() == 1 ? "" : "s");
    case json::value_t::string: {
      constexpr std::size_t kLongest = 60;
      const std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
      return text.size() <= kLongest ? "a string " + text : fmt::format("a string of {} characters", text.size() - 2);
    }
    default:
      return "the number " + value.dump();
  }
}

}  // namespace penumbra::scenes
