#include "assets/program/interrupt.h"

#include <unistd.h>

#include <csignal>

#include "assets/error.h"

namespace chiaro {
namespace {

volatile std::sig_atomic_t signalled = 0;

void remember(int) {
  if (signalled != 0) ::_exit(static_cast<int>(ExitCode::interrupted));
  signalled = 1;
}

}  // namespace

void catchInterrupts() {
  struct sigaction action {};
  action.sa_handler = remember;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return signalled != 0; }

void throwIfInterrupted() {
  if (interrupted()) throw Error(ExitCode::interrupted, "interrupted", "nothing was written", "");
}

}  // namespace chiaro
