#include "engines/engine_choice.hpp"

#include "base/error.hpp"

namespace penumbra::engines {

bool runs_natively(const render::Device& device, const visibility::MethodOptions& options, const std::string& method) {
  const auto found = options.find("engine");
  const std::string engine = found == options.end() ? "auto" : found->second;
  if (engine == "auto") return device.info().kind == "cpu";
  if (engine == "vulkan" || engine == "native") return engine == "native";
  throw UsageError("{}: engine is auto, vulkan or native, not \"{}\"", method, engine);
}

}  // namespace penumbra::engines
