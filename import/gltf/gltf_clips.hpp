#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

namespace penumbra::scenes {

/// Which of the model's animations are played.
struct ClipChoice {
  std::vector<std::size_t> played;  ///< ascending numbers
  /// Animations that are not, since each moves something that one of `played` moves, too: other clips of one object.
  std::vector<std::size_t> others;
};

/// Without `wanted` all animations that can be played at once: exporters write one for each object that moves. Of those
/// that move the same property of the same node, which are clips of one object, the first in the file. With `wanted`,
/// names or else numbers (the first is 0), those and no others. Throws InputError with all names for a clip that does
/// not exist.
ClipChoice choose_clips(const tinygltf::Model& model, const std::vector<std::string>& wanted);

/// The numbers of all of the model's animations.
std::vector<std::size_t> all_clips(const tinygltf::Model& model);

/// "0 'Walk', 1 'Run'": numbers and names of these animations.
std::string names_of_clips(const tinygltf::Model& model, const std::vector<std::size_t>& clips);

}  // namespace penumbra::scenes
