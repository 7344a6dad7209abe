// Ctrl-C and SIGTERM end a bake after the frame in hand, with a checkpoint. A second signal ends the program at once;
// caches are valid after every frame, so nothing but the frame in hand is lost. SIGPIPE and SIGXFSZ become ordinary
// write errors.
#pragma once

namespace ft::inline baker {

/// Installs the handlers for as long as it lives, then puts the old ones back.
class SignalGuard {
 public:
  SignalGuard();
  ~SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;
};

/// The first SIGINT or SIGTERM that came since the guard was made; 0: none.
int signal_received();

}  // namespace ft::inline baker
