// SPDX-License-Identifier: Apache-2.0
// Elements, attributes and numbers of XML formats (AMF, 3MF), with line numbers in messages; prefixes of namespaces are
// ignored.

#include "import/xml.hpp"

#include "import/text.hpp"

#include <algorithm>
#include <cmath>

namespace penumbra::import {
namespace {

std::string_view without_prefix(std::string_view name) {
  return name.substr(name.find(':') + 1);  // npos + 1 is 0
}

}  // namespace

XmlText::XmlText(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {
  const pugi::xml_parse_result result = document_.load_buffer(text.data(), text.size());
  if (result.status == pugi::status_out_of_memory) throw std::bad_alloc();
  if (!result) throw InputError("{}: line {}: malformed XML: {}", file_, line_of(result.offset), result.description());
}

std::size_t XmlText::line_of(std::ptrdiff_t offset) const {
  const auto end = std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)), text_.size());
  return 1 + static_cast<std::size_t>(std::ranges::count(text_.substr(0, end), '\n'));
}

double XmlText::coordinate(const pugi::xml_node& node, const char* text, std::string_view what) const {
  std::string_view rest = text;
  const std::string_view word = take_word(rest);
  const auto value = parse_real(word);
  if (!value || !take_word(rest).empty()) fail(node, "{} is '{}'; expected a number", what, text);
  return *value;
}

double XmlText::real(const pugi::xml_node& node, const char* text, std::string_view what) const {
  const double value = coordinate(node, text, what);
  if (!std::isfinite(value)) fail(node, "{} is not finite: '{}'", what, text);
  return value;
}

std::uint32_t XmlText::index(const pugi::xml_node& node, const char* text, std::size_t count) const {
  std::string_view rest = text;
  const std::string_view word = take_word(rest);
  const auto value = parse_number<std::uint64_t>(word);
  if (!value || !take_word(rest).empty()) fail(node, "'{}' is not a vertex number", text);
  if (*value >= count) {
    fail(node, "the triangle names vertex {}, but there are only {} (numbered from 0)", *value, count);
  }
  return static_cast<std::uint32_t>(*value);
}

std::string_view local_name(const pugi::xml_node& node) {
  return without_prefix(node.name());
}

std::vector<pugi::xml_node> children_named(const pugi::xml_node& node, std::string_view name) {
  std::vector<pugi::xml_node> found;
  for (const pugi::xml_node& child : node.children()) {
    if (local_name(child) == name) found.push_back(child);
  }
  return found;
}

void note_print_unit(const pugi::xml_node& root, std::vector<std::string>& notes) {
  const std::string_view unit = root.attribute("unit").value();
  if (unit.empty() || unit == "millimeter") return;
  std::string note = fmt::format("the file's unit is '{}': positions keep the file's numbers", mesh::printable(unit));
  if (std::ranges::find(notes, note) == notes.end()) notes.push_back(std::move(note));
}

pugi::xml_attribute attribute_named(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_attribute& attribute : node.attributes()) {
    if (without_prefix(attribute.name()) == name) return attribute;
  }
  return {};
}

}  // namespace penumbra::import
