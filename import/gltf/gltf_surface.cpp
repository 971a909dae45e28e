// Materials of glTF 2.0 (section 3.9) with KHR_materials_emissive_strength and KHR_texture_transform, as far as diffuse
// surfaces go.

#include "import/gltf/gltf_surface.hpp"

#include "base/error.hpp"
#include "base/image.hpp"
#include "base/jpeg.hpp"
#include "base/png.hpp"
#include "import/gltf/gltf_accessor.hpp"
#include "import/gltf/gltf_load.hpp"

#include <tiny_gltf.h>

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

namespace penumbra::scenes {
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

/// A number of an extension; `otherwise` if it has none.
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

Alpha alpha_of(const tinygltf::Material& material, const std::string& place) {
  Alpha alpha;
  if (material.alphaMode == "MASK") alpha.mode = Alpha::Mode::mask;
  if (material.alphaMode == "BLEND") alpha.mode = Alpha::Mode::blend;
  if (alpha.mode == Alpha::Mode::opaque && !material.alphaMode.empty() && material.alphaMode != "OPAQUE")
    throw InputError("{}/alphaMode: \"{}\"; expected OPAQUE, MASK or BLEND", place, material.alphaMode);
  const std::vector<double>& color = material.pbrMetallicRoughness.baseColorFactor;
  alpha.factor = color.size() >= 4 ? color[3] : 1;
  alpha.cutoff = material.alphaCutoff;
  if (!(alpha.factor >= 0 && alpha.factor <= 1))
    throw InputError("{}/pbrMetallicRoughness/baseColorFactor: alpha {}; expected 0 to 1", place, alpha.factor);
  if (!std::isfinite(alpha.cutoff) || alpha.cutoff < 0)
    throw InputError("{}/alphaCutoff: {}; expected a number of 0 or more", place, alpha.cutoff);
  return alpha;
}

PictureUse::Wrap wrap_of(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return PictureUse::Wrap::clamp;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? PictureUse::Wrap::mirror : PictureUse::Wrap::repeat;
}

/// What KHR_texture_transform does to coordinates.
struct TextureTransform {
  glm::dvec2 offset{0}, scale{1};
  double rotation = 0;   ///< radians
  int coordinates = -1;  ///< its own set; −1: none

  /// Scaled, then turned counter-clockwise about (0, 0) as the picture is seen, v down, then moved: what Blender's
  /// exporter means and browsers show. (The extension's page has the matrix of it by rows.)
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

/// Does the material say nothing of its surface? What is left out is 1 in glTF.
bool has_no_surface(const tinygltf::Material& material) {
  const auto& surface = material.pbrMetallicRoughness;
  return surface.baseColorFactor == std::vector<double>(4, 1.0) && surface.metallicFactor == 1 &&
         surface.roughnessFactor == 1 && surface.baseColorTexture.index < 0 &&
         surface.metallicRoughnessTexture.index < 0;
}

/// An attribute's numbers, one group a vertex; nothing if the primitive has none.
std::optional<Numbers> attribute_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                    const std::string& name, std::initializer_list<int> types, std::size_t vertices,
                                    const std::string& place) {
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end()) return std::nullopt;
  Numbers numbers = read_numbers(model, found->second, types, name.c_str());
  if (numbers.count() != vertices)
    throw InputError("{}/attributes/{}: {} of them for {} vertices", place, name, numbers.count(), vertices);
  return numbers;
}

}  // namespace

Look SurfaceReader::read(const tinygltf::Primitive& primitive, const std::string& place, const std::string& object,
                         std::size_t vertices) {
  Look look;
  if (primitive.material >= 0) read_material(primitive, place, object, look);
  if (const auto normals = attribute_of(model_, primitive, "NORMAL", {TINYGLTF_TYPE_VEC3}, vertices, place)) {
    for (std::size_t i = 0; i < vertices; ++i)
      look.normals.emplace_back(normals->values[3 * i], normals->values[3 * i + 1], normals->values[3 * i + 2]);
  }
  if (const auto colors =
          attribute_of(model_, primitive, "COLOR_0", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}, vertices, place)) {
    for (std::size_t i = 0; i < vertices; ++i) {
      glm::vec4 color(1);
      for (std::size_t c = 0; c < colors->components; ++c) {
        color[static_cast<glm::length_t>(c)] =
            static_cast<float>(std::clamp(colors->values[i * colors->components + c], 0.0, 1.0));
      }
      look.colors.push_back(color);
    }
  }
  if (look.picture) {
    const auto& info =
        model_.materials[static_cast<std::size_t>(primitive.material)].pbrMetallicRoughness.baseColorTexture;
    const TextureTransform transform = transform_of(info);
    const int set = transform.coordinates >= 0 ? transform.coordinates : info.texCoord;
    const auto places =
        attribute_of(model_, primitive, fmt::format("TEXCOORD_{}", set), {TINYGLTF_TYPE_VEC2}, vertices, place);
    if (places) {
      for (std::size_t i = 0; i < vertices; ++i) {
        const glm::dvec2 uv(places->values[2 * i], places->values[2 * i + 1]);
        look.places.push_back(transform(uv));
      }
    } else {
      // glTF 2.0 leaves it open what is seen then; it decides of light where alpha does.
      const std::string what =
          fmt::format("has no TEXCOORD_{}, by which its picture lies on it: one texel is everywhere", set);
      look.alpha.mode == Alpha::Mode::opaque ? losses_.mention(what, object) : losses_.refuse(what, object);
      look.places.assign(vertices, transform.offset);
    }
  }
  return look;
}

