// SPDX-License-Identifier: Apache-2.0
// Records passes, puts a full barrier between them and measures each by timestamps. Drivers for processors run and
// stamp passes at times of their own choice: there every pass is submitted and timed alone.

#include "render/commands.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "render/vulkan.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace penumbra::render {
namespace {

constexpr std::uint32_t kMaxPasses = 256;  // timestamped passes in a recording; further ones run untimed

/// All earlier commands finish before, and are visible to, all later ones and the host.
void full_barrier(const vk::raii::CommandBuffer& commands) {
  const vk::MemoryBarrier2 barrier(
      vk::PipelineStageFlagBits2::eAllCommands, vk::AccessFlagBits2::eMemoryWrite,
      vk::PipelineStageFlagBits2::eAllCommands | vk::PipelineStageFlagBits2::eHost,
      vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite | vk::AccessFlagBits2::eHostRead);
  commands.pipelineBarrier2(vk::DependencyInfo({}, barrier));
}

}  // namespace

Commands::Commands(const Device& device) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.device = &device.state();
  const vk::CommandBufferAllocateInfo info(*s.device->pool, vk::CommandBufferLevel::ePrimary, 1);
  s.commands = std::move(vk::raii::CommandBuffers(s.device->device, info).front());
  s.fence = vk::raii::Fence(s.device->device, vk::FenceCreateInfo());
  // A driver for processors runs and stamps passes at arbitrary times: there each pass is run and timed alone.
  s.host_timed = s.device->info.kind == "cpu";
  if (!s.host_timed && s.device->limits.timestamp_period > 0) {
    s.queries =
        vk::raii::QueryPool(s.device->device, vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, 2 * kMaxPasses));
  }
}

Commands::~Commands() = default;
Commands::Commands(Commands&&) noexcept = default;
Commands& Commands::operator=(Commands&&) noexcept = default;

void Commands::State::begin_if_needed() {
  if (recording) return;
  commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
  if (*queries) commands.resetQueryPool(*queries, 0, 2 * kMaxPasses);
  recording = true;
}

void Commands::State::open_pass(const std::string& name) {
  if (host_timed) {
    if (recording) run();  // earlier fills and copies do not count as this pass's time
    host_times.push_back({name, 0});
    opened = std::chrono::steady_clock::now();
  }
  begin_if_needed();
  if (device->debug_names) commands.beginDebugUtilsLabelEXT(vk::DebugUtilsLabelEXT(name.c_str()));
  if (*queries && pass_names.size() < kMaxPasses) {
    commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *queries,
                             static_cast<std::uint32_t>(2 * pass_names.size()));
  }
  pass_names.push_back(name);
}

void Commands::State::close_pass() {
  if (*queries && pass_names.size() <= kMaxPasses) {
    commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *queries,
                             static_cast<std::uint32_t>(2 * pass_names.size() - 1));
  }
  if (device->debug_names) commands.endDebugUtilsLabelEXT();
  full_barrier(commands);
  if (host_timed) {
    run();
    host_times.back().milliseconds +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - opened).count();
  }
}

void Commands::State::run() {
  commands.end();
  device->queue.submit(vk::SubmitInfo({}, {}, *commands), *fence);
  wait_for(*device, fence, pass_names.empty() ? "copying" : fmt::format("running {}", fmt::join(pass_names, ", ")));
  device->device.resetFences(*fence);
  recording = false;
}

void Commands::fill(const Buffer& buffer, std::uint32_t value) {
  fill(buffer, value, 0, buffer.bytes());
}

void Commands::fill(const Buffer& buffer, std::uint32_t value, std::uint64_t offset, std::uint64_t bytes) {
  state_->begin_if_needed();
  state_->commands.fillBuffer(*buffer.state().buffer, offset, bytes, value);
  full_barrier(state_->commands);
}

void Commands::host_pass(const std::string& name, const std::function<void()>& work) {
  std::vector<visibility::PassTime> times = submit();
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
  times.push_back({name, elapsed.count()});
  state_->earlier = std::move(times);
}

std::vector<visibility::PassTime> Commands::submit() try {
  State& s = *state_;
  if (s.recording) s.run();
  std::vector<visibility::PassTime> times = std::exchange(s.earlier, {});
  const auto timed = std::min<std::size_t>(s.pass_names.size(), kMaxPasses);
  if (*s.queries && timed > 0) {
    const auto count = static_cast<std::uint32_t>(2 * timed);
    const auto [result, ticks] = s.queries.getResults<std::uint64_t>(
        0, count, count * sizeof(std::uint64_t), sizeof(std::uint64_t), vk::QueryResultFlagBits::e64);
    const std::uint64_t mask = s.device->timestamp_bits >= 64 ? ~0ULL : (1ULL << s.device->timestamp_bits) - 1;
    for (std::size_t i = 0; result == vk::Result::eSuccess && i < timed; ++i) {
      const auto elapsed = (ticks[2 * i + 1] - ticks[2 * i]) & mask;
      times.push_back({s.pass_names[i], static_cast<double>(elapsed) * s.device->limits.timestamp_period * 1e-6});
    }
  }
  std::ranges::move(std::exchange(s.host_times, {}), std::back_inserter(times));
  s.pass_names.clear();
  s.pools.clear();
  return times;
} catch (const vk::SystemError& error) {
  fail(error, fmt::format("running {}", fmt::join(state_->pass_names, ", ")));
}

}  // namespace penumbra::render
