#include "estimator/external/external_output.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <memory>
#include <span>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"
#include "core/event.h"
#include "core/io/covariance_file.h"
#include "core/io/events/event_file.h"
#include "core/io/ply_file.h"
#include "core/io/run/view_list.h"
#include "core/io/tables/text_table.h"
#include "core/io/trajectory_file.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// "t,x,y" that is not commented out; NaN as a first number is none.
bool is_column_names(std::string_view line) {
  return std::isalpha(static_cast<unsigned char>(line.front())) != 0 && !line.starts_with("nan") &&
         !line.starts_with("NaN") && !line.starts_with("inf");
}

double stamp_of(TextRow& row, const TrajectoryFormat& format) {
  switch (format.timestamp_unit) {
    case StampUnit::kSeconds:
      return row.number("t") + format.time_offset_s;
    case StampUnit::kMilliseconds:
      return 1e-3 * row.number("t") + format.time_offset_s;
    case StampUnit::kMicroseconds:
      return 1e-6 * row.number("t") + format.time_offset_s;
    case StampUnit::kNanoseconds:
      break;
  }
  // Nanoseconds since 1970 have more digits than a double.
  const std::string_view text = row.word("t");
  TimeNs t_ns = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), t_ns);
  if (problem != std::errc() || end != text.data() + text.size())
    row.fail(fmt::format("t: expected whole nanoseconds, found '{}'", text));
  return seconds_from_ns(t_ns) + format.time_offset_s;
}

Rigid3 pose_of(TextRow& row, const TrajectoryFormat& format) {
  constexpr double kUnitTolerance = 1e-3;
  Eigen::Vector3d t;
  t.x() = row.number("x");
  t.y() = row.number("y");
  t.z() = row.number("z");
  Eigen::Quaterniond q;
  const bool w_first = format.columns == TrajectoryFormat::Columns::kEuroc;
  if (w_first) q.w() = row.number("qw");
  q.x() = row.number("qx");
  q.y() = row.number("qy");
  q.z() = row.number("qz");
  if (!w_first) q.w() = row.number("qw");
  if (!(std::abs(q.norm() - 1) <= kUnitTolerance))
    row.fail(fmt::format("the quaternion's length is {:.6g}; a rotation's is 1", q.norm()));
  const Rigid3 pose(q, t);
  return format.poses == TrajectoryFormat::Convention::kCameraFromWorld ? pose.inverse() : pose;
}

fs::path expected_output(const fs::path& out, const std::string& name, const char* key) {
  if (!fs::exists(out / name))
    throw InputError(name, fmt::format("was not written, which output.{} promises", key));
  return out / name;
}

void write_events(const fs::path& run, const PinholeCamera& camera, std::span<const Event> events) {
  const auto writer = make_event_writer(run / "events.h5", TimestampUnit::kNanoseconds,
                                        {camera.width, camera.height});
  writer->append(events);
  writer->close();
}

}  // namespace

std::vector<StampedPose> read_external_trajectory(const fs::path& file,
                                                  const TrajectoryFormat& format) {
  std::vector<StampedPose> poses;
  TextReader reader(file);
  std::string_view line;
  for (bool first = true; reader.next(line); first = false) {
    if (first && is_column_names(line)) continue;
    TextRow row = reader.row(line);
    const double t_s = stamp_of(row, format);
    const Rigid3 pose = pose_of(row, format);
    row.expect_end("t x y z and a quaternion");
    if (!poses.empty() && !(t_s > poses.back().t_s))
      row.fail(fmt::format("times must increase: {:.9f} s after {:.9f} s", t_s, poses.back().t_s));
    poses.push_back({t_s, pose});
  }
  return poses;
}

ExternalFound import_external_output(const fs::path& out, const AdapterOutput& output,
                                     const PinholeCamera& camera, const fs::path& run) {
  if (!output.events.empty()) {
    const Events events =
        read_events(expected_output(out, output.events, "events"), {camera.width, camera.height});
    write_events(run, camera, events);
    return {std::nullopt, events.size()};
  }
  const std::vector<StampedPose> poses = read_external_trajectory(
      expected_output(out, output.trajectory.file, "trajectory.file"), output.trajectory);
  if (!output.covariance.empty()) {
    const auto covariances =
        read_covariances(expected_output(out, output.covariance, "covariance"));
    write_covariances(run / "covariance.txt", covariances);
  }
  if (!output.map.empty()) {
    const fs::path map = expected_output(out, output.map, "map");
    static_cast<void>(read_ply(map));
    fs::copy_file(map, run / "map.ply");
  }
  if (!output.views.empty()) {
    const fs::path views = expected_output(out, output.views, "views");
    static_cast<void>(read_view_list(expected_output(views, "views.yaml", "views")));
    fs::copy(views, run, fs::copy_options::recursive);
  }
  write_tum_trajectory(run / "trajectory.txt", poses);
  return {poses.size(), 0};
}

ExternalFound write_no_output(const AdapterOutput& output, const PinholeCamera& camera,
                              const fs::path& run) {
  if (!output.events.empty()) {
    write_events(run, camera, {});
    return {};
  }
  write_tum_trajectory(run / "trajectory.txt", {});
  return {0, 0};
}

}  // namespace saccade
