// SPDX-License-Identifier: Apache-2.0
// Entry of the program: the one place that catches what commands throw, and turns it into a message and an exit code.

#include "app/commands.hpp"
#include "app/process/process.hpp"
#include "render/device.hpp"
#include "session/process/interrupt.hpp"

#include <cstdlib>

int main(int argc, char** argv) {
  try {
    penumbra::app::prepare_process();
    penumbra::session::watch_for_interrupts();
    return penumbra::app::run_command_line(argc, argv);
  } catch (const penumbra::render::DeviceDoesNotAnswer&) {
    // The driver's threads may still be running: the handlers of a regular exit would destroy data used by these
    // threads.
    std::_Exit(penumbra::app::explain_current_exception());
  } catch (...) {
    return penumbra::app::explain_current_exception();
  }
}
