// SPDX-License-Identifier: Apache-2.0
// Keeps the list of files opened by the import helper.

#include "mesh/opened_files.hpp"

#include <set>
#include <utility>

namespace penumbra::mesh {
namespace {

std::set<std::string>& all_opened() {
  static std::set<std::string> files;
  return files;
}

}  // namespace

void note_opened_file(std::string path) {
  all_opened().insert(std::move(path));
}

std::vector<std::string> opened_files() {
  return {all_opened().begin(), all_opened().end()};
}

}  // namespace penumbra::mesh
