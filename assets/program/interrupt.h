#pragma once
/// Ctrl-C and termination, turned into an Error at the next safe place.

namespace chiaro {

/// From now on SIGINT and SIGTERM are remembered; a second one ends the process at once with 130.
void catchInterrupts();

bool interrupted();

/// Throws Error (interrupted) after the first signal. Call it wherever work may stop.
void throwIfInterrupted();

}  // namespace chiaro
