#pragma once

#include <string>

namespace penumbra::mesh {

/// The content of a file as its reader must see it: that of a text format without its byte order mark, and in UTF-8 if
/// the mark says UTF-16 or UTF-32; any other unchanged. `extension` in lower case. InputError if it is no such text.
std::string utf8_content(std::string content, const std::string& extension, const std::string& file);

}  // namespace penumbra::mesh
