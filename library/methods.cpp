// SPDX-License-Identifier: Apache-2.0
// The version, and the methods with their options, as the families' tables describe them.

#include "session/method_list.hpp"
#include "session/methods.hpp"

#include <penumbra/methods.hpp>
#include <penumbra/penumbra.hpp>

#include <nlohmann/json.hpp>

namespace penumbra {

std::string version() {
  return PENUMBRA_VERSION;
}

std::vector<MethodInfo> methods() {
  std::vector<MethodInfo> all;
  for (const visibility::MethodDescription* method : session::all_methods()) {
    MethodInfo info{.name = method->name,
                    .family = visibility::name_of(method->family),
                    .paper = method->paper,
                    .output = visibility::name_of(method->output),
                    .exact_for = method->exact_for,
                    .lights = session::light_names(*method),
                    .options = {}};
    for (const visibility::OptionDescription& option : method->options) {
      info.options.push_back({.name = option.name,
                              .default_value = option.default_value,
                              .help = option.help,
                              .choices = option.choices,
                              .least = option.least,
                              .most = option.most,
                              .whole = option.whole});
    }
    all.push_back(std::move(info));
  }
  return all;
}

std::string methods_json() {
  return session::methods_json().dump(2);
}

}  // namespace penumbra
