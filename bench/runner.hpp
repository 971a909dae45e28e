// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/adaptive_rays.hpp"
#include "bench/entry.hpp"
#include "bench/question.hpp"
#include "reference/plain_rays.hpp"
#include "session/machine.hpp"
#include "session/options.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace penumbra::bench {

/// Contestant: runs on questions and is timed. `question` must outlive its runs.
class Runner {
 public:
  virtual ~Runner() = default;

  /// Sets a new question; discards earlier times.
  void ask(const Question& question);
  /// Runs once. `timed` is false for the discarded run, in which pairs are counted.
  void run(bool timed);
  /// Returns V of each pixel, of the last run.
  [[nodiscard]] std::span<const float> visibility() const { return visibility_; }
  /// Returns the sum of `light` + `evaluate` of all timed runs.
  [[nodiscard]] double spent() const;
  /// Returns the result without errors.
  [[nodiscard]] virtual Contestant result() const = 0;

 protected:
  struct Seconds {
    double light = 0, evaluate = 0;
  };
  virtual Seconds run_once(const Question& question, std::vector<float>& visibility, bool timed) = 0;
  virtual void prepare(const Question& question) = 0;
  [[nodiscard]] const Times& times() const { return times_; }

 private:
  const Question* question_ = nullptr;
  Times times_;
  std::vector<float> visibility_;
};

/// Method of the program, on a separate Vulkan device (if it needs one), because a device counts its allocated memory
/// in total, not for each method.
class MethodRunner final : public Runner {
 public:
  MethodRunner(const session::MethodEntry& entry, const Ground& ground, const std::string& device);

  [[nodiscard]] Contestant result() const override;
  /// Stores the masks of the discarded run in `masks` and counts no pairs; for the oracle.
  void keep_masks(std::vector<std::uint32_t>& masks) { kept_ = &masks; }

 private:
  Seconds run_once(const Question& question, std::vector<float>& visibility, bool timed) override;
  void prepare(const Question& question) override;
  void take_masks(const Question& question, const visibility::Tile& tile);

  session::MethodEntry entry_;
  std::string where_;
  render::Machine machine_;
  std::unique_ptr<visibility::Method> method_;
  double mesh_ = 0;
  std::vector<visibility::PassTime> passes_;
  std::vector<std::uint32_t>* kept_ = nullptr;
  std::optional<compare::PairCounts> pairs_;
};

/// Embree, with the packet size that is fastest on this subject and processor. Shared by all ray casters.
class FastestRays {
 public:
  explicit FastestRays(const Ground& ground);
  [[nodiscard]] reference::PlainRays& rays() { return *rays_; }
  [[nodiscard]] int packet() const { return packet_; }
  [[nodiscard]] double mesh_seconds() const { return mesh_; }

 private:
  std::optional<reference::PlainRays> rays_;
  int packet_ = 0;
  double mesh_ = 0;
};

/// Ray caster on Embree, a peer with which methods are compared.
class RayRunner final : public Runner {
 public:
  RayRunner(Peer peer, const Ground& ground, FastestRays& rays);

  [[nodiscard]] const Peer& peer() const { return peer_; }
  [[nodiscard]] Contestant result() const override;

 private:
  Seconds run_once(const Question& question, std::vector<float>& visibility, bool timed) override;
  void prepare(const Question& question) override;

  Peer peer_;
  FastestRays& rays_;
  visibility::ViewSamples chosen_;  ///< view samples to be traced; the others are set to background
  AdaptiveRays adaptive_;
  std::uint64_t asked_ = 0;  ///< view samples that got all light samples
};

}  // namespace penumbra::bench
