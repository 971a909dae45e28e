// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/losses.hpp"
#include "scenes/scene.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
struct Material;
struct Primitive;
struct TextureInfo;
}  // namespace tinygltf

namespace penumbra::import {

/// Appearance of a primitive, from its material and vertices.
struct Look {
  glm::dvec3 color{1};     ///< linear base colour
  glm::dvec3 radiance{0};  ///< emitted radiance
  bool two_sided = false;
  std::string material;  ///< name of the material
  std::optional<scenes::PictureUse> picture = {};
  std::optional<scenes::PictureUse> emission = {};  ///< picture that multiplies the radiance
  scenes::Alpha alpha = {};
  /// Attributes of the primitive's vertices; empty: none.
  std::vector<glm::dvec3> normals = {};  ///< in the coordinates in which the primitive was modelled
  std::vector<glm::vec4> colors = {};
  std::vector<glm::dvec2> places = {};           ///< coordinates in its picture
  std::vector<glm::dvec2> emission_places = {};  ///< coordinates in the picture of its emission
  std::vector<glm::dvec2> lightmap = {};         ///< coordinates in a lightmap
};

/// Effect of the alpha of a whole surface on light: lets all of it pass (`gone`), none (`solid`), or neither.
enum class Opacity { solid, gone, neither };

/// Reads materials, textures and attributes of vertices. Surfaces are diffuse here: other properties are added to the
/// losses, under the objects' names.
class SurfaceReader {
 public:
  /// All arguments must outlive this object. Pictures are added to `pictures` when they are used.
  SurfaceReader(const tinygltf::Model& model, std::vector<scenes::Picture>& pictures, scenes::Losses& losses)
      : model_(model), pictures_(pictures), losses_(losses) {}

  /// `place` and `object` identify the primitive in messages; `vertices` is its number of vertices. Throws InputError.
  Look read(const tinygltf::Primitive& primitive, const std::string& place, const std::string& object,
            std::size_t vertices);

  /// Makes later calls read Look::lightmap from TEXCOORD_N with N = `set`, regardless of the pictures.
  void read_lightmap(std::uint32_t set) { lightmap_ = set; }

  Opacity opacity_of(const Look& look);

 private:
  /// The smallest and the largest alpha that may occur.
  struct AlphaRange {
    double least = 1, greatest = 1;
  };
  AlphaRange alpha_range(const Look& look);
  /// The primitive whose surface is read.
  struct Owner {
    const tinygltf::Primitive& primitive;
    const std::string &place, &object;
    std::size_t vertices;
  };
  void read_material(const Owner& owner, Look& look);
  void read_lightmap_places(const Owner& owner, Look& look);
  void read_emission(const Owner& owner, const std::string& place, Look& look);
  /// Reports properties of the material that a diffuse surface does not show.
  void mention_unlike(const Owner& owner, const std::string& place, const Look& look);
  /// Returns the picture coordinates of each vertex. `decides`: the picture affects light, so that losses are refused.
  std::vector<glm::dvec2> places_of(const Owner& owner, const tinygltf::TextureInfo& info, bool decides);
  std::optional<scenes::PictureUse> picture_use(int texture, const std::string& place, std::string& why_not);
  std::optional<std::uint32_t> picture_of(int texture, const std::string& place, std::string& why_not);

  const tinygltf::Model& model_;
  std::vector<scenes::Picture>& pictures_;
  scenes::Losses& losses_;
  std::optional<std::uint32_t> lightmap_;
  std::map<int, std::optional<std::uint32_t>> known_;  // index of each image's picture
  std::map<int, std::string> unreadable_;
  std::map<std::uint32_t, AlphaRange> ranges_;  // for each picture; kept, because thousands of leaves share one
};

}  // namespace penumbra::import
