// SPDX-License-Identifier: Apache-2.0
// Tests identities and inequalities between the pictures of two variants of a method, and properties that every picture
// must have. One table for all methods; checked on shipped scenes, meshes with every defect, and soups on a small
// lattice, where a camera, a light and triangles coincide. Names with I, B and A are rows of docs/predicates.md.

#include "tests/analytic/maps/places.hpp"
#include "tests/analytic/maps/map_variants.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <span>

namespace penumbra::tests {
namespace {

enum class Is : std::uint8_t {
  same,           ///< to the bit
  no_brighter,    ///< at any pixel; for masks, every bit that the other hides is hidden
  within,         ///< at every pixel, up to Identity::by
  same_or_black,  ///< to the bit, or 0 there
};

/// The statement "V of variant `a` is … V of variant `b`".
struct Identity {
  const char* name;
  const char* a;
  Is is;
  const char* b;
  double by = 0;
};

constexpr Identity kIdentities[] = {
    {"I1", "soft-shadow-map:passes=2", Is::no_brighter, "soft-shadow-map"},
    {"two loops, one sum", "soft-shadow-map:form=scatter:passes=2", Is::same, "soft-shadow-map:passes=2"},
    {"I3, C9", "packet:packet=7x3:divergence=0.4", Is::same, "contour:search=none:traversal=flat"},
    {"I5", "contour:search=hsm", Is::same, "contour:search=none:traversal=flat"},
    {"I5", "contour:search=ysm:receiverPlane=off", Is::same, "contour:search=none:traversal=flat:receiverPlane=off"},
    {"I5", "bitmask:search=ysm", Is::same, "bitmask:search=none"},
    {"I5", "backproject:search=hsm:form=sphere", Is::same_or_black, "backproject:search=none:form=sphere"},
    {"I6", "bitmask:occluder=triangle", Is::no_brighter, "bitmask:occluder=quad"},
    {"I9", "bitmask:layers=3", Is::no_brighter, "bitmask:layers=2"},
    {"I22", "deep-penumbra:bound=0.04", Is::within, "deep-penumbra:bound=0", 0.04},
    {"walls", "layer-rays:layers=2", Is::no_brighter, "layer-rays:layers=2:gap=0"},
    {"layers", "layer-rays:layers=3:gap=0", Is::no_brighter, "layer-rays:layers=2:gap=0"},
    {"insides", "layer-rays:layers=2:solid=on", Is::no_brighter, "layer-rays:layers=2"},
    {"B10", "bitmask:occluder=rect", Is::same, "bitmask:occluder=patch"},
    {"A3", "backproject:fill=edges:search=none", Is::no_brighter, "backproject:fill=none:search=none"},
    {"A3", "backproject:fill=diagonal:search=none", Is::no_brighter, "backproject:fill=edges:search=none"},
    {"layers", "backproject-peel:layers=3:samples=0:depth=first", Is::same,
     "backproject:layers=3:fill=none:search=none"},
    {"one texel", "pcf:window=1:receiverPlane=off", Is::same, "shadow-map:receiverPlane=off"},
    {"dual", "contour:depth=dual:bias=0", Is::same, "contour:bias=0"},
    {"A9", "bitmask:bias=0", Is::no_brighter, "bitmask:depth=midpoint:bias=0"},
};
/// More identities, for the long test. (For those with bias=0: without a bias, the shadows of closed and of open meshes
/// begin at or behind the first surface.)
constexpr Identity kMoreIdentities[] = {
    {"I1", "soft-shadow-map:passes=2:filter=nearest", Is::no_brighter, "soft-shadow-map:filter=nearest"},
    {"I3", "packet", Is::same, "contour:search=none:traversal=flat"},
    {"I3", "packet:packet=1x1:hierarchy=off", Is::same, "contour:search=none:traversal=flat"},
    {"I3, C9", "packet:packet=2x2:divergence=0", Is::same, "contour:search=none:traversal=flat"},
    {"I3", "packet:receiverPlane=off", Is::same, "contour:search=none:traversal=flat:receiverPlane=off"},
    {"I5", "contour:search=mssm:traversal=minmax", Is::same, "contour:search=none:traversal=flat"},
    {"I5", "contour:search=ysm", Is::same, "contour:search=none:traversal=flat"},
    {"I5", "bitmask:search=hsm", Is::same, "bitmask:search=none"},
    {"I5", "bitmask:search=mssm:occluder=triangle", Is::same, "bitmask:search=none:occluder=triangle"},
    {"I5", "bitmask:search=mssm:receiverPlane=off", Is::same, "bitmask:search=none:receiverPlane=off"},
    {"I5", "bitmask:search=mssm:occluder=patch", Is::same_or_black, "bitmask:search=none:occluder=patch"},
    {"I5", "backproject:search=hsm", Is::same_or_black, "backproject:search=none"},
    {"I5", "backproject:search=mssm:fill=none", Is::same_or_black, "backproject:search=none:fill=none"},
    {"I5", "backproject:search=ysm:fill=diagonal", Is::same_or_black, "backproject:search=none:fill=diagonal"},
    {"I5", "backproject:search=hsm:receiverPlane=off", Is::same_or_black, "backproject:search=none:receiverPlane=off"},
    {"I9", "bitmask:layers=2", Is::no_brighter, "bitmask"},
    {"I9", "bitmask:occluder=patch:layers=3", Is::no_brighter, "bitmask:occluder=patch"},
    {"I22", "deep-penumbra:bound=0.2", Is::within, "deep-penumbra:bound=0", 0.2},
    {"B10", "bitmask:occluder=patch:level=2", Is::no_brighter, "bitmask:occluder=rect:level=2"},
    {"A4", "bitmask:occluder=patch:fill=edges:search=none", Is::no_brighter, "bitmask:occluder=patch:search=none"},
    {"A4", "bitmask:occluder=patch:fill=diagonal:search=none", Is::no_brighter,
     "bitmask:occluder=patch:fill=edges:search=none"},
    {"one layer", "backproject-peel:layers=1:samples=0:depth=first", Is::same, "backproject:fill=none:search=none"},
    {"one texel", "pcf:window=1", Is::same, "shadow-map"},
    {"dual", "shadow-map:depth=dual:bias=0", Is::same, "shadow-map:bias=0"},
    {"dual", "pcss:depth=dual:bias=0", Is::same, "pcss:bias=0"},
    {"dual", "parker:depth=dual:bias=0", Is::same, "parker:bias=0"},
    {"dual", "brabec-seidel:depth=dual:bias=0", Is::same, "brabec-seidel:bias=0"},
    {"dual", "bitmask:depth=dual:bias=0", Is::same, "bitmask:bias=0"},
    {"dual", "backproject:depth=dual:bias=0:search=none", Is::same, "backproject:bias=0:search=none"},
    {"A9", "shadow-map:bias=0", Is::no_brighter, "shadow-map:depth=midpoint:bias=0"},
    {"A9", "pcf:bias=0", Is::no_brighter, "pcf:depth=midpoint:bias=0"},
    {"A9", "backproject:bias=0:search=none", Is::no_brighter, "backproject:depth=midpoint:bias=0:search=none"},
    {"A11", "bitmask:depth=midpoint:bias=0", Is::no_brighter, "bitmask:depth=second:bias=0"},
    {"A12", "shadow-map:bias=0.1", Is::no_brighter, "shadow-map:bias=2"},
    {"A12", "accumulate:bias=0.1", Is::no_brighter, "accumulate:bias=2"},
    {"A12", "bitmask:bias=0.1", Is::no_brighter, "bitmask:bias=2"},
    {"A12", "backproject:bias=0.1:search=none", Is::no_brighter, "backproject:bias=2:search=none"},
};

/// A variant, and the number of steps of its V from 0 to 1; 0 stands for the number of light samples.
struct Levels {
  const char* variant;
  std::uint32_t of;
};
constexpr Levels kLevels[] = {{"shadow-map", 1}, {"pcf:window=5", 25},       {"pcf:window=4:receiverPlane=off", 16},
                              {"bitmask", 0},    {"layer-rays:layers=2", 0}, {"bitmask:occluder=rect:level=1", 0},
                              {"accumulate", 0}, {"layered-attenuation", 0}, {"deep-penumbra:bound=0", 0}};

/// Variants for the test that pictures do not depend on order, winding, tiles and repetition.
constexpr const char* kVariants[] = {"shadow-map",
                                     "shadow-map:test=id",
                                     "accumulate",
                                     "adaptive-light:levels=2",
                                     "adaptive-light:levels=2:compare=light",
                                     "deep-penumbra",
                                     "layered-attenuation",
                                     "soft-shadow-map:passes=2",
                                     "soft-shadow-map:form=scatter:depth=dual",
                                     "backproject-peel",
                                     "backproject-peel:samples=9:select=deepest",
                                     "bitmask",
                                     "bitmask:occluder=patch:layers=3:budget=40",
                                     "bitmask:occluder=rect:level=2:receiverPlane=off",
                                     "layer-rays:layers=3:solid=on",
                                     "silhouette-map",
                                     "forward-map",
                                     "forward-map:splat=spline:receiverPlane=off",
                                     "penumbra-map",
                                     "smoothies",
                                     "brabec-seidel",
                                     "kirsch-doellner",
                                     "parker",
                                     "arvo",
                                     "backproject",
                                     "backproject:form=sphere",
                                     "backproject:fill=shared:layers=2:depth=midpoint",
                                     "contour",
                                     "packet:sublights=2:receiverPlane=off",
                                     "packet:subsample=4",
                                     "pcf",
                                     "pcf:test=object",
                                     "pcf:keep=3",
                                     "pcf:test=mean",
                                     "shadow-map:test=object",
                                     "shadow-map:history=4",
                                     "pcss",
                                     "pcss:receiverPlane=off:depth=dual",
                                     "vssm",
                                     "vssm:moments=csm:filter=n-buffer",
                                     "vssm:moments=esm:filter=mip:depth=second",
                                     "convolution",
                                     "occlusion-textures",
                                     "occlusion-textures:filter=n-buffer:depth=midpoint"};

class MapsIdentities : public MapsTest {
 protected:
  /// Makes each method once, and each method's picture of a place once: pipelines take longer than small pictures.
  class Pictures {
   public:
    explicit Pictures(std::uint32_t size) : size_(fmt::format("{}", size)) {}
    visibility::Method& method(const std::string& words) {
      auto& made = methods_[words];
      if (!made) made = MapVariant(words).with(sizes_of(words)).make(device());
      return *made;
    }
    /// Returns nullptr if the method refuses the light.
    const Masks* of(const std::string& words, const Place& place) {
      if (place_ != place.name)
        found_.clear();  // names, not addresses, tell places apart: places are made one after the other
      place_ = place.name;
      const auto [at, fresh] = found_.try_emplace(words);
      if (fresh && can(words, place.stage)) at->second = run(method(words), place.stage);
      return at->second ? &*at->second : nullptr;
    }
    bool can(const std::string& words, const Stage& stage) {
      const visibility::MethodDescription& description = method(words).description();
      return description.lights.contains(stage.light.kind) && (description.textures || !stage.light.texture);
    }

