// SPDX-License-Identifier: Apache-2.0
// Broken meshes described in other ways: the same triangles in another order, with another first vertex, wound the
// other way, with separate vertices, twice, or cut at points exactly on them. None of this may change a bit.
// (view_sample_invariance.cpp does this for scenes and for soups with lights among them.)

#include "tests/agreement/differences.hpp"

#include "mesh/shapes/broken_meshes.hpp"

#include <optional>

namespace penumbra::vsm {
namespace {

using tests::Masks;
using visibility::Light;
using visibility::SceneFloats;
using visibility::ViewSamples;

struct Case {
  std::string name;
  mesh::TriangleSoup soup;
};

/// Meshes with each of the defects, and soups from a lattice of very few points.
std::vector<Case> cases() {
  std::vector<Case> result;
  const auto defects = mesh::broken_defects();
  constexpr std::size_t kMeshes = 3;
  for (std::size_t i = 0; i < kMeshes; ++i) {
    mesh::BrokenShape shape{{}, 1 + static_cast<std::uint32_t>(i % 2), {0, 1, 0}, 2};
    for (std::size_t j = i; j < defects.size(); j += kMeshes) shape.defects.emplace_back(defects[j].name);
    result.push_back({fmt::format("defects {} mod {}", i, kMeshes), mesh::make_broken_mesh(shape).soup});
  }
  for (std::uint32_t seed = 11; seed < 13; ++seed) {
    result.push_back({fmt::format("soup, seed {}", seed),
                      mesh::make_lattice_soup({12 * (seed - 10), 2 + seed % 3, seed, {0, 1.5, 0}, 1})});
  }
  return result;
}

/// Changes the description of a soup.
using Wording = void (*)(mesh::TriangleSoup&, std::mt19937&);

void permute(mesh::TriangleSoup& soup, std::mt19937& random) {
  std::shuffle(soup.triangles.begin(), soup.triangles.end(), random);
}
void rotate(mesh::TriangleSoup& soup, std::mt19937& random) {
  for (mesh::Triangle& t : soup.triangles) std::rotate(t.begin(), t.begin() + random() % 3, t.end());
}
void flip(mesh::TriangleSoup& soup, std::mt19937& random) {
  for (mesh::Triangle& t : soup.triangles) {
    if (random() % 2 == 0) std::swap(t[1], t[2]);
  }
}
void flip_all(mesh::TriangleSoup& soup, std::mt19937&) {
  for (mesh::Triangle& t : soup.triangles) std::swap(t[0], t[2]);
}
/// Gives some corners a separate position, with zeros of the other sign.
void duplicate_vertices(mesh::TriangleSoup& soup, std::mt19937& random) {
  for (mesh::Triangle& t : soup.triangles) {
    for (std::uint32_t& corner : t) {
      if (random() % 3 == 0) continue;
      glm::dvec3 position = soup.positions[corner];
      for (int axis = 0; axis < 3; ++axis) {
        if (position[axis] == 0) position[axis] = -position[axis];
      }
      corner = static_cast<std::uint32_t>(soup.positions.size());
      soup.positions.push_back(position);
    }
  }
}
void duplicate_faces(mesh::TriangleSoup& soup, std::mt19937& random) {
  for (std::size_t i = soup.triangles.size(); i-- > 0;) {
    for (auto copies = random() % 3; copies > 0; --copies) {
      const mesh::Triangle copied = soup.triangles[i];
      soup.triangles.push_back(copied);
    }
  }
}

class Metamorphic : public tests::DeviceTest, public testing::WithParamInterface<const char*> {
 protected:
  struct Picture {
    ViewSamples samples;
    Masks masks;
  };

  /// `samples`: the given view samples, or else those that the camera sees.
  Picture picture(const SceneFloats& floats, const scenes::Scene& scene, std::optional<ViewSamples> samples = {}) {
    const Light light = visibility::make_light(scene, 0, floats.origin, {});
    if (!samples) {
      render::VisibilityBuffer view(device(), floats);
      samples = view.render(visibility::make_camera(scene.cameras[0], floats.origin, 28, 28));
    }
    Masks masks = tests::run(*method_, floats, light, *samples);
    return {std::move(*samples), std::move(masks)};
  }

