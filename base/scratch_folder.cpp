// SPDX-License-Identifier: Apache-2.0
// A separate hidden folder below another one; the destructor removes it with its content.

#include "base/scratch_folder.hpp"

#include "base/error.hpp"

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

namespace penumbra {

ScratchFolder::ScratchFolder(const std::filesystem::path& parent) {
  std::string name = (parent / ".penumbra-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw ResourceError("cannot write in \"{}\": {}", parent.string(), std::generic_category().message(errno));
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace penumbra
