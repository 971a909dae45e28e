// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace penumbra::scenes {

/// Returns unused names: the wanted one, or the wanted one followed by ".2", ".3" ….
class UniqueNames {
 public:
  std::string take(const std::string& wanted) {
    std::string name = wanted;
    // A file may have a hundred thousand equal names: the search continues where the last one ended.
    for (std::uint64_t& next = last_.try_emplace(wanted, 1).first->second; !taken_.insert(name).second;)
      name = wanted + "." + std::to_string(++next);
    return name;
  }

 private:
  std::set<std::string> taken_;
  std::map<std::string, std::uint64_t> last_;  ///< the last number tried, by wanted name
};

}  // namespace penumbra::scenes
