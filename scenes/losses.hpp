// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <unordered_set>
#include <vector>

namespace penumbra::scenes {

/// Properties of a file that the scene will lack, or of a scene that a file will lack, with the names of the affected
/// objects.
class Losses {
 public:
  /// Adds a loss that changes or removes a shadow: refused unless the user chose lenient reading. `what` follows the
  /// names in the message.
  void refuse(const std::string& what, const std::string& object) { add(refused_, what, object); }
  /// Adds a loss that changes the appearance of a surface.
  void mention(const std::string& what, const std::string& object) { add(mentioned_, what, object); }

  /// Adds warnings of refused losses only, for callers that do not use appearances.
  void warn_of_refused(std::vector<std::string>& warnings) const;

  /// Throws InputError with all refused losses, if there are any. `lenient`: verb for what the command does with
  /// --lenient despite the losses.
  void throw_refused(const char* lenient = "renders") const;
  /// Inserts warnings of all losses before existing ones, more important losses first.
  void warn(std::vector<std::string>& warnings) const;

 private:
  struct Loss {
    std::string what;
    std::vector<std::string> objects;         ///< each once, in order of occurrence
    std::unordered_set<std::string> known{};  ///< the same names, for look-up: a file may lose a hundred thousand
  };
  static void add(std::vector<Loss>& losses, const std::string& what, const std::string& object);
  static std::string text_of(const Loss& loss);

  std::vector<Loss> refused_, mentioned_;
};

}  // namespace penumbra::scenes
