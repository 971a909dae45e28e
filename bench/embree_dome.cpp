// SPDX-License-Identifier: Apache-2.0
// A plain program on Embree under one dome: the peer of bench/domes.py --peer.
//   embree_dome SCENE.json TRUTH.exr [SAMPLES | OTHER.exr] ...
// Takes the view samples of TRUTH.exr, a picture of the scene by `penumbra render` with exact areas, and prints a line
// for each further argument. For a number it traces that many rays per view sample, in directions of a scrambled
// (0, 2)-sequence with a density in proportion to the light that would arrive, and prints processor and wall seconds,
// and the error of V against the truth. For a picture of the same view samples it prints the error. Errors are RMSE of
// V, and RMSE divided by the mean of V.

#include "base/error.hpp"
#include "base/exr.hpp"
#include "bench/embree_mesh.hpp"
#include "scenes/formats/reader.hpp"
#include "visibility/dome_picture.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace penumbra::bench {
namespace {

constexpr std::uint32_t kBackground = std::numeric_limits<std::uint32_t>::max();
/// Distance of a ray's origin from its surface, in the scene's unit; the scenes are a few units large.
constexpr float kOffset = 1e-5f;

struct ViewSample {
  glm::vec3 p{0}, n{0};  // relative to the scene's origin
  std::uint32_t triangle = kBackground;
  float truth = 0;
};

std::vector<ViewSample> view_samples(const ExrFile& file) {
  const auto channel = [&](const char* name) -> const std::vector<float>& { return file.floats.at(name); };
  std::vector<ViewSample> samples(file.integers.at("id").size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].p = {channel("Prel.X")[i], channel("Prel.Y")[i], channel("Prel.Z")[i]};
    samples[i].n = {channel("N.X")[i], channel("N.Y")[i], channel("N.Z")[i]};
    samples[i].triangle = file.integers.at("id")[i];
    samples[i].truth = channel("V")[i];
  }
  return samples;
}

/// Returns point i of Sobol's (0, 2)-sequence, scrambled by two random words.
std::array<double, 2> sequence_point(std::uint32_t i, std::uint32_t first, std::uint32_t second) {
  std::uint32_t x = 0, y = 0;
  for (std::uint32_t bit = 1u << 31u, v = 1u << 31u; i != 0; i >>= 1u, bit >>= 1u, v ^= v >> 1u) {
    if ((i & 1u) == 0) continue;
    x ^= bit;
    y ^= v;
  }
  return {((x ^ first) + 0.5) * 0x1p-32, ((y ^ second) + 0.5) * 0x1p-32};
}

