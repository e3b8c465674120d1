// Ctrl-C and kill end a run between two frames instead of anywhere.
#pragma once

namespace spring_pendulum {

/// From now on the first SIGINT or SIGTERM is only remembered; the second one ends the program.
void catchInterruptions();

/// The signal that arrived, 0 if none did.
int interruption();

}  // namespace spring_pendulum
