#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace penumbra::scenes {

/// Gives names that nobody has yet: the wanted one, or with ".2", ".3" … behind it.
class UniqueNames {
 public:
  std::string take(const std::string& wanted) {
    std::string name = wanted;
    // A file may have a hundred thousand of one name: the search goes on where it ended.
    for (std::uint64_t& next = last_.try_emplace(wanted, 1).first->second; !taken_.insert(name).second;)
      name = wanted + "." + std::to_string(++next);
    return name;
  }

 private:
  std::set<std::string> taken_;
  std::map<std::string, std::uint64_t> last_;  ///< the number tried last, by wanted name
};

}  // namespace penumbra::scenes
