#include "app/device_source.hpp"

#include "base/error.hpp"

#include <fmt/ranges.h>

#include <cstdlib>
#include <string_view>
#include <system_error>
#include <utility>

namespace penumbra::app {

DeviceSource::DeviceSource(std::string wanted) {
  options_.wanted = std::move(wanted);
  const char* validation = std::getenv("PENUMBRA_VALIDATION");
  options_.validation = validation != nullptr && std::string_view(validation) == "1";
}

void DeviceSource::begin() {
  if (device_ || making_.valid()) return;
  try {
    making_ = std::async(std::launch::async, [this] { device_.emplace(options_); });
  } catch (const std::system_error&) {  // no thread can be had: then it is made when asked for
  }
}

const render::Device& DeviceSource::device() {
  if (making_.valid()) making_.get();
  if (!device_) device_.emplace(options_);
  return *device_;
}

std::string DeviceSource::name() const {
  if (making_.valid()) making_.wait();
  return device_ ? device_->info().name : "none";
}

void DeviceSource::check_validation() const {
  if (making_.valid()) making_.wait();
  if (!device_) return;
  const auto messages = device_->take_validation_messages();
  if (messages.empty()) return;
  throw ResourceError("the Vulkan validation layer objects ({} messages); results cannot be trusted:\n{}",
                      messages.size(), fmt::join(messages, "\n"));
}

}  // namespace penumbra::app
