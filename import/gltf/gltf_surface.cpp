// SPDX-License-Identifier: Apache-2.0
// Materials of glTF 2.0 (section 3.9) with KHR_materials_emissive_strength and KHR_texture_transform, reduced to
// diffuse surfaces.

#include "import/gltf/gltf_surface.hpp"

#include "base/error.hpp"
#include "mesh/import.hpp"
#include "base/image.hpp"
#include "base/jpeg.hpp"
#include "base/png.hpp"
#include "import/gltf/gltf_accessor.hpp"
#include "import/gltf/blender_exporter.hpp"

#include <tiny_gltf.h>

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

namespace penumbra::import {
namespace {

constexpr std::uint32_t kLargestPictureSide = 8192;

glm::dvec3 checked_factor(const std::vector<double>& numbers, glm::dvec3 otherwise, const std::string& place) {
  if (numbers.size() < 3) return otherwise;
  const glm::dvec3 factor(numbers[0], numbers[1], numbers[2]);
  for (glm::length_t i = 0; i < 3; ++i) {
    if (!std::isfinite(factor[i]) || factor[i] < 0)
      throw InputError("{}: {} is not a colour; expected 0 or more", place, factor[i]);
  }
  return factor;
}

/// Returns a number of an extension; `otherwise` if it has none.
double number_of(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key, double otherwise,
                 const std::string& place) {
  const auto found = extensions.find(extension);
  if (found == extensions.end() || !found->second.Has(key)) return otherwise;
  const tinygltf::Value& value = found->second.Get(key);
  const double number = value.IsNumber() ? value.GetNumberAsDouble() : -1;
  if (!std::isfinite(number) || number < 0)
    throw InputError("{}/extensions/{}/{}: expected a number of 0 or more", place, extension, key);
  return number;
}

/// The base colour and alpha of a surface.
struct BaseColor {
  std::vector<double> factor;
  tinygltf::TextureInfo texture;
  const char *factor_place, *texture_place;  ///< below the material
};

constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";

/// Returns the base colour; for a material of KHR_materials_pbrSpecularGlossiness, frequent in files before 2021, its
/// diffuse colour, which replaces the base colour.
BaseColor base_color_of(const tinygltf::Material& material) {
  const auto found = material.extensions.find(kSpecularGlossiness);
  if (found == material.extensions.end()) {
    const auto& core = material.pbrMetallicRoughness;
    return {core.baseColorFactor, core.baseColorTexture, "/pbrMetallicRoughness/baseColorFactor",
            "/pbrMetallicRoughness/baseColorTexture"};
  }
  BaseColor base{{},
                 {},
                 "/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor",
                 "/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture"};
  if (found->second.Has("diffuseFactor")) {
    const tinygltf::Value& factor = found->second.Get("diffuseFactor");
    for (int i = 0; factor.IsArray() && i < static_cast<int>(factor.ArrayLen()); ++i)
      base.factor.push_back(factor.Get(i).IsNumber() ? factor.Get(i).GetNumberAsDouble() : std::nan(""));
  }
  if (found->second.Has("diffuseTexture")) {
    const tinygltf::Value& texture = found->second.Get("diffuseTexture");
    const auto whole = [&](const char* key, int otherwise) {
      return texture.Has(key) && texture.Get(key).IsInt() ? texture.Get(key).GetNumberAsInt() : otherwise;
    };
    base.texture.index = whole("index", -1);
    base.texture.texCoord = whole("texCoord", 0);
    if (texture.Has("extensions") && texture.Get("extensions").Has("KHR_texture_transform"))
      base.texture.extensions["KHR_texture_transform"] = texture.Get("extensions").Get("KHR_texture_transform");
  }
  return base;
}

scenes::Alpha alpha_of(const tinygltf::Material& material, const BaseColor& base, const std::string& place) {
  scenes::Alpha alpha;
  if (material.alphaMode == "MASK") alpha.mode = scenes::Alpha::Mode::mask;
  if (material.alphaMode == "BLEND") alpha.mode = scenes::Alpha::Mode::blend;
  if (alpha.mode == scenes::Alpha::Mode::opaque && !material.alphaMode.empty() && material.alphaMode != "OPAQUE")
    throw InputError("{}/alphaMode: \"{}\"; expected OPAQUE, MASK or BLEND", place, material.alphaMode);
  alpha.factor = base.factor.size() >= 4 ? base.factor[3] : 1;
  alpha.cutoff = material.alphaCutoff;
  if (!(alpha.factor >= 0 && std::isfinite(alpha.factor)))
    throw InputError("{}{}: alpha {}; expected 0 to 1", place, base.factor_place, alpha.factor);
  alpha.factor = std::min(alpha.factor, 1.0);  // clamped like the parts of the colour
  if (!std::isfinite(alpha.cutoff) || alpha.cutoff < 0)
    throw InputError("{}/alphaCutoff: {}; expected a number of 0 or more", place, alpha.cutoff);
  return alpha;
}

scenes::PictureUse::Wrap wrap_of(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return scenes::PictureUse::Wrap::clamp;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? scenes::PictureUse::Wrap::mirror
                                                       : scenes::PictureUse::Wrap::repeat;
}

/// The transform of coordinates by KHR_texture_transform.
struct TextureTransform {
  glm::dvec2 offset{0}, scale{1};
  double rotation = 0;   ///< radians
  int coordinates = -1;  ///< its own set of coordinates; −1: none