/// Returns the random word of a pixel (PCG-RXS-M-XS, O'Neill 2014).
std::uint32_t random_word(std::uint32_t seed) {
  const std::uint32_t state = seed * 747796405u + 2891336453u;
  const std::uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

/// Running sums of weights, from which entries are drawn with probabilities in proportion to their weights.
class Sums {
 public:
  void clear() { sums_.assign(1, 0); }
  void add(double weight) { sums_.push_back(sums_.back() + weight); }
  [[nodiscard]] double all() const { return sums_.back(); }
  /// Returns the index of the entry at u, in [0, 1), and replaces u by the position within this entry.
  std::size_t draw(double& u) const {
    const double at = u * all();
    const auto above = std::upper_bound(sums_.begin() + 1, sums_.end() - 1, at);
    const auto i = static_cast<std::size_t>(above - sums_.begin()) - 1;
    const double weight = sums_[i + 1] - sums_[i];
    u = weight > 0 ? std::clamp((at - sums_[i]) / weight, 0.0, 1.0) : 0.5;
    return i;
  }

 private:
  std::vector<double> sums_ = {0};
};

struct Drawn {
  glm::dvec3 direction;
  double weight = 0;  // light that would arrive from there, divided by the density of directions
};

/// Draws directions with a density in proportion to a constant radiance times the cosine.
class ConstantDome {
 public:
  explicit ConstantDome(const scenes::Dome& dome) : dome_(dome) {}
  void look(const glm::dvec3& n) {
    n_ = n;
    u_ = glm::normalize(glm::cross(n, std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    v_ = glm::cross(n, u_);
  }
  /// Maps the square to the disk by rings (P. Shirley, K. Chiu 1997), and the disk to the half sphere above it.
  [[nodiscard]] Drawn draw(std::array<double, 2> u) const {
    const double a = 2 * u[0] - 1, b = 2 * u[1] - 1;
    const bool wide = std::abs(a) > std::abs(b);
    const double radius = wide ? a : b;
    const double angle = radius == 0 ? 0
                         : wide      ? std::numbers::pi / 4 * b / a
                                     : std::numbers::pi / 2 - std::numbers::pi / 4 * a / b;
    const double x = radius * std::cos(angle), y = radius * std::sin(angle);
    const glm::dvec3 d = x * u_ + y * v_ + std::sqrt(std::max(0.0, 1 - radius * radius)) * n_;
    return {d, dome_.half && glm::dot(d, dome_.up) <= 0 ? 0.0 : 1.0};
  }

 private:
  const scenes::Dome& dome_;
  glm::dvec3 n_{0}, u_{0}, v_{0};
};

/// Draws directions with a density in proportion to a picture's luminance times a bound of the cosine in each block of
/// texels.
class PictureDome {
 public:
  PictureDome(const scenes::Dome& dome, const scenes::Texture& picture)
      : picture_(picture), frame_(visibility::dome_frame(dome.up, dome.rotate)) {
    rows_ = (picture.height + kBlock - 1) / kBlock, columns_ = (picture.width + kBlock - 1) / kBlock;
    blocks_.resize(std::size_t{rows_} * columns_);
    for (std::uint32_t y = 0; y < rows_; ++y)
      for (std::uint32_t x = 0; x < columns_; ++x) make_block(x, y, dome.half);
  }
  void look(const glm::dvec3& n) {
    n_ = n;
    of_columns_.resize(rows_);
    of_rows_.clear();
    bounds_.resize(blocks_.size());
    for (std::uint32_t y = 0; y < rows_; ++y) {
      of_columns_[y].clear();
      for (std::uint32_t x = 0; x < columns_; ++x) {
        const std::size_t i = std::size_t{y} * columns_ + x;
        const Block& block = blocks_[i];
        const double cosine = glm::dot(n, block.middle), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        bounds_[i] = cosine >= block.cosine ? 1 : std::max(0.0, cosine * block.cosine + sine * block.sine);
        of_columns_[y].add(block.light * bounds_[i]);
      }
      of_rows_.add(of_columns_[y].all());
    }
  }
  [[nodiscard]] Drawn draw(std::array<double, 2> u) const {
    const std::size_t row = of_rows_.draw(u[0]), column = of_columns_[row].draw(u[1]);
    const std::size_t i = row * columns_ + column;
    const std::size_t y = blocks_[i].rows.draw(u[0]);
    const std::size_t x = blocks_[i].columns[y].draw(u[1]);
    const auto texel_y = static_cast<double>(row * kBlock + y), texel_x = static_cast<double>(column * kBlock + x);
    const double top = height(texel_y), bottom = height(texel_y + 1);
    const glm::dvec3 d =
        frame_.direction({top + u[0] * (bottom - top), (texel_x + u[1]) / static_cast<double>(picture_.width)});
    return {d, bounds_[i] > 0 ? std::max(0.0, glm::dot(n_, d)) / bounds_[i] : 0};
  }

 private:
  static constexpr std::uint32_t kBlock = 4;  // texels
  struct Block {
    double light = 0;
    glm::dvec3 middle{0};
    double cosine = 1, sine = 0;  // of the angle from the middle to the farthest corner
    Sums rows;
    std::array<Sums, kBlock> columns;
  };

  [[nodiscard]] double height(double row) const { return std::cos(std::numbers::pi * row / picture_.height); }

  void make_block(std::uint32_t x, std::uint32_t y, bool half) {
    Block& block = blocks_[std::size_t{y} * columns_ + x];
    const std::uint32_t x0 = x * kBlock, y0 = y * kBlock, x1 = std::min(x0 + kBlock, picture_.width),
                        y1 = std::min(y0 + kBlock, picture_.height);
    for (std::uint32_t row = y0; row < y1; ++row) {
      const double top = height(row), bottom = height(row + 1);
      Sums& columns = block.columns.at(row - y0);
      for (std::uint32_t column = x0; column < x1; ++column) {
        const glm::vec3 texel = picture_.texels[std::size_t{row} * picture_.width + column];
        columns.add(half && bottom < -1e-12 ? 0 : visibility::luminance_of(texel) * (top - bottom));
      }
      block.rows.add(columns.all());
    }
    block.light = block.rows.all();
    const auto at = [&](double column, double row) { return frame_.direction({height(row), column / picture_.width}); };
    block.middle = at((x0 + x1) / 2.0, (y0 + y1) / 2.0);
    // The point of a block that is farthest from its middle is a corner, or lies on the longer of its two parallels.
    for (const double column : {static_cast<double>(x0), (x0 + x1) / 2.0, static_cast<double>(x1)})
      for (const double row : {static_cast<double>(y0), static_cast<double>(y1)})
        block.cosine = std::min(block.cosine, glm::dot(block.middle, at(column, row)));
    block.sine = std::sqrt(std::max(0.0, 1 - block.cosine * block.cosine));
  }

  const scenes::Texture& picture_;
  visibility::DomeFrame frame_;
  std::uint32_t rows_ = 0, columns_ = 0;
  std::vector<Block> blocks_;
  glm::dvec3 n_{0};
  Sums of_rows_;
  std::vector<Sums> of_columns_;
  std::vector<double> bounds_;  // of the cosine, of each block
};

template <int lanes>
struct Packet;
template <>
struct Packet<8> {
  using Rays = RTCRay8;
  static void trace(const int* valid, RTCScene scene, RTCIntersectContext* context, Rays* rays) {
    rtcOccluded8(valid, scene, context, rays);
  }
};
template <>
struct Packet<16> {
  using Rays = RTCRay16;
  static void trace(const int* valid, RTCScene scene, RTCIntersectContext* context, Rays* rays) {
    rtcOccluded16(valid, scene, context, rays);
  }
};

/// Returns V of one view sample, with directions drawn by `dome`.
template <int lanes, typename Dome>
float visible_share(RTCScene scene, const ViewSample& sample, const Dome& dome, std::uint32_t count,
                    std::uint32_t seed) {
  const std::uint32_t first = random_word(2 * seed), second = random_word(2 * seed + 1);
  const glm::vec3 p = sample.p + kOffset * sample.n;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  double all = 0, seen = 0;
  const auto add = [&](double weight, float tfar) {
    all += weight;
    if (tfar > 0) seen += weight;
  };
  if constexpr (lanes == 1) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const Drawn drawn = dome.draw(sequence_point(i, first, second));
      if (drawn.weight == 0) continue;
      RTCRay ray{};
      ray.org_x = p.x, ray.org_y = p.y, ray.org_z = p.z;
      ray.dir_x = static_cast<float>(drawn.direction.x), ray.dir_y = static_cast<float>(drawn.direction.y),
      ray.dir_z = static_cast<float>(drawn.direction.z);
      ray.tfar = std::numeric_limits<float>::infinity();
      ray.mask = ~0u;
      rtcOccluded1(scene, &context, &ray);
      add(drawn.weight, ray.tfar);
    }
  } else {
    for (std::uint32_t begun = 0; begun < count; begun += lanes) {
      alignas(64) std::array<int, lanes> valid{};
      std::array<double, lanes> weights{};
      typename Packet<lanes>::Rays rays{};
      for (std::uint32_t lane = 0; lane < lanes && begun + lane < count; ++lane) {
        const Drawn drawn = dome.draw(sequence_point(begun + lane, first, second));
        weights.at(lane) = drawn.weight;
        if (drawn.weight == 0) continue;
        valid.at(lane) = -1;
        rays.org_x[lane] = p.x, rays.org_y[lane] = p.y, rays.org_z[lane] = p.z;
        rays.dir_x[lane] = static_cast<float>(drawn.direction.x);
        rays.dir_y[lane] = static_cast<float>(drawn.direction.y);
        rays.dir_z[lane] = static_cast<float>(drawn.direction.z);
        rays.tfar[lane] = std::numeric_limits<float>::infinity();
        rays.mask[lane] = ~0u;
      }
      Packet<lanes>::trace(valid.data(), scene, &context, &rays);
      for (std::size_t lane = 0; lane < lanes; ++lane)
        if (valid.at(lane) != 0) add(weights.at(lane), rays.tfar[lane]);
    }
  }
  return all > 0 ? static_cast<float>(seen / all) : 0;
}

/// Returns V of all view samples. Tables for a normal are kept while consecutive view samples are on the same triangle.
template <int lanes, typename Dome>
std::vector<float> traced(RTCScene scene, const std::vector<ViewSample>& samples, const Dome& dome,
                          std::uint32_t count) {
  std::vector<float> v(samples.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, samples.size(), 256), [&](const auto& range) {
    Dome own = dome;
    std::uint32_t triangle = kBackground;
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      if (samples[i].triangle == kBackground) continue;
      if (samples[i].triangle != triangle) own.look(glm::normalize(glm::dvec3(samples[i].n)));
      triangle = samples[i].triangle;
      v[i] = visible_share<lanes>(scene, samples[i], own, count, static_cast<std::uint32_t>(i));
    }
  });
  return v;
}

