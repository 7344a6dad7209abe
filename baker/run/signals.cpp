#include "baker/run/signals.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>

namespace ft::inline baker {
namespace {

constexpr std::array<int, 4> k_handled = {SIGINT, SIGTERM, SIGPIPE, SIGXFSZ};

std::atomic<int> received{0};
static_assert(std::atomic<int>::is_always_lock_free, "used in a signal handler");
std::array<struct sigaction, k_handled.size()> before;

void on_signal(int signal_number) {
  int none = 0;
  if (!received.compare_exchange_strong(none, signal_number)) ::_exit(128 + signal_number);
}

}  // namespace

SignalGuard::SignalGuard() {
  received = 0;
  for (std::size_t i = 0; i < k_handled.size(); ++i) {
    struct sigaction action {};
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    const bool stops = k_handled[i] == SIGINT || k_handled[i] == SIGTERM;
    action.sa_handler = stops ? on_signal : SIG_IGN;
    sigaction(k_handled[i], &action, &before[i]);
  }
}

SignalGuard::~SignalGuard() {
  for (std::size_t i = 0; i < k_handled.size(); ++i) sigaction(k_handled[i], &before[i], nullptr);
}

int signal_received() {
  return received;
}

}  // namespace ft::inline baker