  /// Scales, then rotates counter-clockwise about (0, 0) as the picture is seen, v down, then translates, as Blender's
  /// exporter and browsers do. (The extension's page gives the matrix by rows.)
  [[nodiscard]] glm::dvec2 operator()(const glm::dvec2& uv) const {
    const glm::dvec2 scaled = scale * uv;
    const double c = std::cos(rotation), s = std::sin(rotation);
    return offset + glm::dvec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x);
  }
};

TextureTransform transform_of(const tinygltf::TextureInfo& info) {
  TextureTransform transform;
  const auto found = info.extensions.find("KHR_texture_transform");
  if (found == info.extensions.end()) return transform;
  const tinygltf::Value& value = found->second;
  const auto pair = [&](const char* key, glm::dvec2 otherwise) {
    if (!value.Has(key) || value.Get(key).ArrayLen() < 2) return otherwise;
    const auto at = [&](int i) {
      return value.Get(key).Get(i).IsNumber() ? value.Get(key).Get(i).GetNumberAsDouble() : 0;
    };
    return glm::dvec2(at(0), at(1));
  };
  transform.offset = pair("offset", transform.offset);
  transform.scale = pair("scale", transform.scale);
  if (value.Has("rotation") && value.Get("rotation").IsNumber())
    transform.rotation = value.Get("rotation").GetNumberAsDouble();
  if (value.Has("texCoord") && value.Get("texCoord").IsInt())
    transform.coordinates = value.Get("texCoord").GetNumberAsInt();
  return transform;
}

/// Returns whether the material has no properties of a surface. Missing properties are 1 in glTF.
bool has_no_surface(const tinygltf::Material& material) {
  const auto& surface = material.pbrMetallicRoughness;
  return surface.baseColorFactor == std::vector<double>(4, 1.0) && surface.metallicFactor == 1 &&
         surface.roughnessFactor == 1 && surface.baseColorTexture.index < 0 &&
         surface.metallicRoughnessTexture.index < 0;
}

/// Returns an attribute's numbers, one group for each vertex, finite or not; nullopt if the primitive has none.
std::optional<Numbers> attribute_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                    const std::string& name, std::initializer_list<int> types, std::size_t vertices,
                                    const std::string& place) {
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end()) return std::nullopt;
  Numbers numbers = read_numbers(model, found->second, types, name.c_str(), NotFinite::keep);
  if (numbers.count() != vertices)
    throw InputError("{}/attributes/{}: {} of them for {} vertices", place, name, numbers.count(), vertices);
  return numbers;
}

}  // namespace