 private:
  std::unique_ptr<visibility::Method> method_ = make_view_sample(device(), {{"engine", GetParam()}});
};

TEST_P(Metamorphic, TheSameTrianglesInOtherWords) {
  static constexpr std::pair<const char*, Wording> kWordings[] = {{"permuted", permute},
                                                                  {"rotated", rotate},
                                                                  {"flipped", flip},
                                                                  {"flipped altogether", flip_all},
                                                                  {"vertices", duplicate_vertices},
                                                                  {"faces", duplicate_faces}};
  std::mt19937 random(3);
  std::size_t partly = 0;
  for (const auto& [name, soup] : cases()) {
    const auto picture_of = [this](const mesh::TriangleSoup& of) {
      const scenes::Scene scene = tests::with_a_floor(of);
      return picture(visibility::make_scene_floats(scene), scene);
    };
    const Picture plain = picture_of(soup);
    for (const float v : plain.masks.visibility) partly += v > 0 && v < 1 ? 1 : 0;
    for (const auto& [wording, reword] : kWordings) {
      mesh::TriangleSoup other = soup;
      reword(other, random);
      const Picture again = picture_of(other);
      EXPECT_EQ(plain.samples.p, again.samples.p) << name << " " << wording;
      EXPECT_EQ(plain.samples.n, again.samples.n) << name << " " << wording;
      EXPECT_EQ(plain.masks.words, again.masks.words) << name << " " << wording;
      EXPECT_EQ(plain.masks.visibility, again.masks.visibility) << name << " " << wording;
    }
  }
  EXPECT_GT(partly, 300U);  // pixels in penumbra
}

/// A scene whose triangles are cut, and the original triangle of each piece.
struct Split {
  scenes::Scene scene;
  std::vector<std::uint32_t> whole;
};

/// Leaves each triangle alone, or cuts it in two at a point on a side, in three at a point inside, or in four at the
/// middles of its sides. The points are halves and quarters, exact on a lattice of dyadic numbers. Neighbours are cut
/// independently, so there are T-junctions everywhere.
Split split(const scenes::Scene& scene, std::mt19937& random) {
  Split result{scene, {}};
  mesh::TriangleSoup& soup = result.scene.soup;
  soup.triangles.clear();
  soup.object.clear();
  soup.source_face.clear();
  for (std::uint32_t i = 0; i < scene.soup.triangles.size(); ++i) {
    mesh::Triangle t = scene.soup.triangles[i];
    std::rotate(t.begin(), t.begin() + random() % 3, t.end());
    const std::uint32_t a = t[0], b = t[1], c = t[2];  // lambdas may not capture bindings
    const auto at = [&](double u, double v, double w) {
      const glm::dvec3 point = u * soup.positions[a] + v * soup.positions[b] + w * soup.positions[c];
      soup.positions.push_back(point);
      return static_cast<std::uint32_t>(soup.positions.size() - 1);
    };
    const auto add = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) {
      soup.triangles.push_back({p, q, r});
      soup.object.push_back(scene.soup.object[i]);
      soup.source_face.push_back(scene.soup.source_face[i]);
      result.whole.push_back(i);
    };
    switch (random() % 4) {
      case 0:
        add(a, b, c);
        break;
      case 1: {
        const std::uint32_t side = random() % 2 == 0 ? at(0.5, 0.5, 0) : at(0.25, 0.75, 0);
        add(a, side, c);
        add(side, b, c);
        break;
      }
      case 2: {
        const std::uint32_t inside = at(0.5, 0.25, 0.25);
        add(a, b, inside);
        add(b, c, inside);
        add(c, a, inside);
        break;
      }
      default: {
        const std::uint32_t ab = at(0.5, 0.5, 0), bc = at(0, 0.5, 0.5), ca = at(0.5, 0, 0.5);
        add(a, ab, ca);
        add(b, bc, ab);
        add(c, ca, bc);
        add(ab, bc, ca);
      }
    }
  }
  return result;
}

glm::dvec3 normal(const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 a(corners[0]);
  return glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
}

/// Returns how far inside the triangle the point is, in units of area, as seen along the triangle's normal.
double inside(const std::array<glm::vec3, 3>& corners, const glm::dvec3& p) {
  const glm::dvec3 n = glm::normalize(normal(corners));
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 a(corners[i]), b(corners[(i + 1) % 3]);
    least = std::min(least, glm::dot(n, glm::cross(b - a, p - a)));
  }
  return least;
}

