#include "app/device_source.hpp"

#include "base/error.hpp"

#include <fmt/ranges.h>

#include <cstdlib>
#include <string_view>
#include <utility>

namespace penumbra::app {

DeviceSource::DeviceSource(std::string wanted) {
  options_.wanted = std::move(wanted);
  const char* validation = std::getenv("PENUMBRA_VALIDATION");
  options_.validation = validation != nullptr && std::string_view(validation) == "1";
}

const render::Device& DeviceSource::device() {
  if (!device_) device_.emplace(options_);
  return *device_;
}

std::string DeviceSource::name() const {
  return device_ ? device_->info().name : "none";
}

void DeviceSource::check_validation() const {
  if (!device_) return;
  const auto messages = device_->take_validation_messages();
  if (messages.empty()) return;
  throw ResourceError("the Vulkan validation layer objects ({} messages); results cannot be trusted:\n{}",
                      messages.size(), fmt::join(messages, "\n"));
}

}  // namespace penumbra::app