   private:
    [[nodiscard]] visibility::MethodOptions sizes_of(const std::string& words) const {
      visibility::MethodOptions sizes{{"size", size_}};
      if (words.starts_with("soft-shadow-map")) sizes["receiverSize"] = size_;
      return sizes;
    }
    std::string size_;
    std::map<std::string, std::unique_ptr<visibility::Method>> methods_;
    std::map<std::string, std::optional<Masks>> found_;
    std::string place_;
  };

  /// Returns the first pixel at which the identity does not hold, or nullopt.
  static std::optional<std::size_t> first_wrong(const Identity& identity, const Masks& a, const Masks& b) {
    for (std::size_t i = 0; i < a.visibility.size(); ++i) {
      const float v = a.visibility[i], w = b.visibility[i];
      bool holds = v == w;
      switch (identity.is) {
        case Is::same:
          break;
        case Is::no_brighter:
          holds = v <= w;
          break;
        case Is::within:  // V is a float: each is off by 2^-25
          holds = std::abs(static_cast<double>(v) - static_cast<double>(w)) <= identity.by + 0x1p-24;
          break;
        case Is::same_or_black:
          holds = holds || v == 0;
          break;
      }
      const std::size_t words = a.words_per_pixel == b.words_per_pixel ? a.words_per_pixel : 0;
      for (std::size_t k = i * words; k < (i + 1) * words; ++k) {
        if (identity.is == Is::same) holds = holds && a.words[k] == b.words[k];
        if (identity.is == Is::no_brighter) holds = holds && (a.words[k] & ~b.words[k]) == 0;
      }
      if (!holds) return i;
    }
    return std::nullopt;
  }

