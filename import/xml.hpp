// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"
#include "mesh/triangle_soup.hpp"

#include <pugixml.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::import {

/// An XML text with places for messages; used by the AMF, 3MF and X3D readers. Internal to this room. pugixml expands
/// no entities that a file defines and opens no files.
class XmlText {
 public:
  /// Throws InputError with the line of the first syntax error. `text` must outlive this object.
  XmlText(std::string_view text, std::string file);

  [[nodiscard]] const pugi::xml_document& document() const { return document_; }
  [[nodiscard]] const std::string& file() const { return file_; }

  /// Throws InputError with the file, the line of `node`, and the message.
  template <typename... Args>
  [[noreturn]] void fail(const pugi::xml_node& node, fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError("{}: line {}: {}", file_, line_of(node.offset_debug()),
                     fmt::format(format, std::forward<Args>(args)...));
  }

  /// Parses the number in `text`, which belongs to `node`; `what` names it in messages. The number may be infinite or
  /// NaN, which is an error only if a face uses the vertex.
  [[nodiscard]] double coordinate(const pugi::xml_node& node, const char* text, std::string_view what) const;
  /// Parses a finite number.
  [[nodiscard]] double real(const pugi::xml_node& node, const char* text, std::string_view what) const;
  /// Parses the index of one of `count` elements, from 0.
  [[nodiscard]] std::uint32_t index(const pugi::xml_node& node, const char* text, std::size_t count) const;

 private:
  [[nodiscard]] std::size_t line_of(std::ptrdiff_t offset) const;

  std::string_view text_;
  std::string file_;
  pugi::xml_document document_;
};

/// Returns the element's name without its namespace prefix.
std::string_view local_name(const pugi::xml_node& node);

/// Returns the children of that name, regardless of their prefixes.
std::vector<pugi::xml_node> children_named(const pugi::xml_node& node, std::string_view name);

/// Adds a note about the unit of a file for printers, which is not applied to its positions, unless it is a millimetre.
void note_print_unit(const pugi::xml_node& root, std::vector<std::string>& notes);

/// Returns the attribute of that name, regardless of its prefix.
pugi::xml_attribute attribute_named(const pugi::xml_node& node, std::string_view name);

}  // namespace penumbra::import
