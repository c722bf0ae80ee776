#pragma once

#include <functional>

#include "core/process/progress.h"

namespace saccade {

/// Is told of every step of every Progress of this process, in the thread that made it, shown or
/// not. What it throws ends the work, as if the step had failed: how a program that embeds this
/// library follows and interrupts what takes long.
using ProgressObserver = std::function<void(const ProgressState&)>;

/// An empty one observes nothing. Not while work is under way.
void set_progress_observer(ProgressObserver observer);

}  // namespace saccade