void SurfaceReader::read_material(const tinygltf::Primitive& primitive, const std::string& place,
                                  const std::string& object, Look& look) {
  if (static_cast<std::size_t>(primitive.material) >= model_.materials.size()) {
    throw InputError("{}/material: material {} does not exist; there are {}", place, primitive.material,
                     model_.materials.size());
  }
  const tinygltf::Material& material = model_.materials[static_cast<std::size_t>(primitive.material)];
  const std::string here = fmt::format("/materials/{}", primitive.material);
  const auto& surface = material.pbrMetallicRoughness;
  look.color =
      glm::min(checked_factor(surface.baseColorFactor, glm::dvec3(1), here + "/pbrMetallicRoughness/baseColorFactor"),
               glm::dvec3(1));
  look.material = material.name.empty() ? fmt::format("material {}", primitive.material) : material.name;
  look.two_sided = material.doubleSided;
  look.alpha = alpha_of(material, here);
  look.radiance = checked_factor(material.emissiveFactor, glm::dvec3(0), here + "/emissiveFactor") *
                  number_of(material.extensions, "KHR_materials_emissive_strength", "emissiveStrength", 1, here);
  read_picture(primitive, object, look);
  read_emission(material, here, object, look);

  if (look.alpha.mode != Alpha::Mode::opaque && !look.picture &&
      material.extensions.contains("KHR_materials_pbrSpecularGlossiness"))
    losses_.refuse("has its alpha in KHR_materials_pbrSpecularGlossiness, which is not supported: it would be solid",
                   object);
  if (number_of(material.extensions, "KHR_materials_transmission", "transmissionFactor", 0, here) > 0)
    losses_.refuse("lets light through (transmission), which is not supported: it would be opaque", object);
  if (look.radiance == glm::dvec3(0) && is_from_blender(model_) && has_no_surface(material))
    losses_.mention("has no base colour in the file and is white: Blender exports that of Principled BSDF alone",
                    object);
  else if (look.color != glm::dvec3(0) && (surface.metallicRoughnessTexture.index >= 0 || surface.metallicFactor > 0))
    losses_.mention("has a metallic material; every surface is diffuse here", object);
  if (material.normalTexture.index >= 0) losses_.mention("has a normal map, which is left out", object);
}

void SurfaceReader::read_emission(const tinygltf::Material& material, const std::string& place,
                                  const std::string& object, Look& look) {
  if (material.emissiveTexture.index < 0 || look.radiance == glm::dvec3(0)) return;
  std::string why_not;
  const auto picture = picture_of(material.emissiveTexture.index, place + "/emissiveTexture", why_not);
  if (!picture) {
    losses_.refuse(fmt::format("would shine without its emissive picture: {}", why_not), object);
    return;
  }
  const auto& texels = pictures_[*picture].texels;
  glm::dvec3 sum(0);
  for (const auto& texel : texels) {
    for (glm::length_t c = 0; c < 3; ++c) sum[c] += linear_of_srgb(texel[static_cast<std::size_t>(c)] / 255.0);
  }
  look.radiance *= sum / static_cast<double>(texels.size());
  losses_.mention("shines evenly, with the mean of its whole emissive picture", object);
}

void SurfaceReader::read_picture(const tinygltf::Primitive& primitive, const std::string& object, Look& look) {
  const auto& info =
      model_.materials[static_cast<std::size_t>(primitive.material)].pbrMetallicRoughness.baseColorTexture;
  if (info.index < 0) return;
  const std::string place = fmt::format("/materials/{}/pbrMetallicRoughness/baseColorTexture", primitive.material);
  std::string why_not;
  const auto picture = picture_of(info.index, place, why_not);
  if (!picture) {
    const std::string what = fmt::format("is shown without its picture: {}", why_not);
    // A picture may have an alpha that cuts holes.
    look.alpha.mode == Alpha::Mode::opaque ? losses_.mention(what, object) : losses_.refuse(what, object);
    return;
  }
  look.picture = PictureUse{*picture};
  const int sampler = model_.textures[static_cast<std::size_t>(info.index)].sampler;
  if (sampler < 0) return;
  if (static_cast<std::size_t>(sampler) >= model_.samplers.size()) {
    throw InputError("/textures/{}/sampler: sampler {} does not exist; there are {}", info.index, sampler,
                     model_.samplers.size());
  }
  const tinygltf::Sampler& how = model_.samplers[static_cast<std::size_t>(sampler)];
  look.picture->wrap_s = wrap_of(how.wrapS);
  look.picture->wrap_t = wrap_of(how.wrapT);
  look.picture->nearest = how.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
}

std::optional<std::uint32_t> SurfaceReader::picture_of(int texture, const std::string& place, std::string& why_not) {
  if (static_cast<std::size_t>(texture) >= model_.textures.size())
    throw InputError("{}/index: texture {} does not exist; there are {}", place, texture, model_.textures.size());
  const int number = model_.textures[static_cast<std::size_t>(texture)].source;
  if (number < 0 || static_cast<std::size_t>(number) >= model_.images.size()) {
    why_not = "the file names no image";
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
  if (look.alpha.mode == Alpha::Mode::opaque) return Opacity::solid;
  const AlphaRange range = alpha_range(look);
  const bool mask = look.alpha.mode == Alpha::Mode::mask;
  if (range.least >= (mask ? look.alpha.cutoff : 1.0)) return Opacity::solid;
  if (mask ? range.greatest < look.alpha.cutoff : range.greatest <= 0) return Opacity::gone;
  return Opacity::neither;
}

}  // namespace penumbra::scenes
