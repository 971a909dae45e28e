// SPDX-License-Identifier: Apache-2.0
// Bounded waits for the device. A driver for processors that could not start its threads (a limit on
// processes) accepts work and never does it; a device can hang. The time that a pass needs is unknown, but if the
// device is this very process, it is known whether it works: then the process's other threads use the processor.
#include "base/error.hpp"
#include "render/vulkan.hpp"

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <ctime>

namespace penumbra::render {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::duration;
using std::chrono::nanoseconds;
using std::chrono::seconds;

nanoseconds time_of(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return seconds(now.tv_sec) + nanoseconds(now.tv_nsec);
}

/// Measures how long the process's other threads have been idle, in turns of the wait, each of which requires this
/// thread to be woken: a process that is stopped, or gets no time at all, does not count as idle.
class IdleTurns {
 public:
  /// Returns the number of consecutive turns, this one included, in which the other threads used no significant time.
  int next() {
    const nanoseconds others = time_of_others();
    const bool idle = others - before_ < std::chrono::microseconds(100);
    before_ = others;
    turns_ = idle ? turns_ + 1 : 0;
    return turns_;
  }

 private:
  static nanoseconds time_of_others() { return time_of(CLOCK_PROCESS_CPUTIME_ID) - time_of(CLOCK_THREAD_CPUTIME_ID); }
  nanoseconds before_ = time_of_others();
  int turns_ = 0;
};

}  // namespace

seconds longest_wait(bool is_processor) {
  if (const char* text = std::getenv("PENUMBRA_DEVICE_TIMEOUT"); text != nullptr) {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text, text + std::strlen(text), value);
    if (error != std::errc() || *end != '\0' || value < 1 || value > 1'000'000'000) {
      throw UsageError("PENUMBRA_DEVICE_TIMEOUT={}: expected a whole number of seconds, 1 or more", text);
    }
    return seconds(value);
  }
  return is_processor ? std::chrono::hours(24) : std::chrono::hours(1);
}

void wait_for(Device::State& device, const vk::raii::Fence& fence, const std::string& what) {
  constexpr std::chrono::milliseconds kTurn(250);
  constexpr int kMostIdleTurns = 80;  // 20 seconds
  const bool is_processor = device.info.kind == "cpu";
  const seconds longest = longest_wait(is_processor);
  const Clock::time_point start = Clock::now();
  IdleTurns idle;
  for (;;) {
    if (device.device.waitForFences(*fence, VK_TRUE, nanoseconds(kTurn).count()) == vk::Result::eSuccess) return;
    if (is_processor && idle.next() >= kMostIdleTurns) {
      abandon(device);
      throw DeviceDoesNotAnswer(
          fmt::format("{}: the device {} was given the work but has made no progress for {:.0f} s; perhaps the driver "
                      "could not start its threads "
                      "(ulimit -u, the control group's pids.max)",
                      what, device.info.name, duration<double>(kTurn * kMostIdleTurns).count()));
    }
    if (Clock::now() - start >= longest) {
      abandon(device);
      throw DeviceDoesNotAnswer(fmt::format(
          "{}: the device {} did not finish within {} s; if the work is that long, set PENUMBRA_DEVICE_TIMEOUT to more "
          "seconds, or choose a smaller --size or fewer --light-samples",
          what, device.info.name, longest.count()));
    }
  }
}

namespace {

template <typename... Arguments>
void forget(void (*&function)(Arguments...)) {
  function = [](Arguments...) {};
}

}  // namespace

void abandon(Device::State& device) {
  device.abandoned = true;
  // The dispatcher belongs to the device, where it is not const.
  auto& calls = const_cast<vk::raii::DeviceDispatcher&>(*device.device.getDispatcher());
  forget(calls.vkDestroyBuffer), forget(calls.vkDestroyBufferView), forget(calls.vkFreeMemory);
  forget(calls.vkDestroyImage), forget(calls.vkDestroyImageView), forget(calls.vkDestroySampler);
  forget(calls.vkFreeCommandBuffers), forget(calls.vkDestroyFence), forget(calls.vkDestroyQueryPool);
  forget(calls.vkDestroyDescriptorPool), forget(calls.vkDestroyDescriptorSetLayout);
  forget(calls.vkDestroyPipeline), forget(calls.vkDestroyPipelineLayout), forget(calls.vkDestroyShaderModule);
}

}  // namespace penumbra::render
