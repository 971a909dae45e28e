// SPDX-License-Identifier: Apache-2.0
// Converts the keys of a "shape" to a generator's options. Meanings and bounds of keys are in the schema; defaults in
// the options structs of mesh/shapes/shapes.hpp and mesh/shapes/broken_meshes.hpp (a test compares them with the
// schema's).

#include "scenes/formats/json_meshes.hpp"

#include "base/assert.hpp"
#include "mesh/shapes/broken_meshes.hpp"
#include "mesh/shapes/shapes.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <string_view>

namespace penumbra::scenes {
namespace {

using mesh::TriangleSoup;
using nlohmann::json;

/// Overwrites a default with the key's value, if the key exists.
class Keys {
 public:
  explicit Keys(const json& shape) : shape_(shape) {}

  void read(const char* key, glm::dvec3& value) const {
    if (shape_.contains(key)) value = read_vector(shape_[key]);
  }
  void read(const char* key, glm::dvec2& value) const {
    if (shape_.contains(key)) value = {shape_[key][0].get<double>(), shape_[key][1].get<double>()};
  }
  void read(const char* key, std::uint32_t& first, std::uint32_t& second) const {
    if (!shape_.contains(key)) return;
    first = shape_[key][0].get<std::uint32_t>();
    second = shape_[key][1].get<std::uint32_t>();
  }
  template <typename Value>
  void read(const char* key, Value& value) const {
    value = shape_.value(key, value);
  }

