// SPDX-License-Identifier: Apache-2.0
// Blob, knot, terrain and hair. Random numbers are hashes of small integers, so that the same seed gives the same mesh
// on every machine.

#include "mesh/shapes/shape_builder.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"

#include <glm/geometric.hpp>

#include <utility>

namespace penumbra::mesh {

using namespace builder;

namespace {

/// SplitMix64's finaliser (Steele, Lea, Flood 2014): a bijection of 64 bits without visible pattern.
std::uint64_t scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// Returns a number in [0, 1), a function of its arguments alone.
double chance(std::uint64_t seed, std::uint64_t a, std::uint64_t b) {
  return static_cast<double>(scramble(scramble(scramble(seed) ^ a) ^ b) >> 11) * 0x1p-53;
}

/// Returns value noise in [-1, 1]: random heights at integer places, interpolated by a quintic so that slopes are
/// continuous.
double value_noise(std::uint64_t seed, double x, double y) {
  const double cell_x = std::floor(x), cell_y = std::floor(y);
  const auto corner = [&](double i, double j) {
    return chance(seed, static_cast<std::uint64_t>(static_cast<std::int64_t>(cell_x + i)),
                  static_cast<std::uint64_t>(static_cast<std::int64_t>(cell_y + j)));
  };
  const auto smooth = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  const double s = smooth(x - cell_x), t = smooth(y - cell_y);
  const double low = corner(0, 0) + s * (corner(1, 0) - corner(0, 0));
  const double high = corner(0, 1) + s * (corner(1, 1) - corner(0, 1));
  return 2 * (low + t * (high - low)) - 1;
}

}  // namespace

ShapeSize shape_size(const BlobShape& blob) {
  return icosphere_size(blob.subdivisions);
}

TriangleSoup make_blob(const BlobShape& blob) {
  PENUMBRA_ASSERT(std::abs(blob.bump) < 1, "{}", blob.bump);
  TriangleSoup soup = make_icosphere(glm::dvec3(0), 1, blob.subdivisions);
  for (glm::dvec3& position : soup.positions) {
    // Phases keep the bumps from lining up with the coordinate planes.
    const glm::dvec3 wave = position * blob.frequency;
    const double bump = std::sin(wave.x + 1) * std::sin(wave.y + 2) * std::sin(wave.z + 3);
    position = blob.center + blob.radius * (1 + blob.bump * bump) * position;
  }
  return soup;
}

ShapeSize shape_size(const KnotShape& knot) {
  return checked({2ull * knot.segments * knot.sides, std::uint64_t{knot.segments} * knot.sides});
}

TriangleSoup make_knot(const KnotShape& knot) {
  PENUMBRA_ASSERT(knot.segments >= 3 && knot.sides >= 3, "{} x {}", knot.segments, knot.sides);
  TriangleSoup soup = soup_with_room(shape_size(knot));
  const double core = knot.radius * 2 / 3, swing = knot.radius / 3;  // the torus that the knot winds around
  const double turns = knot.turns, windings = knot.windings;
  for (std::uint32_t i = 0; i < knot.segments; ++i) {
    const double t = kTau * i / knot.segments;
    const double around = turns * t, through = windings * t;
    const glm::dvec3 outward(std::cos(around), 0, -std::sin(around)), along(-std::sin(around), 0, -std::cos(around));
    const glm::dvec3 normal = std::cos(through) * outward + glm::dvec3(0, std::sin(through), 0);  // normal of the torus
    const double distance = core + swing * std::cos(through);
    const glm::dvec3 axis = core * outward + swing * normal;
    const glm::dvec3 tangent =
        glm::normalize(turns * distance * along +
                       windings * swing * (-std::sin(through) * outward + glm::dvec3(0, std::cos(through), 0)));
    // The torus's normal gives a frame that closes after the last segment; it is orthogonal to the curve.
    const glm::dvec3 binormal = glm::cross(tangent, normal);
    for (std::uint32_t j = 0; j < knot.sides; ++j) {
      const double across = kTau * j / knot.sides;
      add_vertex(soup, knot.center + axis + knot.tube * (std::cos(across) * normal + std::sin(across) * binormal));
    }
  }
  add_ring_faces(soup, knot.segments, knot.sides);
  return finish(std::move(soup));
}

ShapeSize shape_size(const TerrainShape& terrain) {
  return shape_size(GridShape{.cells_u = terrain.cells.x, .cells_v = terrain.cells.y});
}

TriangleSoup make_terrain(const TerrainShape& terrain) {
  const double longer = std::max(terrain.half_size.x, terrain.half_size.y);
  TriangleSoup soup = make_grid({.center = terrain.center,
                                 .half_u = {terrain.half_size.x, 0, 0},
                                 .half_v = {0, 0, -terrain.half_size.y},
                                 .cells_u = terrain.cells.x,
                                 .cells_v = terrain.cells.y});
  for_each_index(soup.positions.size(), [&](std::size_t i) {
    glm::dvec3& position = soup.positions[i];
    // Each octave has twice the frequency and half the height; the sum of the heights is 1.
    double height = 0, amplitude = 1, total = 0, frequency = terrain.features / (2 * longer);
    for (std::uint32_t octave = 0; octave < terrain.octaves; ++octave) {
      height += amplitude * value_noise(scramble(terrain.seed) + octave, (position.x - terrain.center.x) * frequency,
                                        (position.z - terrain.center.z) * frequency);
      total += amplitude;
      amplitude /= 2;
      frequency *= 2;
    }
    position.y += terrain.height / 2 * height / total;
  });
  return soup;
}

ShapeSize shape_size(const HairShape& hair) {
  return checked({2ull * hair.strands * hair.segments, 2ull * hair.strands * (hair.segments + 1ull)});
}

TriangleSoup make_hair(const HairShape& hair) {
  PENUMBRA_ASSERT(hair.segments >= 1, "{}", hair.segments);
  TriangleSoup soup = soup_with_room(shape_size(hair));
  for (std::uint32_t strand = 0; strand < hair.strands; ++strand) {
    const auto draw = [&](std::uint64_t what) { return chance(hair.seed, strand, what); };
    const double place = kTau * draw(0), distance = hair.radius * std::sqrt(draw(1));  // uniform over the disk
    const glm::dvec3 root = hair.base + distance * glm::dvec3(std::cos(place), 0, std::sin(place));
    const double lean = kTau * draw(2), turn = kTau * draw(3), length = hair.length * (0.75 + 0.25 * draw(4));
    const glm::dvec3 sideways(std::cos(lean), 0, std::sin(lean));
    const glm::dvec3 across(std::cos(turn), 0, std::sin(turn));
    for (std::uint32_t i = 0; i <= hair.segments; ++i) {
      const double t = static_cast<double>(i) / hair.segments;
      const glm::dvec3 axis = root + length * (t * glm::dvec3(0, 1, 0) + hair.bend * t * t * sideways);
      const double half_width = hair.width / 2 * (1 - 0.8 * t);
      const std::uint32_t left = add_vertex(soup, axis - half_width * across);
      add_vertex(soup, axis + half_width * across);
      if (i > 0) add_quad(soup, left - 2, left - 1, left + 1, left);
    }
  }
  return finish(std::move(soup));
}

}  // namespace penumbra::mesh
