// SPDX-License-Identifier: Apache-2.0
// Animations of glTF 2.0: section 3.11 and appendix C (interpolation).

#include "import/gltf/gltf_animation.hpp"

#include "base/error.hpp"
#include "import/gltf/gltf_accessor.hpp"

#include <tiny_gltf.h>

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace penumbra::import {
namespace {

enum class Interpolation { linear, step, cubic };

/// The property that a channel animates, with its keys.
struct Channel {
  std::string place;
  bool rotates = false;
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times;   ///< ascending, or equal at a jump
  std::vector<double> values;  ///< `width` numbers for each key; cubic: in-tangent, value and out-tangent for each key
  std::size_t width = 0;
};

template <typename Element>
const Element& element(const std::vector<Element>& all, int number, const std::string& place, const char* what) {
  if (number < 0 || static_cast<std::size_t>(number) >= all.size())
    throw InputError("{}: {} {} does not exist; there are {}", place, what, number, all.size());
  return all[static_cast<std::size_t>(number)];
}

Interpolation interpolation_of(const std::string& name, const std::string& place) {
  if (name.empty() || name == "LINEAR") return Interpolation::linear;
  if (name == "STEP") return Interpolation::step;
  if (name == "CUBICSPLINE") return Interpolation::cubic;
  throw InputError("{}/interpolation: \"{}\"; expected LINEAR, STEP or CUBICSPLINE", place, name);
}

std::vector<double> key_times(const tinygltf::Model& model, int accessor, const std::string& place) {
  std::vector<double> times = read_numbers(model, accessor, {TINYGLTF_TYPE_SCALAR}, "key times").values;
  if (times.empty()) throw InputError("{}/input: there are no keys", place);
  for (std::size_t i = 1; i < times.size(); ++i) {
    // Two keys at the same time are a jump: the later one holds from then on.
    if (times[i] < times[i - 1])
      throw InputError("{}/input: key {} at {} s is before the one at {} s; times must ascend", place, i, times[i],
                       times[i - 1]);
  }
  return times;
}

/// Returns the number of values that a channel of this path has for its node; 0 if glTF 2.0 has no such path.
std::size_t width_of(const tinygltf::Model& model, const tinygltf::Node& node, const std::string& path) {
  if (path == "translation" || path == "scale") return 3;
  if (path == "rotation") return 4;
  if (path != "weights" || node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= model.meshes.size()) return 0;
  std::size_t targets = 0;
  for (const tinygltf::Primitive& primitive : model.meshes[static_cast<std::size_t>(node.mesh)].primitives)
    targets = std::max(targets, primitive.targets.size());
  return targets;
}

Channel read_channel(const tinygltf::Model& model, const tinygltf::AnimationSampler& sampler, std::string place,
                     std::size_t width, bool rotates) {
  Channel channel;
  channel.place = std::move(place);
  channel.rotates = rotates;
  channel.width = width;
  channel.interpolation = interpolation_of(sampler.interpolation, channel.place);
  channel.times = key_times(model, sampler.input, channel.place);
  channel.values =
      read_numbers(model, sampler.output, {TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}, "key values")
          .values;
  const std::size_t wanted = channel.times.size() * width * (channel.interpolation == Interpolation::cubic ? 3 : 1);
  if (channel.values.size() != wanted) {
    throw InputError("{}/output: {} numbers for {} keys; expected {}", channel.place, channel.values.size(),
                     channel.times.size(), wanted);
  }
  const bool cubic = channel.interpolation == Interpolation::cubic;
  for (std::size_t key = 0; rotates && key < channel.times.size(); ++key) {
    const auto value = std::span(channel.values).subspan((cubic ? 3 * key + 1 : key) * width, width);
    if (std::ranges::all_of(value, [](double x) { return x == 0; }))
      throw InputError("{}/output: key {} is a quaternion of length 0", channel.place, key);
  }
  return channel;
}

/// Interpolates spherically along the shorter arc.
std::vector<double> between_rotations(std::span<const double> a, std::span<const double> b, double share) {
  const auto quaternion = [](std::span<const double> q) { return glm::normalize(glm::dquat(q[3], q[0], q[1], q[2])); };
  const glm::dquat turned = glm::slerp(quaternion(a), quaternion(b), share);
  return {turned.x, turned.y, turned.z, turned.w};
}

std::vector<double> value_at(const Channel& channel, double seconds) {
  const bool cubic = channel.interpolation == Interpolation::cubic;
  const std::size_t stride = channel.width * (cubic ? 3 : 1);
  const auto numbers = [&](std::size_t key, std::size_t part) {
    return std::span(channel.values).subspan(key * stride + part * channel.width, channel.width);
  };
  const std::size_t middle = cubic ? 1 : 0;
  const auto copy = [&](std::size_t key) {
    const auto value = numbers(key, middle);
    return std::vector<double>(value.begin(), value.end());
  };
  const auto after = std::ranges::upper_bound(channel.times, seconds);
  if (after == channel.times.begin()) return copy(0);
  if (after == channel.times.end()) return copy(channel.times.size() - 1);
  const auto next = static_cast<std::size_t>(after - channel.times.begin()), key = next - 1;
  if (channel.interpolation == Interpolation::step) return copy(key);
  const double length = channel.times[next] - channel.times[key], t = (seconds - channel.times[key]) / length;
  const std::span<const double> a = numbers(key, middle), b = numbers(next, middle);
  if (!cubic && channel.rotates) return between_rotations(a, b, t);
  std::vector<double> value(channel.width);
  for (std::size_t i = 0; i < channel.width; ++i) {
    if (!cubic) {
      value[i] = (1 - t) * a[i] + t * b[i];
      continue;
    }
    const double out = length * numbers(key, 2)[i], in = length * numbers(next, 0)[i], t2 = t * t, t3 = t2 * t;
    value[i] = (2 * t3 - 3 * t2 + 1) * a[i] + (t3 - 2 * t2 + t) * out + (3 * t2 - 2 * t3) * b[i] + (t3 - t2) * in;
  }
  return value;
}

}  // namespace

std::optional<scenes::Motion> motion_of(const tinygltf::Model& model, const std::vector<std::size_t>& played) {
  std::optional<scenes::Motion> motion;
  for (const std::size_t a : played) {
    const tinygltf::Animation& animation = model.animations[a];
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      const std::string place = fmt::format("/animations/{}/samplers/{}", a, channel.sampler);
      const auto& sampler = element(animation.samplers, channel.sampler, place, "sampler");
      const std::vector<double> times = key_times(model, sampler.input, place);
      if (!motion) motion = scenes::Motion{times.front(), times.back()};
      motion = scenes::Motion{std::min(motion->first, times.front()), std::max(motion->last, times.back())};
    }
  }
  return motion;
}