/// Returns view samples with the given stored points, each on the piece that contains it.
ViewSamples on_pieces(const ViewSamples& samples, const SceneFloats& before, const SceneFloats& after,
                      const std::vector<std::uint32_t>& whole) {
  ViewSamples result = samples;
  for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
    if (samples.triangle[pixel] == ViewSamples::kBackground) continue;
    const auto of = static_cast<std::uint32_t>(samples.triangle[pixel]);
    const auto pieces = std::equal_range(whole.begin(), whole.end(), of);
    std::uint32_t best = 0;
    double depth = std::numeric_limits<double>::lowest();
    for (auto piece = pieces.first; piece != pieces.second; ++piece) {
      const auto index = static_cast<std::uint32_t>(piece - whole.begin());
      const double here = inside(after.corners(index), samples.p[pixel]);
      if (here > depth) depth = here, best = index;
    }
    result.triangle[pixel] = static_cast<std::int32_t>(best);
    // The order of sorted corners may reverse the normal.
    const bool turned = glm::dot(normal(before.corners(of)), normal(after.corners(best))) < 0;
    result.facing[pixel] = static_cast<std::int8_t>(turned ? -samples.facing[pixel] : samples.facing[pixel]);
  }
  return result;
}

TEST_P(Metamorphic, CutAtPointsExactlyOnThem) {
  std::mt19937 random(7);
  std::size_t pairs = 0, differing = 0, pieces = 0;
  for (const auto& [name, soup] : cases()) {
    const scenes::Scene scene = tests::with_a_floor(soup);
    const auto [cut, whole] = split(scene, random);
    pieces += whole.size() - soup.triangles.size();
    const SceneFloats before = visibility::make_scene_floats(scene), after = visibility::make_scene_floats(cut);
    ASSERT_EQ(before.origin, after.origin);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const auto index = static_cast<std::uint32_t>(i);
      if (before.plane[whole[i]] == SceneFloats::kNoPlane) continue;
      ASSERT_NE(after.plane[index], SceneFloats::kNoPlane) << name;
      for (const glm::vec3& corner : after.corners(index)) {
        const auto [a, b, c] = before.corners(whole[i]);
        ASSERT_EQ(visibility::side_of_plane(a, b, c, corner), visibility::Side::on) << name << ": the cut is not exact";
      }
    }
    const Picture plain = picture(before, scene);
    // Points as a camera sees them, and points exactly on triangles, some of them on the lines of the cuts.
    const Picture cut_picture = picture(after, cut, on_pieces(plain.samples, before, after, whole));
    EXPECT_EQ(tests::differing_bits(plain.masks, cut_picture.masks), 0U) << name;
    const Picture exact = picture(before, scene, tests::samples_on_triangles(before, 16, 12, random));
    const Picture exact_cut = picture(after, cut, on_pieces(exact.samples, before, after, whole));
    EXPECT_EQ(tests::differing_bits(exact.masks, exact_cut.masks), 0U) << name;
    // For a camera that sees the cut scene, p is rounded from the pieces' corners.
    const Picture anew = picture(after, cut);
    differing += tests::differing_bits(plain.masks, anew.masks);
    for (const std::int32_t triangle : plain.samples.triangle) pairs += triangle < 0 ? 0 : 256;
  }
  fmt::print("{} more triangles; with p from the cut triangles {} of {} pairs differ\n", pieces, differing, pairs);
  EXPECT_LE(static_cast<double>(differing), 2e-5 * static_cast<double>(pairs));
}

INSTANTIATE_TEST_SUITE_P(On, Metamorphic, testing::Values("vulkan", "native"));

}  // namespace
}  // namespace penumbra::vsm
