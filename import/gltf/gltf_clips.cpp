// SPDX-License-Identifier: Apache-2.0
// Chooses the animations that the caller names. Without names, chooses in the file's order each animation that moves no
// property which an already chosen one moves.

#include "import/gltf/gltf_clips.hpp"

#include "base/error.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <charconv>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>

namespace penumbra::import {
namespace {

using Moved = std::set<std::pair<int, std::string>>;

Moved moved_by(const tinygltf::Animation& animation) {
  Moved moved;
  for (const tinygltf::AnimationChannel& channel : animation.channels)
    moved.emplace(channel.target_node, channel.target_path);
  return moved;
}

std::optional<std::size_t> find_clip(const tinygltf::Model& model, const std::string& wanted) {
  const auto& all = model.animations;
  const auto named = std::ranges::find(all, wanted, &tinygltf::Animation::name);
  if (named != all.end()) return static_cast<std::size_t>(named - all.begin());
  std::size_t number = 0;
  const char* const end = wanted.data() + wanted.size();
  const auto read = std::from_chars(wanted.data(), end, number);
  if (read.ec != std::errc() || read.ptr != end || number >= all.size()) return std::nullopt;
  return number;
}

}  // namespace

std::vector<std::size_t> all_clips(const tinygltf::Model& model) {
  std::vector<std::size_t> all(model.animations.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

ClipChoice choose_clips(const tinygltf::Model& model, const std::vector<std::string>& wanted) {
  ClipChoice choice;
  for (const std::string& name : wanted) {
    const auto clip = find_clip(model, name);
    if (!clip) {
      throw InputError("there is no animation clip \"{}\"; there {}", name,
                       model.animations.empty() ? "are none" : "are " + names_of_clips(model, all_clips(model)));
    }
    choice.played.push_back(*clip);
  }
  std::ranges::sort(choice.played);
  choice.played.erase(std::unique(choice.played.begin(), choice.played.end()), choice.played.end());
  if (!wanted.empty()) return choice;
  Moved moved;
  for (const std::size_t clip : all_clips(model)) {
    Moved own = moved_by(model.animations[clip]);
    const bool free = std::ranges::none_of(own, [&](const auto& target) { return moved.contains(target); });
    (free ? choice.played : choice.others).push_back(clip);
    if (free) moved.merge(own);
  }
  return choice;
}

std::string names_of_clips(const tinygltf::Model& model, const std::vector<std::size_t>& clips) {
  constexpr std::size_t kMost = 24;
  std::string names;
  for (const std::size_t clip : std::span(clips).first(std::min(kMost, clips.size()))) {
    const std::string& name = model.animations[clip].name;
    names += fmt::format("{}{}{}", names.empty() ? "" : ", ", clip, name.empty() ? "" : " '" + name + "'");
  }
  if (clips.size() > kMost) names += fmt::format(" and {} more", clips.size() - kMost);
  return names;
}

}  // namespace penumbra::import
