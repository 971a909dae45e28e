// SPDX-License-Identifier: Apache-2.0
// Tests which packets search for contours together (Yang et al. 2009, section 4.3, equations 4 to 6), which depends on
// the kernels of a packet's pixels. V is the same either way (MapsContourVariants): only counters show an error in a
// cost or a chance.

#include "maps/host/map_fit.hpp"
#include "tests/analytic/maps/backprojection/contour_scenes.hpp"

#include <random>

namespace penumbra::tests {
namespace {

constexpr std::uint32_t kAcross = 4, kDown = 2;  // pixels of a packet
constexpr double kLampHeight = 5, kPlate = 2.5;  // heights over the floor

/// Pixels of a packet, in the light's frame.
using Packet = std::array<glm::dvec3, std::size_t{kAcross} * kDown>;

/// The light's centre is over the edge of a plate, which every kernel crosses: no pixel is trivial, and nothing in
/// front of a receiver is nearer to the light than the plate.
scenes::Scene over_an_edge() {
  scenes::Scene scene = contour_floor(0.2);
  scene.objects[0].casts_shadow = false;
  add_quad(scene, {0, kPlate, -3}, {6, 0, 0}, {0, 0, 3}).receives_shadow = false;
  return scene;
}

class Kernels {
 public:
  Kernels(const Stage& stage, std::uint32_t size) : basis_(maps::light_basis(stage.light)), size_(size) {
    const maps::LightBounds bounds = maps::light_bounds(stage.light, basis_);
    half_ = bounds.upper;
    const glm::vec3 centre(basis_.center);
    const auto fitted = maps::fit_views(stage.floats, stage.light, basis_, std::span(&centre, 1),
                                        {.size = size, .reach = glm::max(-bounds.lower, bounds.upper)});
    EXPECT_EQ(fitted.faces, 1U);
    far_ = fitted.views.front().far;
    lower_ = fitted.views.front().side[0].lower;
    texel_ = (glm::dvec2(fitted.views.front().side[0].upper) - lower_) / static_cast<double>(size);
  }
  struct Cells {
    glm::dvec2 first, last;
    [[nodiscard]] double count() const {
      const glm::dvec2 extent = last - first + 1.0;
      return extent.x * extent.y;
    }
  };
  /// Returns the receiver's kernel: the cells between the texels that it sees in front of the light, and one more on
  /// each side. Returns nullopt where rounding may choose another texel, or the map ends.
  [[nodiscard]] std::optional<Cells> operator()(const glm::dvec3& e) const {
    constexpr double kNear = kLampHeight - kPlate;
    const glm::dvec2 at(e.x / e.z, e.y / e.z), reach = half_ * (1 / kNear - 1 / e.z);
    const glm::dvec2 from = (at - reach - lower_) / texel_, to = (at + reach - lower_) / texel_;
    for (const glm::dvec2& border : {from, to}) {
      const glm::dvec2 part = border - glm::floor(border);
      if (std::min(part.x, part.y) < 0.01 || std::max(part.x, part.y) > 0.99) return std::nullopt;
      if (std::min(border.x, border.y) < 1 || std::max(border.x, border.y) > size_ - 1) return std::nullopt;
    }
    return Cells{glm::floor(from), glm::floor(to) + 1.0};
  }
  [[nodiscard]] double far() const { return far_; }
  [[nodiscard]] glm::dvec3 world(const glm::dvec3& e) const {
    return basis_.center + e.x * basis_.u + e.y * basis_.v + e.z * basis_.n;
  }

 private:
  maps::LightBasis basis_;
  double size_, far_ = 0;
  glm::dvec2 half_{0}, lower_{0}, texel_{1};
};

/// The packet's cost over the sum of its pixels' costs (equation 6), and the probability that some texel separates the
/// packet (equations 4 and 5).
struct Odds {
  double cost = 0, apart = 0;
};
std::optional<Odds> odds_of(const Kernels& kernels, const Packet& packet) {
  Kernels::Cells all{glm::dvec2(1e9), glm::dvec2(-1e9)};
  double alone = 0, nearest = 1e9, deepest = 0;
  for (const glm::dvec3& e : packet) {
    const auto cells = kernels(e);
    if (!cells) return std::nullopt;
    all = {glm::min(all.first, cells->first), glm::max(all.last, cells->last)};
    const double width = std::sqrt(cells->count());
    alone += (std::log2(width) + 2) * width;
    nearest = std::min(nearest, e.z);
    deepest = std::max(deepest, e.z);
  }
  const double width = std::sqrt(all.count());
  // Depths range from the plate's to the one that stands for an empty texel.
  const double null_share = (deepest - nearest) / (kernels.far() - (kLampHeight - kPlate));
  return Odds{(std::log2(width) + 1 + static_cast<double>(packet.size())) * width / alone,
              1 - std::pow(1 - null_share, all.count())};
}

class PacketCosts : public ContourTest {
 protected:
  static constexpr std::uint32_t kSize = 128, kColumns = 20, kRows = 20;

