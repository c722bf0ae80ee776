#include "core/io/import/public_sequence.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/io/dataset/dataset_writer.h"
#include "core/io/events/events_h5.h"
#include "core/io/files/atomic_file.h"
#include "core/process/progress.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr TimeNs kNsPerSecond = 1'000'000'000;

bool has_left_events_of_tum_vie(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().ends_with("events_left.h5")) return true;
  return false;
}

TimeWindow times_of(const EventFileInfo& info, const ImportWindow& window) {
  TimeWindow times{info.first_ns + ns_from_seconds(window.start_s), info.last_ns + 1};
  if (window.duration_s)
    times.end_ns = std::min(times.end_ns, times.start_ns + ns_from_seconds(*window.duration_s));
  return times;
}

std::uint64_t copy_events(const EventH5Reader& reader, const PublicSequence& sequence,
                          const TimeWindow& times, DatasetWriter& writer) {
  const PinholeCamera& camera = sequence.camera.camera;
  const auto [first, last] = reader.range(times);
  Progress progress("converting", last - first, "events");
  std::uint64_t count = 0;
  for (TimeNs from = times.start_ns; from < times.end_ns; from += kNsPerSecond) {
    const TimeWindow second{from, std::min(from + kNsPerSecond, times.end_ns)};
    const Events events = reader.read({camera.width, camera.height}, second);
    writer.write_events(events);
    count += events.size();
    progress.add(events.size());
  }
  return count;
}

/// The poses within the window, and one on either side of it.
std::vector<StampedPose> poses_around(const std::vector<StampedPose>& poses, double start_s,
                                      double end_s) {
  std::vector<StampedPose> result;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const bool before = i + 1 < poses.size() && poses[i + 1].t_s <= start_s;
    const bool after = i > 0 && poses[i - 1].t_s >= end_s;
    if (!before && !after) result.push_back(poses[i]);
  }
  return result;
}

void warn_of_gaps(const std::vector<StampedPose>& poses) {
  constexpr double kGapS = 0.5;
  for (std::size_t i = 1; i < poses.size(); ++i)
    if (const double gap_s = poses[i].t_s - poses[i - 1].t_s; gap_s > kGapS)
      show_notice(
          fmt::format("the ground truth has a gap of {:.3g} s after {:.3f} s, across which "
                      "scores would interpolate; convert a part without it (--start-s, "
                      "--duration-s)",
                      gap_s, poses[i - 1].t_s));
}

}  // namespace

std::optional<PublicSequence> open_public_sequence(const fs::path& folder) {
  if (fs::exists(folder / "events" / "left" / "events.h5")) return open_dsec(folder);
  if (has_left_events_of_tum_vie(folder)) return open_tum_vie(folder);
  return std::nullopt;
}

std::uint64_t write_as_dataset(const PublicSequence& sequence, const fs::path& folder,
                               const ImportWindow& window) {
  AtomicFolder output(folder, "dataset.yaml");
  const EventH5Reader reader(sequence.events);
  const EventFileInfo info = reader.info();
  const TimeWindow times = times_of(info, window);
  if (info.count == 0 || times.start_ns >= times.end_ns)
    throw InputError(sequence.events.string(), "holds no events in the part that was asked for");
  const double start_s = seconds_from_ns(times.start_ns);
  const double end_s = seconds_from_ns(times.end_ns);
  DatasetWriterOptions options;
  options.timestamp_unit = info.unit;
  options.chain = {sequence.camera};
  DatasetWriter writer(output.path(), sequence.camera.camera, options);
  const std::uint64_t count = copy_events(reader, sequence, times, writer);
  if (!sequence.groundtruth.empty()) {
    const auto poses = poses_around(sequence.groundtruth, start_s, end_s);
    warn_of_gaps(poses);
    writer.write_groundtruth(poses);
  }
  std::vector<ImuSample> imu = sequence.imu;
  std::erase_if(imu, [&](const ImuSample& sample) {
    return sample.t_ns < times.start_ns || sample.t_ns >= times.end_ns;
  });
  if (!imu.empty()) writer.write_imu(imu);
  std::size_t index = 0;
  for (const StampedFile& depth : sequence.depths)
    if (depth.t_s >= start_s && depth.t_s <= end_s)
      writer.write_depth(index++, depth.t_s, sequence.load_depth(depth.file));
  DatasetRecord record;
  record.name = FinalFolder(folder, "dataset.yaml").path().filename().string();
  record.duration_s = seconds_from_ns(std::min(times.end_ns, info.last_ns) - times.start_ns);
  static_cast<void>(writer.finish(record));
  output.commit();
  return count;
}

}  // namespace saccade
