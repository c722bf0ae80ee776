#include "eval/sweep/launch/slurm_launcher.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <functional>
#include <system_error>

#include "core/check.h"
#include "core/child_process.h"
#include "core/progress.h"
#include "eval/sweep/launch/slurm_jobs.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Does something now and then: so seldom that it takes a small share of the time, however slow the
/// file system or the controller of the cluster are.
class Repeated {
 public:
  Repeated(std::chrono::milliseconds period, std::function<void()> work)
      : period_(period), work_(std::move(work)) {}

  void do_if_due() {
    const Clock::time_point start = Clock::now();
    if (start < next_) return;
    work_();
    const Clock::time_point end = Clock::now();
    next_ = end + std::max<Clock::duration>(period_, kShare * (end - start));
  }

 private:
  static constexpr int kShare = 20;
  Clock::duration period_;
  std::function<void()> work_;
  Clock::time_point next_;
};

}  // namespace

int SlurmLauncher::default_parallel_jobs(int /*threads*/) const { return LaunchLimits::kAllAtOnce; }

bool SlurmLauncher::run(std::span<const LaunchJob> jobs, const LaunchLimits& limits,
                        const LaunchCallbacks& events) {
  SACCADE_CHECK(limits.parallel_jobs >= 1);
  cluster_->check();
  LauncherOptions options = options_;
  // Nodes know neither this process's link to its program nor its working directory.
  options.program = fs::canonical(options.program);
  options.folder = fs::absolute(options.folder) / "slurm";
  const InterruptGuard interrupt;
  SlurmJobs work(jobs, limits, options, *cluster_, events);
  if (const std::size_t taken = work.take_over(); taken > 0)
    show_notice(fmt::format("{} jobs that an earlier call submitted are taken over", taken));
  Repeated collect(pace_, [&] { work.collect(); });
  Repeated look(5 * pace_, [&] { work.look(); });
  Repeated submit(pace_, [&] { work.submit(); });
  while (!work.all_ended()) {
    collect.do_if_due();
    look.do_if_due();
    submit.do_if_due();
    events.on_wait();
    if (interrupt.signal() == SIGHUP) return false;
    if (interrupt.requested()) {
      work.cancel();
      return false;
    }
    ::poll(nullptr, 0, static_cast<int>(pace_.count() / 2));
  }
  std::error_code ignored;
  fs::remove(options.folder, ignored);  // unless something is left in it
  return true;
}

}  // namespace saccade