void pose_model(tinygltf::Model& model, double seconds, const std::vector<std::size_t>& played) {
  for (const std::size_t a : played) {
    const tinygltf::Animation& animation = model.animations[a];
    for (std::size_t c = 0; c < animation.channels.size(); ++c) {
      const tinygltf::AnimationChannel& source = animation.channels[c];
      const std::string target = fmt::format("/animations/{}/channels/{}/target", a, c);
      element(model.nodes, source.target_node, target, "node");
      tinygltf::Node& node = model.nodes[static_cast<std::size_t>(source.target_node)];
      const std::size_t width = width_of(model, node, source.target_path);
      if (width == 0) {
        throw InputError(
            "{}/path: \"{}\" of node {} cannot be moved; expected translation, rotation, scale, or weights "
            "of a mesh with morph targets",
            target, source.target_path, source.target_node);
      }
      if (!node.matrix.empty())
        throw InputError("{}: node {} has a matrix; an animated node must have translation, rotation and scale", target,
                         source.target_node);
      const std::string place = fmt::format("/animations/{}/samplers/{}", a, source.sampler);
      const Channel channel = read_channel(model, element(animation.samplers, source.sampler, place, "sampler"), place,
                                           width, source.target_path == "rotation");
      std::vector<double> value = value_at(channel, seconds);
      (source.target_path == "translation" ? node.translation
       : channel.rotates                   ? node.rotation
       : source.target_path == "scale"     ? node.scale
                                           : node.weights) = std::move(value);
    }
  }
}

}  // namespace penumbra::import