  static void expect_identities(Pictures& pictures, const Place& place, std::span<const Identity> identities) {
    for (const Identity& identity : identities) {
      const Masks *a = pictures.of(identity.a, place), *b = pictures.of(identity.b, place);
      if (a == nullptr || b == nullptr) continue;
      const auto wrong = first_wrong(identity, *a, *b);
      EXPECT_FALSE(wrong) << place.name << ", " << identity.name << ": " << identity.a << " against " << identity.b
                          << ", pixel " << *wrong << ": " << a->visibility[*wrong] << " and " << b->visibility[*wrong];
    }
  }

  static void expect_levels(Pictures& pictures, const Place& place) {
    for (const Levels& levels : kLevels) {
      const Masks* found = pictures.of(levels.variant, place);
      if (found == nullptr || place.stage.light.texture) continue;
      const double count = levels.of != 0 ? levels.of : place.stage.light.sample_count();
      std::set<float> values(found->visibility.begin(), found->visibility.end());
      for (const float v : values) {
        // V is the float nearest to k / count for a whole number k.
        EXPECT_EQ(v, static_cast<float>(std::round(count * static_cast<double>(v)) / count))
            << place.name << ", I10: " << levels.variant;
      }
      EXPECT_LE(static_cast<double>(values.size()), count + 1) << place.name << ", B1: " << levels.variant;
    }
  }

