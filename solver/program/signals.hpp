// SIGTERM and SIGINT as a flag that the time loop reads and a pipe that wakes a waiting reader. Nothing is done inside the handler.
#pragma once

#include <atomic>

namespace fracfarm {

// Installs the handlers once; SIGPIPE is ignored, so that a closed pipe is a failed write and not a death.
void catch_stop_signals();

const std::atomic<bool>& stop_requested();

// A descriptor that becomes readable with the first signal.
int stop_descriptor();

}  // namespace fracfarm
