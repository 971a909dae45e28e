#pragma once

#include "app/pictures/picture_file.hpp"
#include "network/tev_client.hpp"

#include <string>

namespace CLI {
class App;
}

namespace penumbra::app {

/// Adds --tev to a command.
void add_tev(CLI::App& command, std::string& address);

/// Pictures in an open tev, beside their files.
class TevPictures {
 public:
  /// `address`: HOST:PORT. Throws UsageError, or ResourceError if nobody answers there.
  explicit TevPictures(const std::string& address) : client_(address) {}

  /// Shows R G B A, V and, of several lights, V of each, as OUT.exr has them. One of the same name is replaced.
  void show(const std::string& name, const PictureContent& content);

 private:
  network::TevClient client_;
};

}  // namespace penumbra::app
