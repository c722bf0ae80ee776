#include "core/io/import/public_sequence.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/io/dataset/dataset_writer.h"
#include "core/io/events/event_file.h"
#include "core/io/files/atomic_file.h"
#include "core/io/import/layouts.h"
#include "core/io/trigger_file.h"
#include "core/process/progress.h"
#include "core/srgb.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

struct Layout {
  bool (*recognises)(const fs::path&);
  PublicSequence (*open)(const fs::path&, const fs::path& calibration);
};

constexpr Layout kLayouts[] = {{is_dsec, open_dsec},     {is_tum_vie, open_tum_vie},
                               {is_m3ed, open_m3ed},     {is_mvsec, open_mvsec},
                               {is_vector, open_vector}, {is_eds, open_eds},
                               {is_euroc, open_euroc},   {is_aedat4, open_aedat4_sequence}};

/// The part of a sequence that is asked for, by its clock.
struct ImportTimes {
  TimeWindow events;
  TimeWindow others;  ///< without a start also what comes before the first event
};

TimeNs first_time(const PublicSequence& sequence) {
  if (!sequence.events.empty()) {
    const PinholeCamera& camera = sequence.camera.camera;
    EventStream stream(sequence.events, {camera.width, camera.height});
    if (const auto events = stream.next(); !events.empty()) return events.front().t_ns;
  } else if (!sequence.frame_times_s.empty()) {
    return ns_from_seconds(sequence.frame_times_s.front());
  }
  throw InputError(sequence.events.empty() ? sequence.layout : sequence.events.string(),
                   "holds no events");
}

ImportTimes times_of(const PublicSequence& sequence, const ImportWindow& window) {
  ImportTimes times;
  times.events.start_ns = first_time(sequence) + ns_from_seconds(window.start_s);
  if (window.duration_s)
    times.events.end_ns = times.events.start_ns + ns_from_seconds(*window.duration_s);
  times.others = times.events;
  if (window.start_s == 0) times.others.start_ns = TimeWindow().start_ns;
  return times;
}

bool contains(const TimeWindow& times, TimeNs t_ns) {
  return t_ns >= times.start_ns && t_ns < times.end_ns;
}

