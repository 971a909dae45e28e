#include "scenes/formats/json_meshes.hpp"

#include "base/assert.hpp"
#include "mesh/shapes/broken_meshes.hpp"
#include "mesh/shapes/shapes.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <string_view>

/// From the keys of a "shape" to a generator's options. What a key means and its bounds: the schema; defaults: the
/// options structs of mesh/shapes/shapes.hpp and mesh/shapes/broken_meshes.hpp (a test holds the schema's to them).
namespace penumbra::scenes {
namespace {

using mesh::TriangleSoup;
using nlohmann::json;

/// Overwrites a default with the key's value, where there is one.
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

TriangleSoup sphere(const Keys& keys) {
  mesh::SphereShape options;
  keys.read("center", options.center);
  keys.read("radius", options.radius);
  keys.read("segments", options.segments);
  options.rings = std::max(2u, options.segments / 2);
  keys.read("rings", options.rings);
  return make_sphere(options);
}

TriangleSoup icosphere(const Keys& keys) {
  glm::dvec3 center(0);
  double radius = 1;
  std::uint32_t subdivisions = 3;
  keys.read("center", center);
  keys.read("radius", radius);
  keys.read("subdivisions", subdivisions);
  return mesh::make_icosphere(center, radius, subdivisions);
}

TriangleSoup blob(const Keys& keys) {
  mesh::BlobShape options;
  keys.read("center", options.center);
  keys.read("radius", options.radius);
  keys.read("subdivisions", options.subdivisions);
  keys.read("bump", options.bump);
  keys.read("frequency", options.frequency);
  return make_blob(options);
}

TriangleSoup box(const Keys& keys) {
  glm::dvec3 center(0), half_size(1);
  keys.read("center", center);
  keys.read("halfSize", half_size);
  return mesh::make_box(center, half_size);
}

mesh::CylinderShape cylinder_options(const Keys& keys) {
  mesh::CylinderShape options;
  keys.read("center", options.center);
  keys.read("radius", options.radius);
  keys.read("height", options.height);
  keys.read("segments", options.segments);
  keys.read("capped", options.capped);
  return options;
}

TriangleSoup cylinder(const Keys& keys) {
  return make_cylinder(cylinder_options(keys));
}

TriangleSoup cone(const Keys& keys) {
  return make_cone(cylinder_options(keys));
}

TriangleSoup torus(const Keys& keys) {
  mesh::TorusShape options;
  keys.read("center", options.center);
  keys.read("radius", options.radius);
  keys.read("tube", options.tube);
  keys.read("segments", options.segments);
  keys.read("sides", options.sides);
  return make_torus(options);
}

TriangleSoup knot(const Keys& keys) {
  mesh::KnotShape options;
  keys.read("center", options.center);
  keys.read("radius", options.radius);
  keys.read("tube", options.tube);
  keys.read("turns", options.turns);
  keys.read("windings", options.windings);
  keys.read("segments", options.segments);
  keys.read("sides", options.sides);
  return make_knot(options);
}

TriangleSoup grid(const Keys& keys) {
  mesh::GridShape options;
  keys.read("center", options.center);
  keys.read("halfU", options.half_u);
  keys.read("halfV", options.half_v);
  keys.read("cells", options.cells_u, options.cells_v);
  return make_grid(options);
}

TriangleSoup terrain(const Keys& keys) {
  mesh::TerrainShape options;
  keys.read("center", options.center);
  keys.read("halfSize", options.half_size);
  keys.read("height", options.height);
  keys.read("cells", options.cells.x, options.cells.y);
  keys.read("features", options.features);
  keys.read("octaves", options.octaves);
  keys.read("seed", options.seed);
  return make_terrain(options);
}

TriangleSoup fence(const Keys& keys) {
  mesh::FenceShape options;
  keys.read("base", options.base);
  keys.read("width", options.width);
  keys.read("height", options.height);
  keys.read("thickness", options.thickness);
  keys.read("posts", options.posts);
  keys.read("rails", options.rails);
  return make_fence(options);
}

TriangleSoup hair(const Keys& keys) {
  mesh::HairShape options;
  keys.read("base", options.base);
  keys.read("radius", options.radius);
  keys.read("length", options.length);
  keys.read("width", options.width);
  keys.read("bend", options.bend);
  keys.read("strands", options.strands);
  keys.read("segments", options.segments);
  keys.read("seed", options.seed);
  return make_hair(options);
}

TriangleSoup room(const Keys& keys) {
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
  return make_room(options);
}

TriangleSoup bars(const Keys& keys) {
  mesh::BarsShape options;
  keys.read("center", options.center);
  keys.read("length", options.length);
  keys.read("spacing", options.spacing);
  keys.read("radius", options.radius);
  keys.read("count", options.count);
  keys.read("segments", options.segments);
  return make_bars(options);
}

TriangleSoup broken(const Keys& keys) {
  mesh::BrokenShape options;
  keys.read("defects", options.defects);
  keys.read("size", options.size);
  keys.read("center", options.center);
  keys.read("halfExtent", options.half_extent);
  return make_broken_mesh(options).soup;
}

TriangleSoup lattice_soup(const Keys& keys) {
  mesh::LatticeSoup options;
  keys.read("triangles", options.triangles);
  keys.read("cells", options.cells);
  keys.read("seed", options.seed);
  keys.read("center", options.center);
  keys.read("halfExtent", options.half_extent);
  return make_lattice_soup(options);
}

struct Generator {
  std::string_view type;
  TriangleSoup (*make)(const Keys&);
};

constexpr std::array kGenerators{
    Generator{"sphere", sphere},     Generator{"icosphere", icosphere},
    Generator{"blob", blob},         Generator{"box", box},
    Generator{"cylinder", cylinder}, Generator{"cone", cone},
    Generator{"torus", torus},       Generator{"knot", knot},
    Generator{"grid", grid},         Generator{"terrain", terrain},
    Generator{"fence", fence},       Generator{"hair", hair},
    Generator{"room", room},         Generator{"bars", bars},
    Generator{"broken", broken},     Generator{"lattice-soup", lattice_soup},
};

}  // namespace

TriangleSoup read_shape(const json& shape) {
  const std::string type = shape["type"].get<std::string>();
  for (const Generator& generator : kGenerators) {
    if (generator.type == type) return generator.make(Keys(shape));
  }
  PENUMBRA_ASSERT(false, "the schema knows a shape \"{}\" that has no generator", type);
}

}  // namespace penumbra::scenes
