// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

namespace penumbra::import {

/// Selection of the model's animations.
struct ClipChoice {
  std::vector<std::size_t> played;  ///< ascending indices
  /// Animations that are not played because each moves a property that one of `played` moves, too: other clips of one
  /// object.
  std::vector<std::size_t> others;
};

/// Chooses animations. Without `wanted`: all animations that can be played together, since exporters write one for each
/// moving object; of those that move the same property of the same node, which are clips of one object, the first in
/// the file. With `wanted`: exactly those, by name or else by index (from 0). Throws InputError with all names for a
/// clip that does not exist.
ClipChoice choose_clips(const tinygltf::Model& model, const std::vector<std::string>& wanted);

/// Returns the indices of all animations of the model.
std::vector<std::size_t> all_clips(const tinygltf::Model& model);

/// Returns "0 'Walk', 1 'Run'": indices and names of these animations.
std::string names_of_clips(const tinygltf::Model& model, const std::vector<std::size_t>& clips);

}  // namespace penumbra::import
