#include "import/text.hpp"

#include <cctype>

namespace penumbra::mesh {

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

namespace {

bool is_blank(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

}  // namespace

// Plain loops: find_first_of is several times slower, which shows in files of a hundred megabytes.
bool take_line(std::string_view& text, std::string_view& line) {
  if (text.empty()) return false;
  std::size_t end = 0;
  while (end < text.size() && text[end] != '\n' && text[end] != '\r') ++end;
  line = text.substr(0, end);
  text.remove_prefix(end == text.size() ? end : end + (text.substr(end).starts_with("\r\n") ? 2 : 1));
  return true;
}

std::string_view take_word(std::string_view& line) {
  std::size_t first = 0;
  while (first < line.size() && is_blank(line[first])) ++first;
  std::size_t end = first;
  while (end < line.size() && !is_blank(line[end])) ++end;
  const std::string_view word = line.substr(first, end - first);
  line.remove_prefix(end);
  return word;
}

}  // namespace penumbra::mesh