Look SurfaceReader::read(const tinygltf::Primitive& primitive, const std::string& place, const std::string& object,
                         std::size_t vertices) {
  Look look;
  const Owner owner{primitive, place, object, vertices};
  if (primitive.material >= 0) read_material(owner, look);
  const auto all_finite = [](const Numbers& numbers) {
    return std::ranges::all_of(numbers.values, [](double x) { return std::isfinite(x); });
  };
  if (const auto normals = attribute_of(model_, primitive, "NORMAL", {TINYGLTF_TYPE_VEC3}, vertices, place)) {
    if (!all_finite(*normals)) losses_.mention("has normals that are not finite; it is shaded by facets there", object);
    for (std::size_t i = 0; i < vertices; ++i)
      look.normals.emplace_back(normals->values[3 * i], normals->values[3 * i + 1], normals->values[3 * i + 2]);
  }
  if (const auto colors =
          attribute_of(model_, primitive, "COLOR_0", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}, vertices, place)) {
    if (!all_finite(*colors)) losses_.mention("has colours that are not finite; they are white", object);
    for (std::size_t i = 0; i < vertices; ++i) {
      glm::vec4 color(1);
      for (std::size_t c = 0; c < colors->components; ++c) {
        const double part = colors->values[i * colors->components + c];
        if (std::isfinite(part)) color[static_cast<glm::length_t>(c)] = static_cast<float>(std::clamp(part, 0.0, 1.0));
      }
      look.colors.push_back(color);
    }
  }
  if (lightmap_) read_lightmap_places(owner, look);
  return look;
}

void SurfaceReader::read_lightmap_places(const Owner& owner, Look& look) {
  const auto numbers = attribute_of(model_, owner.primitive, fmt::format("TEXCOORD_{}", *lightmap_),
                                    {TINYGLTF_TYPE_VEC2}, owner.vertices, owner.place);
  if (!numbers) return;
  for (std::size_t i = 0; i < owner.vertices; ++i) {
    const glm::dvec2 place(numbers->values[2 * i], numbers->values[2 * i + 1]);
    look.lightmap.push_back(std::abs(place.x) < 1e6 && std::abs(place.y) < 1e6 ? place : mesh::kNoPlace);
  }
}

std::vector<glm::dvec2> SurfaceReader::places_of(const Owner& owner, const tinygltf::TextureInfo& info, bool decides) {
  const TextureTransform transform = transform_of(info);
  const int set = transform.coordinates >= 0 ? transform.coordinates : info.texCoord;
  const auto numbers = attribute_of(model_, owner.primitive, fmt::format("TEXCOORD_{}", set), {TINYGLTF_TYPE_VEC2},
                                    owner.vertices, owner.place);
  const auto lose = [&](const std::string& what) {
    decides ? losses_.refuse(what, owner.object) : losses_.mention(what, owner.object);
  };
  if (!numbers) {
    // glTF 2.0 does not define the appearance in this case.
    lose(fmt::format("has no TEXCOORD_{} to map its picture: one texel covers all of it", set));
    return std::vector<glm::dvec2>(owner.vertices, transform.offset);
  }
  std::vector<glm::dvec2> places;
  bool finite = true;
  for (std::size_t i = 0; i < owner.vertices; ++i) {
    glm::dvec2 place = transform({numbers->values[2 * i], numbers->values[2 * i + 1]});
    if (!std::isfinite(place.x) || !std::isfinite(place.y)) {
      finite = false;
      place = transform.offset;
    }
    places.push_back(place);
  }
  if (!finite)
    lose(fmt::format("has numbers in TEXCOORD_{} that are not finite: its picture is mapped wrongly there", set));
  return places;
}

