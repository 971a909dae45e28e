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

namespace penumbra::scenes {

/// What a primitive's material and vertices say of how it looks.
struct Look {
  glm::dvec3 color{1};     ///< linear base colour
  glm::dvec3 radiance{0};  ///< what it emits
  bool two_sided = false;
  std::string material;  ///< its name
  std::optional<PictureUse> picture = {};
  std::optional<PictureUse> emission = {};  ///< a picture that multiplies its radiance
  Alpha alpha = {};
  /// Of the primitive's vertices; empty: none.
  std::vector<glm::dvec3> normals = {};  ///< where it was modelled
  std::vector<glm::vec4> colors = {};
  std::vector<glm::dvec2> places = {};           ///< in its picture
  std::vector<glm::dvec2> emission_places = {};  ///< in the picture of its emission
  std::vector<glm::dvec2> lightmap = {};         ///< in a lightmap
};

/// What its alpha makes of a whole surface: nothing stops light (`gone`), everything does, or neither.
enum class Opacity { solid, gone, neither };

/// Reads materials, textures and vertices' attributes. Surfaces are diffuse here: what else glTF says of them goes to
/// the losses, under the objects' names.
class SurfaceReader {
 public:
  /// All must outlive it. Pictures are added to `pictures` as they are used.
  SurfaceReader(const tinygltf::Model& model, std::vector<Picture>& pictures, Losses& losses)
      : model_(model), pictures_(pictures), losses_(losses) {}

  /// `place` and `object`: the primitive's, for messages; `vertices`: how many it has. Throws InputError.
  Look read(const tinygltf::Primitive& primitive, const std::string& place, const std::string& object,
            std::size_t vertices);

  /// From now on Look::lightmap is TEXCOORD_N, whatever pictures are there.
  void read_lightmap(std::uint32_t set) { lightmap_ = set; }

  Opacity opacity_of(const Look& look);

 private:
  /// The least and the greatest alpha that may be anywhere.
  struct AlphaRange {
    double least = 1, greatest = 1;
  };
  AlphaRange alpha_range(const Look& look);
  /// Whose surface is read.
  struct Owner {
    const tinygltf::Primitive& primitive;
    const std::string &place, &object;
    std::size_t vertices;
  };
  void read_material(const Owner& owner, Look& look);
  void read_lightmap_places(const Owner& owner, Look& look);
  void read_emission(const Owner& owner, const std::string& place, Look& look);
  /// What of the material a diffuse surface does not show.
  void mention_unlike(const Owner& owner, const std::string& place, const Look& look);
  /// Where the picture lies at each vertex. `decides`: of light, so that what is lost is refused.
  std::vector<glm::dvec2> places_of(const Owner& owner, const tinygltf::TextureInfo& info, bool decides);
  std::optional<PictureUse> picture_use(int texture, const std::string& place, std::string& why_not);
  std::optional<std::uint32_t> picture_of(int texture, const std::string& place, std::string& why_not);

  const tinygltf::Model& model_;
  std::vector<Picture>& pictures_;
  Losses& losses_;
  std::optional<std::uint32_t> lightmap_;
  std::map<int, std::optional<std::uint32_t>> known_;  // of images
  std::map<int, std::string> unreadable_;
  std::map<std::uint32_t, AlphaRange> ranges_;  // of pictures: leaves share one by the thousand
};

}  // namespace penumbra::scenes
