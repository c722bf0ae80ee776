#include "eval/sweep/plan/disk_quota.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace saccade {
namespace {

constexpr double kBytesPerGb = 1e9;
/// Before the mean of the datasets is known.
constexpr std::size_t kFirstDatasets = 2;
/// Datasets differ: so much more than the mean is reserved for each.
constexpr double kReserve = 1.2;

}  // namespace

DiskQuota::DiskQuota(double disk_gb, std::vector<SweepJob>& simulations)
    : disk_gb_(disk_gb), simulations_(simulations) {
  for (SweepJob& job : simulations_) job.state = JobState::kHeld;
  release_next();
}

bool DiskQuota::release_next() {
  std::size_t more = kFirstDatasets;
  if (released_ > 0) {
    used_ = 0;
    std::size_t made = 0;
    for (std::size_t i = 0; i < released_; ++i)
      if (simulations_[i].state != JobState::kFailed) {
        used_ += bytes_below(simulations_[i].output);
        ++made;
      }
    if (made == 0) return false;
    const double mean = static_cast<double>(used_) / static_cast<double>(made);
    const double left = disk_gb_ * kBytesPerGb - static_cast<double>(used_);
    const double fit = std::max(0.0, left / (kReserve * std::max(mean, 1.0)));
    // Rounds double, so that a mean of few is not trusted with all that is left.
    more = static_cast<std::size_t>(std::min(fit, static_cast<double>(released_)));
  }
  more = std::min(more, simulations_.size() - released_);
  for (std::size_t i = released_; i < released_ + more; ++i)
    simulations_[i].state = JobState::kPending;
  released_ += more;
  return more > 0;
}

std::string DiskQuota::message() const {
  const double used_gb = static_cast<double>(used_) / kBytesPerGb;
  if (used_gb > disk_gb_)
    return fmt::format("generate.disk_gb: {} datasets take {:.3g} GB, more than the {:g} GB",
                       released_, used_gb, disk_gb_);
  if (released_ == simulations_.size() || used_ == 0) return "";
  return fmt::format(
      "generate.disk_gb: {} of {} datasets were made and take {:.2f} GB; the next would not fit "
      "into {:g} GB with certainty",
      released_, simulations_.size(), used_gb, disk_gb_);
}

std::uintmax_t bytes_below(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::uintmax_t bytes = 0;
  std::error_code error;
  for (auto at = fs::recursive_directory_iterator(folder, error);
       at != fs::recursive_directory_iterator(); at.increment(error))
    if (at->is_regular_file(error)) bytes += at->file_size(error);
  return bytes;
}

}  // namespace saccade