void SurfaceReader::read_material(const Owner& owner, Look& look) {
  const int number = owner.primitive.material;
  if (static_cast<std::size_t>(number) >= model_.materials.size()) {
    throw InputError("{}/material: material {} does not exist; there are {}", owner.place, number,
                     model_.materials.size());
  }
  const tinygltf::Material& material = model_.materials[static_cast<std::size_t>(number)];
  const std::string here = fmt::format("/materials/{}", number);
  const BaseColor base = base_color_of(material);
  look.color = glm::min(checked_factor(base.factor, glm::dvec3(1), here + base.factor_place), glm::dvec3(1));
  look.material = material.name.empty() ? fmt::format("material {}", number) : material.name;
  look.two_sided = material.doubleSided;
  look.alpha = alpha_of(material, base, here);
  look.radiance = checked_factor(material.emissiveFactor, glm::dvec3(0), here + "/emissiveFactor") *
                  number_of(material.extensions, "KHR_materials_emissive_strength", "emissiveStrength", 1, here);
  if (base.texture.index >= 0) {
    // A picture may have an alpha that cuts holes.
    const bool decides = look.alpha.mode != scenes::Alpha::Mode::opaque;
    std::string why_not;
    look.picture = picture_use(base.texture.index, here + base.texture_place, why_not);
    if (look.picture)
      look.places = places_of(owner, base.texture, decides);
    else if (const std::string what = "is shown without its picture: " + why_not; decides)
      losses_.refuse(what, owner.object);
    else
      losses_.mention(what, owner.object);
  }
  read_emission(owner, here, look);
  mention_unlike(owner, here, look);
}

void SurfaceReader::mention_unlike(const Owner& owner, const std::string& here, const Look& look) {
  const tinygltf::Material& material = model_.materials[static_cast<std::size_t>(owner.primitive.material)];
  const auto& surface = material.pbrMetallicRoughness;
  if (number_of(material.extensions, "KHR_materials_transmission", "transmissionFactor", 0, here) > 0)
    losses_.refuse("lets light through (transmission), which is not supported: it would be opaque", owner.object);
  if (number_of(material.extensions, "KHR_materials_diffuse_transmission", "diffuseTransmissionFactor", 0, here) > 0)
    losses_.mention("scatters light through itself (diffuse transmission), which is left out", owner.object);
  if (material.extensions.contains("KHR_materials_unlit"))
    losses_.mention("is unlit in the file; every surface is lit here", owner.object);
  else if (look.radiance == glm::dvec3(0) && is_from_blender(model_) && has_no_surface(material))
    losses_.mention("has no base colour in the file and is white: Blender exports only that of Principled BSDF",
                    owner.object);
  else if (!material.extensions.contains(kSpecularGlossiness) && look.color != glm::dvec3(0) &&
           (surface.metallicRoughnessTexture.index >= 0 || surface.metallicFactor > 0))
    losses_.mention("has a metallic material; every surface is diffuse here", owner.object);
  if (material.normalTexture.index >= 0) losses_.mention("has a normal map, which is left out", owner.object);
}

void SurfaceReader::read_emission(const Owner& owner, const std::string& place, Look& look) {
  const tinygltf::Material& material = model_.materials[static_cast<std::size_t>(owner.primitive.material)];
  if (material.emissiveTexture.index < 0 || look.radiance == glm::dvec3(0)) return;
  std::string why_not;
  look.emission = picture_use(material.emissiveTexture.index, place + "/emissiveTexture", why_not);
  if (!look.emission) {
    losses_.refuse(fmt::format("would shine without its emissive picture: {}", why_not), owner.object);
    return;
  }
  tinygltf::TextureInfo info;
  info.texCoord = material.emissiveTexture.texCoord;
  info.extensions = material.emissiveTexture.extensions;
  look.emission_places = places_of(owner, info, false);
}

std::optional<scenes::PictureUse> SurfaceReader::picture_use(int texture, const std::string& place,
                                                             std::string& why_not) {
  const auto picture = picture_of(texture, place, why_not);
  if (!picture) return std::nullopt;
  scenes::PictureUse use{*picture};
  const int sampler = model_.textures[static_cast<std::size_t>(texture)].sampler;
  if (sampler < 0) return use;
  if (static_cast<std::size_t>(sampler) >= model_.samplers.size()) {
    throw InputError("/textures/{}/sampler: sampler {} does not exist; there are {}", texture, sampler,
                     model_.samplers.size());
  }
  const tinygltf::Sampler& how = model_.samplers[static_cast<std::size_t>(sampler)];
  use.wrap_s = wrap_of(how.wrapS);
  use.wrap_t = wrap_of(how.wrapT);
  use.nearest = how.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  return use;
}

