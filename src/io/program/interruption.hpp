// Lets Ctrl-C, kill and a closed terminal end a run between two steps.
#pragma once

namespace spring_pendulum {

/// From this call on, the first SIGINT, SIGTERM or SIGHUP is only recorded. One that follows within half
/// a second is the same again: `timeout` and a closing terminal signal a process twice. A later one ends
/// the program. A signal that is ignored, as under nohup, stays ignored.
/// \param also called in the signal handler, so it must be async-signal-safe; null: nothing
void catchInterruptions(void (*also)() = nullptr);

/// Returns the number of the recorded signal, 0 if there was none.
int interruption();

}  // namespace spring_pendulum