/// The poses within the window, and one on either side of it.
std::vector<StampedPose> poses_around(const std::vector<StampedPose>& poses, TimeWindow times) {
  std::vector<StampedPose> result;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const bool before = i + 1 < poses.size() && ns_from_seconds(poses[i + 1].t_s) <= times.start_ns;
    const bool after = i > 0 && ns_from_seconds(poses[i - 1].t_s) >= times.end_ns;
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

/// Writes the parts of a sequence one after the other.
class SequenceCopy {
 public:
  SequenceCopy(const PublicSequence& sequence, const ImportTimes& times, DatasetWriter& writer)
      : sequence_(sequence), times_(times), writer_(writer) {}

  ImportCounts run(EventStream* stream) {
    if (stream != nullptr) copy_events(*stream);
    copy_poses();
    copy_imu();
    copy_images();
    copy_triggers();
    return counts_;
  }

  [[nodiscard]] TimeNs last_ns() const { return last_ns_; }

 private:
  void copy_events(EventStream& stream) {
    Progress progress("converting", 0, "events");
    for (auto events = stream.next(); !events.empty(); events = stream.next()) {
      writer_.write_events(events);
      counts_.events += events.size();
      last_ns_ = events.back().t_ns;
      progress.add(events.size());
    }
    if (counts_.events == 0)
      throw InputError(sequence_.events.string(), "holds no events in the part that was asked for");
  }

  void copy_poses() {
    if (sequence_.groundtruth.empty()) return;
    TimeWindow times = times_.events;
    if (counts_.events > 0) times.end_ns = std::min(times.end_ns, last_ns_ + 1);
    const auto poses = poses_around(sequence_.groundtruth, times);
    if (poses.empty()) return;
    warn_of_gaps(poses);
    writer_.write_groundtruth(poses);
    counts_.poses = poses.size();
  }

  void copy_imu() {
    std::vector<ImuSample> imu = sequence_.imu;
    std::erase_if(imu,
                  [&](const ImuSample& sample) { return !contains(times_.others, sample.t_ns); });
    if (!imu.empty()) writer_.write_imu(imu);
    counts_.imu_samples = imu.size();
  }

  void copy_images() {
    for (std::size_t i = 0; i < sequence_.frame_times_s.size(); ++i)
      if (const double t_s = sequence_.frame_times_s[i]; is_asked_for(t_s))
        writer_.write_frame(counts_.frames++, t_s, linear_from_srgb8(sequence_.load_frame(i)));
    for (std::size_t i = 0; i < sequence_.depth_times_s.size(); ++i)
      if (const double t_s = sequence_.depth_times_s[i]; is_asked_for(t_s))
        writer_.write_depth(counts_.depth_maps++, t_s, sequence_.load_depth(i));
  }

  void copy_triggers() {
    std::vector<Trigger> triggers = sequence_.triggers;
    std::erase_if(triggers,
                  [&](const Trigger& trigger) { return !contains(times_.others, trigger.t_ns); });
    if (!triggers.empty()) write_triggers(writer_.folder() / "triggers.txt", triggers);
    counts_.triggers = triggers.size();
  }

  [[nodiscard]] bool is_asked_for(double t_s) const {
    return contains(times_.others, ns_from_seconds(t_s));
  }

  const PublicSequence& sequence_;
  const ImportTimes& times_;
  DatasetWriter& writer_;
  ImportCounts counts_;
  TimeNs last_ns_ = 0;
};

/// Where a dataset without events ends.
TimeNs last_frame_ns(const PublicSequence& sequence, const ImportTimes& times) {
  TimeNs last_ns = times.events.start_ns;
  for (const double t_s : sequence.frame_times_s)
    if (const TimeNs t_ns = ns_from_seconds(t_s); contains(times.others, t_ns))
      last_ns = std::max(last_ns, t_ns);
  return last_ns;
}

}  // namespace

std::string ImportCounts::text() const {
  std::vector<std::string> parts{fmt::format("{} events", events)};
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0) parts.push_back(fmt::format("{} {}", count, what));
  };
  add(frames, "frames");
  add(depth_maps, "depth maps");
  add(imu_samples, "inertial samples");
  add(poses, "poses");
  add(triggers, "triggers");
  std::string text = parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i)
    text += (i + 1 == parts.size() ? " and " : ", ") + parts[i];
  return text;
}

std::optional<PublicSequence> open_public_sequence(const fs::path& path,
                                                   const fs::path& calibration) {
  for (const Layout& layout : kLayouts)
    if (layout.recognises(path)) return layout.open(path, calibration);
  return std::nullopt;
}

ImportCounts write_as_dataset(const PublicSequence& sequence, const fs::path& folder,
                              const ImportWindow& window) {
  AtomicFolder output(folder, "dataset.yaml");
  const PinholeCamera& camera = sequence.camera.camera;
  const ImportTimes times = times_of(sequence, window);
  std::optional<EventStream> stream;
  if (!sequence.events.empty())
    stream.emplace(sequence.events, SensorSize{camera.width, camera.height}, times.events);
  DatasetWriterOptions options;
  if (stream) options.timestamp_unit = stream->unit();
  options.chain = {sequence.camera};
  DatasetWriter writer(output.path(), camera, options);
  SequenceCopy copy(sequence, times, writer);
  const ImportCounts counts = copy.run(stream ? &*stream : nullptr);
  DatasetRecord record;
  record.name = FinalFolder(folder, "dataset.yaml").path().filename().string();
  const TimeNs last_ns = stream ? copy.last_ns() : last_frame_ns(sequence, times);
  record.duration_s = seconds_from_ns(last_ns - times.events.start_ns);
  static_cast<void>(writer.finish(record));
  output.commit();
  return counts;
}

}  // namespace saccade
