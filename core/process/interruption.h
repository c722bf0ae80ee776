#pragma once

namespace saccade {

/// From now on SIGINT, SIGTERM and SIGHUP end this program with one line on stderr and the exit code 128 + signal
/// (130 for Ctrl-C), after everything temporary is removed (temporary_paths.h). Folders that the same command
/// goes on with (resumable_folder.h) stay. An InterruptGuard takes precedence while it lives; a signal that is
/// ignored (nohup) stays ignored. For main(), once, before other threads are started.
void end_on_interruption();

}  // namespace saccade