struct Error {
  double rmse = 0, mean = 0;
};
Error error_of(const std::vector<float>& v, const std::vector<ViewSample>& samples) {
  double squares = 0, sum = 0;
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (samples[i].triangle == kBackground) continue;
    const double error = static_cast<double>(v[i]) - static_cast<double>(samples[i].truth);
    squares += error * error, sum += static_cast<double>(samples[i].truth), ++count;
  }
  if (count == 0) throw InputError("no view sample lies on a surface");
  const auto n = static_cast<double>(count);
  return {std::sqrt(squares / n), sum / n};
}

double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

using Tracer = std::function<std::vector<float>(std::uint32_t)>;

/// Returns the fastest of single rays and packets, by processor seconds.
template <typename Dome>
std::pair<int, Tracer> fastest(RTCScene scene, const std::vector<ViewSample>& samples, const Dome& dome) {
  const std::array<std::pair<int, Tracer>, 3> all = {
      {{1, [&](std::uint32_t count) { return traced<1>(scene, samples, dome, count); }},
       {8, [&](std::uint32_t count) { return traced<8>(scene, samples, dome, count); }},
       {16, [&](std::uint32_t count) { return traced<16>(scene, samples, dome, count); }}}};
  constexpr std::uint32_t kTried = 64;
  std::pair<int, Tracer> best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& one : all) {
    static_cast<void>(one.second(kTried));
    const double before = processor_seconds();
    static_cast<void>(one.second(kTried));
    const double seconds = processor_seconds() - before;
    if (seconds < least) best = one, least = seconds;
  }
  return best;
}

