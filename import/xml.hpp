#pragma once

#include "base/error.hpp"
#include "mesh/triangle_soup.hpp"

#include <pugixml.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::mesh {

/// An XML text with places for messages; what the AMF and 3MF readers stand on. Internal to this room. pugixml expands
/// no entities that a file defines and opens no files.
class XmlText {
 public:
  /// Throws InputError with the line of the first syntax error. `text` must outlive this.
  XmlText(std::string_view text, std::string file);

  [[nodiscard]] const pugi::xml_document& document() const { return document_; }
  [[nodiscard]] const std::string& file() const { return file_; }

  /// InputError: the file, the line of `node`, and the message.
  template <typename... Args>
  [[noreturn]] void fail(const pugi::xml_node& node, fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError("{}: line {}: {}", file_, line_of(node.offset_debug()),
                     fmt::format(format, std::forward<Args>(args)...));
  }

  /// The number in `text`, which belongs to `node` and is its `what`; one that is not finite is no matter in a vertex
  /// that no face uses.
  [[nodiscard]] double coordinate(const pugi::xml_node& node, const char* text, std::string_view what) const;
  /// The same, finite.
  [[nodiscard]] double real(const pugi::xml_node& node, const char* text, std::string_view what) const;
  /// The number of one of `count` things, from 0.
  [[nodiscard]] std::uint32_t index(const pugi::xml_node& node, const char* text, std::size_t count) const;

 private:
  [[nodiscard]] std::size_t line_of(std::ptrdiff_t offset) const;

  std::string_view text_;
  std::string file_;
  pugi::xml_document document_;
};

/// The element's name without its namespace's prefix.
std::string_view local_name(const pugi::xml_node& node);

/// The children of that name, whatever their prefix.
std::vector<pugi::xml_node> children_named(const pugi::xml_node& node, std::string_view name);

/// A file for printers has a unit, which is kept out of its positions: a note says so, once, where it is no millimetre.
void note_print_unit(const pugi::xml_node& root, std::vector<std::string>& notes);

/// The attribute of that name, whatever its prefix.
pugi::xml_attribute attribute_named(const pugi::xml_node& node, std::string_view name);

}  // namespace penumbra::mesh
