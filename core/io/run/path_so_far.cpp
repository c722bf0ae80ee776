#include "core/io/run/path_so_far.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "core/error.h"
#include "core/io/trajectory_file.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBegin = "path_so_far.";

/// All that lie in the folder, the newest first; one alone but for the moment of a change.
std::vector<fs::path> shown_files(const fs::path& run) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(run, error))
    if (entry.path().filename().string().starts_with(kBegin)) files.push_back(entry.path());
  std::sort(files.rbegin(), files.rend());
  return files;
}

void append(fmt::memory_buffer& text, const StampedPose& pose) {
  const Eigen::Vector3d& p = pose.world_from_camera.translation();
  const Eigen::Quaterniond& q = pose.world_from_camera.rotation();
  fmt::format_to(std::back_inserter(text), "{:.9f} {} {} {} {} {} {} {}\n", pose.t_s, p.x(), p.y(),
                 p.z(), q.x(), q.y(), q.z(), q.w());
}

}  // namespace

PathSoFar::PathSoFar(const fs::path& run, const fs::path& dataset)
    : folder_(run), dataset_(fs::absolute(dataset).lexically_normal()) {}

void PathSoFar::show(std::span<const StampedPose> path) {
  if (path.empty() || (since_last_ && since_last_->seconds() < kEvery_s)) return;
  since_last_.emplace();
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "# {}\n", dataset_.string());
  const std::size_t last = path.size() - 1, steps = std::min(last, kMostPoses - 1);
  for (std::size_t k = 0; k <= steps; ++k) append(text, path[steps == 0 ? last : last * k / steps]);
  // A name of its own for each: ext4 writes a file to the disk at once that replaces another.
  const fs::path file = folder_ / fmt::format("{}{:08}.txt", kBegin, written_++);
  const fs::path hidden = folder_ / ".path_so_far";
  std::ofstream out(hidden, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  std::error_code error;
  if (out) fs::rename(hidden, file, error);
  if (!out || error) return;
  if (!last_.empty()) fs::remove(last_, error);
  last_ = file;
}

void remove_path_so_far(const fs::path& run) {
  std::error_code error;
  for (const fs::path& file : shown_files(run)) fs::remove(file, error);
  fs::remove(run / ".path_so_far", error);
}

std::optional<ShownPath> read_path_so_far(const fs::path& run) {
  // One may be taken away while it is read, when the next is there; a run is not that fast twice.
  for (int attempt = 0; attempt < 3; ++attempt) {
    const std::vector<fs::path> files = shown_files(run);
    if (files.empty()) return std::nullopt;
    std::ifstream in(files.front());
    std::string line;
    if (!std::getline(in, line)) continue;
    if (!line.starts_with("# ")) return std::nullopt;
    try {
      return ShownPath{line.substr(2), read_tum_trajectory(files.front())};
    } catch (const InputError&) {
      if (fs::exists(files.front())) throw;
    }
  }
  return std::nullopt;
}

}  // namespace saccade
