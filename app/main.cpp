#include "app/commands.hpp"
#include "app/process/interrupt.hpp"
#include "app/process/process.hpp"
#include "render/device.hpp"

#include <cstdlib>

int main(int argc, char** argv) {
  try {
    penumbra::app::prepare_process();
    penumbra::app::watch_for_interrupts();
    return penumbra::app::run_command_line(argc, argv);
  } catch (const penumbra::render::DeviceDoesNotAnswer&) {
    // The driver's threads may be at work still: what runs at a regular exit would run under their feet.
    std::_Exit(penumbra::app::explain_current_exception());
  } catch (...) {
    return penumbra::app::explain_current_exception();
  }
}