void print_traced(const Tracer& tracer, int lanes, std::uint32_t count, const std::vector<ViewSample>& samples) {
  const auto begin = std::chrono::steady_clock::now();
  const double before = processor_seconds();
  const std::vector<float> v = tracer(count);
  const double seconds = processor_seconds() - before;
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  const Error error = error_of(v, samples);
  fmt::print(
      R"({{"samples": {}, "packet": {}, "processor": {:.4g}, "wall": {:.4g}, "rmse": {:.4g}, "relative": {:.4g}}})"
      "\n",
      count, lanes, seconds, wall.count(), error.rmse, error.rmse / error.mean);
}

int run(const std::string& file, const std::string& truth, const std::vector<std::string>& asked) {
  const scenes::Scene scene = scenes::read_scene(file);
  const scenes::AreaLight& light = scene.lights.front();
  const auto* const dome = std::get_if<scenes::Dome>(&light.shape);
  if (scene.lights.size() != 1 || dome == nullptr) throw UsageError("{}: expected one light, a dome", file);
  const ExrFile picture = read_exr(truth);
  const std::vector<ViewSample> samples = view_samples(picture);
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene whole = robust_scene(device, scene.soup, picture.vectors.at("penumbra.origin"));
  std::optional<ConstantDome> constant;
  std::optional<PictureDome> pictured;
  std::optional<std::pair<int, Tracer>> tracer;
  for (const std::string& text : asked) {
    std::uint32_t count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc() || end != text.data() + text.size() || count == 0) {
      const Error found = error_of(read_exr(text).floats.at("V"), samples);
      fmt::print(R"({{"rmse": {:.4g}, "relative": {:.4g}}})"
                 "\n",
                 found.rmse, found.rmse / found.mean);
      continue;
    }
    if (!tracer && light.texture)
      tracer = fastest(whole, samples, pictured.emplace(*dome, *light.texture));
    else if (!tracer)
      tracer = fastest(whole, samples, constant.emplace(*dome));
    print_traced(tracer->second, tracer->first, count, samples);
  }
  rtcReleaseScene(whole);
  rtcReleaseDevice(device);
  return 0;
}

}  // namespace
}  // namespace penumbra::bench

int main(int count, char** words) {
  if (count < 4) {
    fmt::print(stderr, "embree_dome SCENE.json TRUTH.exr [SAMPLES | OTHER.exr] ...\n");
    return 2;
  }
  try {
    return penumbra::bench::run(words[1], words[2], {words + 3, words + count});
  } catch (const std::exception& error) {
    fmt::print(stderr, "embree_dome: {}\n", error.what());
    return 3;
  }
}
