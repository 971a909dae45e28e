// SPDX-License-Identifier: Apache-2.0
// Collects what a reader or writer cannot represent, each kind once with the names of its objects, and words it as an
// error or a warning.

#include "scenes/losses.hpp"

#include "base/error.hpp"

#include <algorithm>

namespace penumbra::scenes {

void Losses::add(std::vector<Loss>& losses, const std::string& what, const std::string& object) {
  auto loss = std::ranges::find(losses, what, &Loss::what);
  if (loss == losses.end()) loss = losses.insert(losses.end(), {.what = what, .objects = {}});
  if (loss->known.insert(object).second) loss->objects.push_back(object);
}

std::string Losses::text_of(const Loss& loss) {
  constexpr std::size_t kMost = 4;
  std::string names;
  for (std::size_t i = 0; i < std::min(loss.objects.size(), kMost); ++i)
    names += fmt::format("{}'{}'", i == 0 ? "" : ", ", loss.objects[i]);
  if (loss.objects.size() > kMost) names += fmt::format(" and {} more", loss.objects.size() - kMost);
  return names + " " + loss.what;
}

void Losses::warn_of_refused(std::vector<std::string>& warnings) const {
  for (const Loss& loss : refused_) warnings.push_back(text_of(loss));
}

void Losses::throw_refused(const char* lenient) const {
  if (refused_.empty()) return;
  std::string all;
  for (const Loss& loss : refused_) all += (all.empty() ? "" : "; ") + text_of(loss);
  throw InputError("{}. Shadows would be wrong: --lenient {} it nevertheless, with a warning", all, lenient);
}

void Losses::warn(std::vector<std::string>& warnings) const {
  std::vector<std::string> texts;
  warn_of_refused(texts);
  for (const Loss& loss : mentioned_) texts.push_back(text_of(loss));
  warnings.insert(warnings.begin(), texts.begin(), texts.end());
}

}  // namespace penumbra::scenes