  /// Returns as many packets as the picture has: those made by `make` (random, all alike in the light's frame) that
  /// `fits` accepts.
  template <typename Make, typename Fits>
  static std::vector<Packet> choose(const Kernels& kernels, const Make& make, const Fits& fits) {
    std::vector<Packet> packets;
    for (int tries = 0; packets.size() < std::size_t{kColumns} * kRows && tries < 2000000; ++tries) {
      const Packet packet = make();
      const auto odds = odds_of(kernels, packet);
      if (odds && fits(*odds)) packets.push_back(packet);
    }
    return packets;
  }

  static Stage stage_of(const Kernels& kernels, const std::vector<Packet>& packets) {
    const auto samples_of = [&](const visibility::SceneFloats& /*floats*/,
                                const visibility::PinholeCamera& /*camera*/) {
      visibility::ViewSamples samples;
      samples.width = kColumns * kAcross;
      samples.height = kRows * kDown;
      for (std::uint32_t i = 0; i < samples.width * samples.height; ++i) {
        const std::uint32_t x = i % samples.width, y = i / samples.width;
        const Packet& packet = packets[std::size_t{y / kDown} * kColumns + x / kAcross];
        samples.triangle.push_back(0);
        samples.p.emplace_back(kernels.world(packet.at(y % kDown * kAcross + x % kAcross)));
        samples.n.emplace_back(0, 1, 0);
        samples.depth.push_back(1);
        samples.facing.push_back(1);
      }
      return samples;
    };
    return {over_an_edge(), kColumns * kAcross, kRows * kDown, light_samples(1), samples_of};
  }

  static double parted(const Stage& stage, double divergence) {
    return counted(maps::make_packet, stage,
                   {{"size", fmt::format("{}", kSize)},
                    {"packet", fmt::format("{}x{}", kAcross, kDown)},
                    {"divergence", fmt::format("{}", divergence)}})
        .count("packetsParted");
  }
};

// Pixels at one height, spread so that searching together costs about as much as searching one by one. If a node, an
// edge or an area cost 2 % more, the quotient would move by at least 0.002, and an interval of 0.001 has seven packets.
TEST_F(PacketCosts, PacketsArePartedWhereTheyWouldCostMoreThanTheirPixels) {
  const Kernels kernels(Stage(over_an_edge(), 1, 1, light_samples(1)), kSize);
  std::mt19937 random(4);
  const auto number = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  const auto make = [&] {
    const glm::dvec2 middle(number(-1, 1), number(-0.05, 0.05)), spread(number(0.5, 2.5), number(0.01, 0.05));
    Packet packet;
    for (glm::dvec3& e : packet) e = {middle + spread * glm::dvec2(number(-1, 1), number(-1, 1)), kLampHeight};
    return packet;
  };
  const auto packets = choose(kernels, make, [](const Odds& odds) {
    return std::abs(odds.cost - 1) < 0.03 && std::abs(odds.cost - 1) > 1e-4;  // the device takes logarithms of floats
  });
  ASSERT_EQ(packets.size(), std::size_t{kColumns} * kRows);
  const auto dear =
      std::ranges::count_if(packets, [&](const Packet& packet) { return odds_of(kernels, packet)->cost > 1; });
  EXPECT_GT(dear, 100);
  EXPECT_EQ(parted(stage_of(kernels, packets), 0.5), static_cast<double>(dear));
}

// Pixels close together at several heights. If the chance that a texel lies between them, or the number of such texels,
// were off by 2 %, an even chance would move by 0.007, and an interval of 0.001 has two packets.
TEST_F(PacketCosts, PacketsArePartedWhereATexelMayLieBetweenTheirPixels) {
  const Kernels kernels(Stage(over_an_edge(), 1, 1, light_samples(1)), kSize);
  std::mt19937 random(5);
  const auto number = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  const auto make = [&] {
    const glm::dvec2 middle(number(-1.5, 1.5), number(-0.05, 0.05));
    const double apart = number(0.0005, 0.1);
    Packet packet;
    for (glm::dvec3& e : packet)
      e = {middle + glm::dvec2(number(-0.05, 0.05), number(-0.05, 0.05)), kLampHeight - number(0, apart)};
    return packet;
  };
  const auto packets = choose(kernels, make, [](const Odds& odds) {
    return odds.cost < 0.99 && std::abs(odds.apart - 0.5) < 0.1 &&
           std::abs(odds.apart - 0.5) > 2e-3;  // the device takes powers of floats
  });
  ASSERT_EQ(packets.size(), std::size_t{kColumns} * kRows);
  const auto apart =
      std::ranges::count_if(packets, [&](const Packet& packet) { return odds_of(kernels, packet)->apart > 0.5; });
  EXPECT_GT(apart, 100);
  EXPECT_EQ(parted(stage_of(kernels, packets), 0.5), static_cast<double>(apart));
}

}  // namespace
}  // namespace penumbra::tests
