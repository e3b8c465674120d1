// Ctrl-C, kill and a closed terminal end a run between two steps instead of anywhere.
#pragma once

namespace spring_pendulum {

/// From now on the first SIGINT, SIGTERM or SIGHUP is only remembered; the second one ends the
/// program. A signal that is ignored, as in a background job of a shell or under nohup, stays so.
/// \param also called in the signal handler, so it may do only what a handler may; null: nothing
void catchInterruptions(void (*also)() = nullptr);

/// The signal that arrived, 0 if none did.
int interruption();

}  // namespace spring_pendulum
