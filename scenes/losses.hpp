#pragma once

#include <cstddef>
#include <string>
#include <unordered_set>
#include <vector>

namespace penumbra::scenes {

/// What a file has and the scene will not, or the other way round, with the names of the objects that it is about.
class Losses {
 public:
  /// It changes a shadow, or takes one away: refused unless the user is lenient. `what` follows the names.
  void refuse(const std::string& what, const std::string& object) { add(refused_, what, object); }
  /// It changes how a surface looks.
  void mention(const std::string& what, const std::string& object) { add(mentioned_, what, object); }

  /// Warnings of what is refused elsewhere, alone: how a surface looks is nobody's concern here.
  void warn_of_refused(std::vector<std::string>& warnings) const;

  /// Throws InputError with all that is refused, if anything is. `lenient`: what the command does all the same if
  /// asked.
  void throw_refused(const char* lenient = "renders") const;
  /// Warnings of everything, before those that are there. What matters more comes first.
  void warn(std::vector<std::string>& warnings) const;

 private:
  struct Loss {
    std::string what;
    std::vector<std::string> objects;         ///< each once, in the order in which they came
    std::unordered_set<std::string> known{};  ///< the same: a file may lose a hundred thousand
  };
  static void add(std::vector<Loss>& losses, const std::string& what, const std::string& object);
  static std::string text_of(const Loss& loss);

  std::vector<Loss> refused_, mentioned_;
};

}  // namespace penumbra::scenes