std::optional<std::uint32_t> SurfaceReader::picture_of(int texture, const std::string& place, std::string& why_not) {
  if (static_cast<std::size_t>(texture) >= model_.textures.size())
    throw InputError("{}/index: texture {} does not exist; there are {}", place, texture, model_.textures.size());
  const int number = model_.textures[static_cast<std::size_t>(texture)].source;
  if (number < 0 || static_cast<std::size_t>(number) >= model_.images.size()) {
    const auto& extensions = model_.textures[static_cast<std::size_t>(texture)].extensions;
    why_not = extensions.empty() ? "the file names no image"
                                 : fmt::format("its only image is that of {}, which is not read (PNG and JPEG are)",
                                               extensions.begin()->first);
    return std::nullopt;
  }
  const auto [known, is_new] = known_.try_emplace(number);
  if (is_new) {
    const tinygltf::Image& image = model_.images[static_cast<std::size_t>(number)];
    const std::string name = !image.name.empty() ? image.name
                             : image.uri.empty() ? fmt::format("image {}", number)
                                                 : image.uri;
    try {
      const std::span<const unsigned char> bytes =
          image.bufferView >= 0 ? read_view(model_, image.bufferView, fmt::format("/images/{}", number)) : image.image;
      if (bytes.empty()) throw InputError("it cannot be read");
      const std::span<const std::byte> file = std::as_bytes(bytes);
      RgbaImage decoded = looks_like_jpeg(file) ? decode_rgba_jpeg(file, kLargestPictureSide)
                                                : decode_rgba_png(file, kLargestPictureSide);
      known->second = static_cast<std::uint32_t>(pictures_.size());
      pictures_.push_back({name, decoded.width, decoded.height, std::move(decoded.pixels)});
    } catch (const InputError& error) {
      unreadable_[number] = fmt::format(
          "\"{}\": {} (PNG and JPEG are what is read; in Blender's exporter, Images: Automatic writes "
          "one of them)",
          name, error.what());
    }
  }
  if (!known->second) why_not = unreadable_[number];
  return known->second;
}

SurfaceReader::AlphaRange SurfaceReader::alpha_range(const Look& look) {
  AlphaRange vertices, texels;
  for (const glm::vec4& color : look.colors) {
    vertices.least = std::min<double>(vertices.least, color.a);
  }
  if (!look.colors.empty())
    vertices.greatest = std::ranges::max_element(look.colors, {}, [](const glm::vec4& color) { return color.a; })->a;
  if (look.picture) {
    const auto [known, is_new] = ranges_.try_emplace(look.picture->picture);
    if (is_new) {
      const auto& all = pictures_[look.picture->picture].texels;
      const auto [least, greatest] = std::ranges::minmax_element(all, {}, [](const auto& texel) { return texel[3]; });
      known->second = {(*least)[3] / 255.0, (*greatest)[3] / 255.0};
    }
    texels = known->second;
  }
  return {look.alpha.factor * vertices.least * texels.least, look.alpha.factor * vertices.greatest * texels.greatest};
}

Opacity SurfaceReader::opacity_of(const Look& look) {
  if (look.alpha.mode == scenes::Alpha::Mode::opaque) return Opacity::solid;
  const AlphaRange range = alpha_range(look);
  const bool mask = look.alpha.mode == scenes::Alpha::Mode::mask;
  if (range.least >= (mask ? look.alpha.cutoff : 1.0)) return Opacity::solid;
  if (mask ? range.greatest < look.alpha.cutoff : range.greatest <= 0) return Opacity::gone;
  return Opacity::neither;
}

}  // namespace penumbra::import