  /// Expects row I25 (order, winding, tiles and repetition change nothing), and V in [0, 1].
  static void expect_independence(Pictures& pictures, const Place& place, const std::string& words) {
    const Masks* once = pictures.of(words, place);
    if (once == nullptr) return;
    for (const float v : once->visibility) ASSERT_TRUE(v >= 0 && v <= 1) << place.name << ", " << words << ": " << v;
    visibility::Method& method = pictures.method(words);
    const auto expect_same = [&](const char* what, const Masks& other) {
      const auto wrong = first_wrong({what, "", Is::same, ""}, other, *once);
      EXPECT_FALSE(wrong) << place.name << ", I25: " << words << ", " << what << ", pixel " << *wrong << ": "
                          << other.visibility[*wrong] << " for " << once->visibility[*wrong];
    };
    expect_same("in another order", run(method, place.shuffled));
    expect_same("in tiles", run(method, place.stage, 3));
    expect_same("again", run(method, place.stage));
  }
};

TEST_F(MapsIdentities, HoldBetweenVariants) {
  Pictures pictures(20);
  for (const Place& place : few_places()) expect_identities(pictures, place, kIdentities);
}

// A texel outside the kernel whose diagonal neighbour is outside, too, and nearer than all texels in the kernel; this
// scene has one.
TEST_F(MapsIdentities, ASearchFindsTexelsReachedOnlyThroughDiagonals) {
  constexpr Identity kDiagonals[] = {
      {"I5", "backproject:search=ysm:fill=diagonal", Is::same_or_black, "backproject:search=none:fill=diagonal"},
      {"I5", "bitmask:search=ysm:fill=diagonal:occluder=patch", Is::same_or_black,
       "bitmask:search=none:fill=diagonal:occluder=patch"}};
  Pictures pictures(48);
  expect_identities(pictures, shipped_place("self-shadow.json", 24), kDiagonals);
}

TEST_F(MapsIdentities, VIsACount) {
  Pictures pictures(20);
  for (const Place& place : few_places()) expect_levels(pictures, place);
}

TEST_F(MapsIdentities, NoPictureDependsOnOrderWindingTilesOrRepetition) {
  Pictures pictures(20);
  for (const Place& place : std::span(few_places()).last(2)) {
    // The long test runs the other variants.
    for (const char* words : std::span(kVariants).first(12)) expect_independence(pictures, place, words);
  }
}

TEST_F(MapsIdentities, HoldOnManyScenesFull) {
  Pictures pictures(48);
  each_place([&](const Place& place) {
    expect_identities(pictures, place, kIdentities);
    expect_identities(pictures, place, kMoreIdentities);
    expect_levels(pictures, place);
    for (const char* words : kVariants) expect_independence(pictures, place, words);
  });
}

}  // namespace
}  // namespace penumbra::tests
