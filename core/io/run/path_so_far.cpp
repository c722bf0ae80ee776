#include "core/io/run/path_so_far.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/trajectory_file.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "path_so_far.txt";

void append(fmt::memory_buffer& text, const StampedPose& pose) {
  const Eigen::Vector3d& p = pose.world_from_camera.translation();
  const Eigen::Quaterniond& q = pose.world_from_camera.rotation();
  fmt::format_to(std::back_inserter(text), "{:.9f} {} {} {} {} {} {} {}\n", pose.t_s, p.x(), p.y(),
                 p.z(), q.x(), q.y(), q.z(), q.w());
}

}  // namespace

PathSoFar::PathSoFar(const fs::path& run, const fs::path& dataset)
    : file_(run / kFile), dataset_(fs::absolute(dataset).lexically_normal()) {}

void PathSoFar::show(std::span<const StampedPose> path) {
  if (path.empty() || (since_last_ && since_last_->seconds() < kEvery_s)) return;
  since_last_.emplace();
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "# {}\n", dataset_.string());
  const std::size_t last = path.size() - 1, steps = std::min(last, kMostPoses - 1);
  for (std::size_t k = 0; k <= steps; ++k) append(text, path[steps == 0 ? last : last * k / steps]);
  // No AtomicFile: that waits for the disk, and what is lost with the machine is of no use after it.
  // Nor is the old file replaced, for which ext4 waits, too.
  const fs::path fresh = fs::path(file_) += ".new";
  std::ofstream out(fresh, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) fail_to_write(fresh, 0);
  fs::remove(file_);
  fs::rename(fresh, file_);
}

void remove_path_so_far(const fs::path& run) { fs::remove(run / kFile); }

std::optional<ShownPath> read_path_so_far(const fs::path& run) {
  const fs::path file = run / kFile;
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line) || !line.starts_with("# ")) return std::nullopt;
  try {
    return ShownPath{line.substr(2), read_tum_trajectory(file)};
  } catch (const InputError&) {
    // The next one may be taking its place.
    if (!fs::exists(file)) return std::nullopt;
    throw;
  }
}

}  // namespace saccade
