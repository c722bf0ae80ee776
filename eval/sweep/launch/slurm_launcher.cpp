#include "eval/sweep/launch/slurm_launcher.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <csignal>
#include <functional>
#include <system_error>

#include "core/check.h"
#include "core/process/child_process.h"
#include "core/process/progress.h"
#include "eval/sweep/launch/slurm_jobs.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Does its work periodically, and so rarely that it takes at most 1 / kMaxLoad of the time,
/// however slow the file system or the controller of the cluster is.
class PeriodicWork {
 public:
  PeriodicWork(std::chrono::milliseconds period, std::function<void()> work)
      : period_(period), work_(std::move(work)) {}

  void do_if_due() {
    const Clock::time_point start = Clock::now();
    if (start < next_) return;
    work_();
    const Clock::time_point end = Clock::now();
    next_ = end + std::max<Clock::duration>(period_, kMaxLoad * (end - start));
  }

 private:
  static constexpr int kMaxLoad = 20;
  Clock::duration period_;
  std::function<void()> work_;
  Clock::time_point next_;
};

}  // namespace

int SlurmLauncher::default_parallel_jobs(int /*threads*/) const { return LaunchLimits::kUnlimited; }

std::string SlurmLauncher::environment() const {
  const fs::path& image = options_.slurm.container;
  if (image.empty()) return {};
  std::error_code ignored;
  return fmt::format("{}, {} bytes of {}", image.filename().string(), fs::file_size(image, ignored),
                     fs::last_write_time(image, ignored).time_since_epoch().count());
}

bool SlurmLauncher::run(std::span<const LaunchJob> jobs, const LaunchLimits& limits,
                        const LaunchCallbacks& callbacks) {
  SACCADE_CHECK(limits.parallel_jobs >= 1);
  cluster_->check();
  LauncherOptions options = options_;
  // Nodes know neither /proc of this process nor its working directory.
  options.program = fs::canonical(options.program);
  options.folder = fs::absolute(options.folder) / "slurm";
  const InterruptGuard interrupt;
  SlurmJobs work(jobs, limits, options, *cluster_, callbacks);
  if (const std::size_t adopted = work.adopt_submitted(); adopted > 0)
    show_notice(fmt::format("{} jobs that an earlier call submitted are adopted", adopted));
  PeriodicWork collect_exits(period_, [&] { work.collect_exits(); });
  PeriodicWork poll_queue(5 * period_, [&] { work.poll_queue(); });
  PeriodicWork submit(period_, [&] { work.submit(); });
  while (!work.all_finished()) {
    collect_exits.do_if_due();
    poll_queue.do_if_due();
    submit.do_if_due();
    callbacks.on_wait();
    if (interrupt.signal() == SIGHUP) return false;
    if (interrupt.requested()) {
      work.cancel();
      return false;
    }
    ::poll(nullptr, 0, static_cast<int>(period_.count() / 2));
  }
  std::error_code ignored;
  fs::remove(options.folder, ignored);  // unless it is not empty
  return true;
}

}  // namespace saccade
