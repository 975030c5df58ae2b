#include "solver/program/signals.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <csignal>

namespace fracfarm {
namespace {

std::atomic<bool> stop{false};
std::array<int, 2> wake{-1, -1};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int) {
  stop.store(true, std::memory_order_relaxed);
  if (::write(wake[1], "x", 1) < 0) return;  // full: it is readable already
}

}  // namespace

void catch_stop_signals() {
  if (::pipe2(wake.data(), O_CLOEXEC | O_NONBLOCK) != 0) wake = {-1, -1};
  struct sigaction action {};
  action.sa_handler = on_signal;
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
  ::signal(SIGPIPE, SIG_IGN);
}

const std::atomic<bool>& stop_requested() { return stop; }

int stop_descriptor() { return wake[0]; }

}  // namespace fracfarm
