#pragma once

namespace saccade {

/// Holds all threads of this program but the calling one where they are, for good: for a program that is about to end.
/// They may hold locks, that of the heap as well, so that from then on only async-signal-safe functions may be called
/// (signal-safety(7)). A thread that does not stop within a fifth of a second, because a device keeps it, goes on; it is
/// waited for as long again whenever further threads have been started meanwhile.
void hold_other_threads();

}  // namespace saccade