 private:
  const json& shape_;
};

mesh::SphereShape sphere(const Keys& keys) {
  mesh::SphereShape options;
  keys.read("center", options.center);
  keys.read("radius", options.radius);
  keys.read("segments", options.segments);
  options.rings = std::max(2u, options.segments / 2);
  keys.read("rings", options.rings);
  return options;
}

std::uint32_t subdivisions(const Keys& keys) {
  std::uint32_t count = 3;
  keys.read("subdivisions", count);
  return count;
}

TriangleSoup icosphere(const Keys& keys) {
  glm::dvec3 center(0);
  double radius = 1;
  keys.read("center", center);
  keys.read("radius", radius);
  return mesh::make_icosphere(center, radius, subdivisions(keys));
}

mesh::BlobShape blob(const Keys& keys) {
  mesh::BlobShape options;
  keys.read("center", options.center);
  keys.read("radius", options.radius);
  keys.read("subdivisions", options.subdivisions);
  keys.read("bump", options.bump);
  keys.read("frequency", options.frequency);
  return options;
}

TriangleSoup box(const Keys& keys) {
  glm::dvec3 center(0), half_size(1);
  keys.read("center", center);
  keys.read("halfSize", half_size);
  return mesh::make_box(center, half_size);
}

mesh::CylinderShape cylinder(const Keys& keys) {
  mesh::CylinderShape options;
  keys.read("center", options.center);
  keys.read("radius", options.radius);
  keys.read("height", options.height);
  keys.read("segments", options.segments);
  keys.read("capped", options.capped);
  return options;
}

mesh::TorusShape torus(const Keys& keys) {
  mesh::TorusShape options;
  keys.read("center", options.center);
  keys.read("radius", options.radius);
  keys.read("tube", options.tube);
  keys.read("segments", options.segments);
  keys.read("sides", options.sides);
  return options;
}

mesh::KnotShape knot(const Keys& keys) {
  mesh::KnotShape options;
  keys.read("center", options.center);
  keys.read("radius", options.radius);
  keys.read("tube", options.tube);
  keys.read("turns", options.turns);
  keys.read("windings", options.windings);
  keys.read("segments", options.segments);
  keys.read("sides", options.sides);
  return options;
}

mesh::GridShape grid(const Keys& keys) {
  mesh::GridShape options;
  keys.read("center", options.center);
  keys.read("halfU", options.half_u);
  keys.read("halfV", options.half_v);
  keys.read("cells", options.cells_u, options.cells_v);
  return options;
}

mesh::TerrainShape terrain(const Keys& keys) {
  mesh::TerrainShape options;
  keys.read("center", options.center);
  keys.read("halfSize", options.half_size);
  keys.read("height", options.height);
  keys.read("cells", options.cells.x, options.cells.y);
  keys.read("features", options.features);
  keys.read("octaves", options.octaves);
  keys.read("seed", options.seed);
  return options;
}

mesh::FenceShape fence(const Keys& keys) {
  mesh::FenceShape options;
  keys.read("base", options.base);
  keys.read("width", options.width);
  keys.read("height", options.height);
  keys.read("thickness", options.thickness);
  keys.read("posts", options.posts);
  keys.read("rails", options.rails);
  return options;
}

mesh::HairShape hair(const Keys& keys) {
  mesh::HairShape options;
  keys.read("base", options.base);
  keys.read("radius", options.radius);
  keys.read("length", options.length);
  keys.read("width", options.width);
  keys.read("bend", options.bend);
  keys.read("strands", options.strands);
  keys.read("segments", options.segments);
  keys.read("seed", options.seed);
  return options;
}

mesh::RoomShape room(const Keys& keys) {
  mesh::RoomShape options;
  keys.read("base", options.base);
  keys.read("size", options.size);
  keys.read("thickness", options.thickness);
  keys.read("windowWidth", options.window_width);
  keys.read("windowHeight", options.window_height);
  keys.read("windowSill", options.window_sill);
  keys.read("verticalBars", options.vertical_bars);
  keys.read("horizontalBars", options.horizontal_bars);
  keys.read("bar", options.bar);
  return options;
}

mesh::BarsShape bars(const Keys& keys) {
  mesh::BarsShape options;
  keys.read("center", options.center);
  keys.read("length", options.length);
  keys.read("spacing", options.spacing);
  keys.read("radius", options.radius);
  keys.read("count", options.count);
  keys.read("segments", options.segments);
  return options;
}

mesh::BrokenShape broken(const Keys& keys) {
  mesh::BrokenShape options;
  keys.read("defects", options.defects);
  keys.read("size", options.size);
  keys.read("center", options.center);
  keys.read("halfExtent", options.half_extent);
  return options;
}

mesh::LatticeSoup lattice_soup(const Keys& keys) {
  mesh::LatticeSoup options;
  keys.read("triangles", options.triangles);
  keys.read("cells", options.cells);
  keys.read("seed", options.seed);
  keys.read("center", options.center);
  keys.read("halfExtent", options.half_extent);
  return options;
}

struct Generator {
  std::string_view type;
  TriangleSoup (*make)(const Keys&);
  mesh::ShapeSize (*size)(const Keys&);
};

template <auto options, auto make>
constexpr Generator generator(std::string_view type) {
  return {type, [](const Keys& keys) { return make(options(keys)); },
          [](const Keys& keys) { return mesh::shape_size(options(keys)); }};
}

constexpr std::array kGenerators{
    generator<sphere, mesh::make_sphere>("sphere"),
    Generator{"icosphere", icosphere, [](const Keys& keys) { return mesh::icosphere_size(subdivisions(keys)); }},
    generator<blob, mesh::make_blob>("blob"),
    Generator{"box", box,
              [](const Keys&) {
                return mesh::ShapeSize{12, 8};
              }},
    generator<cylinder, mesh::make_cylinder>("cylinder"),
    Generator{"cone", [](const Keys& keys) { return mesh::make_cone(cylinder(keys)); },
              [](const Keys& keys) { return mesh::cone_size(cylinder(keys)); }},
    generator<torus, mesh::make_torus>("torus"),
    generator<knot, mesh::make_knot>("knot"),
    generator<grid, mesh::make_grid>("grid"),
    generator<terrain, mesh::make_terrain>("terrain"),
    generator<fence, mesh::make_fence>("fence"),
    generator<hair, mesh::make_hair>("hair"),
    generator<room, mesh::make_room>("room"),
    generator<bars, mesh::make_bars>("bars"),
    Generator{"broken", [](const Keys& keys) { return make_broken_mesh(broken(keys)).soup; },
              [](const Keys& keys) { return mesh::shape_size(broken(keys)); }},
    generator<lattice_soup, mesh::make_lattice_soup>("lattice-soup"),
};

const Generator& generator_of(const json& shape) {
  const std::string type = shape["type"].get<std::string>();
  const auto* const found = std::ranges::find(kGenerators, type, &Generator::type);
  PENUMBRA_ASSERT(found != kGenerators.end(), "the schema knows a shape \"{}\" that has no generator", type);
  return *found;
}

}  // namespace

TriangleSoup read_shape(const json& shape) {
  return generator_of(shape).make(Keys(shape));
}

mesh::ShapeSize size_of_shape(const json& shape) {
  return generator_of(shape).size(Keys(shape));
}

}  // namespace penumbra::scenes
