// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "network/tev_client.hpp"
#include "session/pictures/picture_file.hpp"

#include <string>

namespace penumbra::session {

/// Shows pictures in an open tev, in addition to their files.
class TevPictures {
 public:
  /// Connects to `address`: HOST:PORT. Throws UsageError if it is invalid, ResourceError if the connection fails.
  explicit TevPictures(const std::string& address) : client_(address) {}

  /// Shows R G B A, V and, if there are several lights, V of each, as in OUT.exr. Replaces a picture of the same name.
  void show(const std::string& name, const PictureContent& content);

 private:
  network::TevClient client_;
};

}  // namespace penumbra::session
