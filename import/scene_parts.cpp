// SPDX-License-Identifier: Apache-2.0
// Collects lamps, cameras and colours of a file that Assimp read. Assimp does not tell whether a camera is
// orthographic, so the file's own bytes are searched for that.

#include "import/scene_parts.hpp"

#include "import/audit_collada.hpp"

#include <assimp/material.h>
#include <assimp/scene.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <span>

namespace penumbra::import {
namespace {

glm::dvec3 to_glm(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}
glm::dvec3 to_glm(const aiColor3D& c) {
  return {c.r, c.g, c.b};
}

std::optional<glm::dvec3> color_of(const aiMaterial& material, const char* key) {
  aiColor4D color;
  if (material.Get(key, 0, 0, color) != AI_SUCCESS) return std::nullopt;
  return glm::dvec3(color.r, color.g, color.b);
}

SceneParts::Lamp::Kind kind_of(aiLightSourceType type) {
  switch (type) {
    case aiLightSource_DIRECTIONAL:
      return SceneParts::Lamp::Kind::sun;
    case aiLightSource_POINT:
      return SceneParts::Lamp::Kind::point;
    case aiLightSource_SPOT:
      return SceneParts::Lamp::Kind::spot;
    default:
      return SceneParts::Lamp::Kind::other;
  }
}

glm::dmat4 place_of(const std::map<std::string, glm::dmat4, std::less<>>& places, const char* name) {
  const auto found = places.find(std::string_view(name));
  return found == places.end() ? glm::dmat4(1) : found->second;
}

}  // namespace

SceneParts::Part part_of(const aiScene& scene, const aiMesh& mesh, const std::string& name) {
  SceneParts::Part part;
  part.name = name;
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return part;
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  if (material.GetName().C_Str() == kPlainMaterial) return part;
  part.material = material.GetName().C_Str();
  part.color = color_of(material, "$clr.diffuse").value_or(part.color);
  part.emission = color_of(material, "$clr.emissive").value_or(part.emission);
  ai_real opacity = 1;
  if (material.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS) part.opacity = static_cast<double>(opacity);
  part.has_picture =
      material.GetTextureCount(aiTextureType_DIFFUSE) + material.GetTextureCount(aiTextureType_BASE_COLOR) > 0;
  part.has_cut = material.GetTextureCount(aiTextureType_OPACITY) > 0;
  return part;
}

std::vector<std::string> transparent_materials(const aiScene& scene) {
  std::set<std::string> names;
  for (const aiMesh* mesh : std::span(scene.mMeshes, scene.mNumMeshes)) {
    const SceneParts::Part part = part_of(scene, *mesh, {});
    if (part.opacity < 1 || part.has_cut) names.insert(part.material);
  }
  return {names.begin(), names.end()};
}

void add_lamps_and_lenses(const aiScene& scene, const std::map<std::string, glm::dmat4, std::less<>>& places,
                          SceneParts& parts) {
  for (const aiLight* light : std::span(scene.mLights, scene.mNumLights)) {
    const glm::dmat4 place = place_of(places, light->mName.C_Str());
    parts.lamps.push_back(
        {light->mName.C_Str(), kind_of(light->mType), glm::dvec3(place * glm::dvec4(to_glm(light->mPosition), 1)),
         glm::dvec3(place * glm::dvec4(to_glm(light->mDirection), 0)), to_glm(light->mColorDiffuse),
         static_cast<double>(light->mAngleInnerCone) / 2, static_cast<double>(light->mAngleOuterCone) / 2});
  }
  for (const aiCamera* camera : std::span(scene.mCameras, scene.mNumCameras)) {
    const glm::dmat4 place = place_of(places, camera->mName.C_Str());
    parts.lenses.push_back({camera->mName.C_Str(), glm::dvec3(place * glm::dvec4(to_glm(camera->mPosition), 1)),
                            glm::dvec3(place * glm::dvec4(to_glm(camera->mLookAt), 0)),
                            glm::dvec3(place * glm::dvec4(to_glm(camera->mUp), 0)),
                            static_cast<double>(camera->mHorizontalFOV), static_cast<double>(camera->mAspect)});
  }
  aiString generator;
  if (scene.mMetaData != nullptr && scene.mMetaData->Get(std::string("SourceAsset_Generator"), generator))
    parts.generator = generator.C_Str();
  parts.moves = scene.mNumAnimations > 0;
}

bool has_orthographic_camera(std::string_view content) {
  if (content.find("<orthographic") != std::string_view::npos) return true;  // COLLADA
  // Binary FBX: name, type and two more texts, each preceded by its length, then 'I' and the number. FBX as text: the
  // same values, quoted.
  constexpr std::string_view kKey = "CameraProjectionType";
  constexpr std::string_view kBinary("S\x04\0\0\0enumS\0\0\0\0S\0\0\0\0I\x01", 21);
  for (std::size_t at = content.find(kKey); at != std::string_view::npos; at = content.find(kKey, at + 1)) {
    const std::string_view rest = content.substr(at + kKey.size(), 64);
    if (rest.starts_with(kBinary)) return true;
    const std::string_view line = rest.substr(0, rest.find_first_of("\r\n"));
    const std::size_t comma = line.rfind(',');
    if (line.starts_with('"') && comma != std::string_view::npos &&
        line.substr(comma + 1).find('1') != std::string_view::npos)
      return true;
  }
  return false;
}

bool has_template_of_lamps(std::string_view content) {
  return content.find(std::string_view("PropertyTemplateS\x08\0\0\0FbxLight", 29)) != std::string_view::npos;
}

}  // namespace penumbra::import
