#include "core/io/trajectory_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/tables/text_table.h"

namespace saccade {
namespace {

constexpr double kUnitTolerance = 1e-3;
constexpr const char* kObject = "t object tx ty tz qx qy qz qw";
constexpr const char* kRate = "t wx wy wz";
constexpr const char* kTwist = "t vx vy vz wx wy wz";

Eigen::Quaterniond read_rotation(TextRow& row) {
  Eigen::Quaterniond q;
  q.x() = row.number("qx");
  q.y() = row.number("qy");
  q.z() = row.number("qz");
  q.w() = row.number("qw");
  const double norm = q.norm();
  if (!(std::abs(norm - 1) <= kUnitTolerance))
    row.fail(fmt::format("the quaternion's length is {:.6g}; a rotation's is 1 (within {})", norm,
                         kUnitTolerance));
  return q;
}

/// `tx ty tz qx qy qz qw`.
Rigid3 read_pose(TextRow& row) {
  Eigen::Vector3d t;
  t.x() = row.number("tx");
  t.y() = row.number("ty");
  t.z() = row.number("tz");
  return {read_rotation(row), t};
}

std::string text_of(const Rigid3& pose) {
  const Eigen::Vector3d& t = pose.translation();
  const Eigen::Quaterniond& q = pose.rotation();
  return fmt::format("{} {} {} {} {} {} {}", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

/// Appends to poses or twists; their times must increase.
template <class Stamped>
void append(std::vector<Stamped>& list, const Stamped& one, const TextRow& row) {
  if (!list.empty() && !(one.t_s > list.back().t_s))
    row.fail(fmt::format("times must increase: {:.9f} s after {:.9f} s", one.t_s, list.back().t_s));
  list.push_back(one);
}

Trajectory finished(std::vector<StampedPose> poses, const std::filesystem::path& file) {
  if (poses.empty()) throw InputError(file.string(), "holds no poses");
  return Trajectory(std::move(poses));
}

}  // namespace

Trajectory read_tum_trajectory(const std::filesystem::path& file) {
  std::vector<StampedPose> poses;
  for_each_row(file, [&](TextRow& row) {
    const double t_s = row.number("t");
    append(poses, {t_s, read_pose(row)}, row);
    row.expect_end("t tx ty tz qx qy qz qw");
    return true;
  });
  return finished(std::move(poses), file);
}

Trajectory read_trajectory(const std::filesystem::path& file) {
  TextReader reader(file);
  std::string_view line;
  bool comma = false;
  if (reader.next(line)) comma = line.find(',') != std::string_view::npos;
  return comma ? read_csv_trajectory(file) : read_tum_trajectory(file);
}

void write_tum_trajectory(const std::filesystem::path& file, std::span<const StampedPose> poses) {
  fmt::memory_buffer text;
  for (const StampedPose& pose : poses) {
    fmt::format_to(std::back_inserter(text), "{:.9f} {}\n", pose.t_s,
                   text_of(pose.world_from_camera));
  }
  write_atomically(file, {text.data(), text.size()});
}

Trajectory read_orientations(const std::filesystem::path& file) {
  std::vector<StampedPose> poses;
  for_each_row(file, [&](TextRow& row) {
    const double t_s = row.number("t");
    append(poses, {t_s, {read_rotation(row), Eigen::Vector3d::Zero()}}, row);
    row.expect_end("t qx qy qz qw");
    return true;
  });
  return finished(std::move(poses), file);
}

void write_orientations(const std::filesystem::path& file, std::span<const StampedPose> poses) {
  fmt::memory_buffer text;
  for (const StampedPose& pose : poses) {
    const Eigen::Quaterniond& q = pose.world_from_camera.rotation();
    fmt::format_to(std::back_inserter(text), "{:.9f} {} {} {} {}\n", pose.t_s, q.x(), q.y(), q.z(),
                   q.w());
  }
  write_atomically(file, {text.data(), text.size()});
}

std::vector<StampedTwist> read_twists(const std::filesystem::path& file) {
  std::vector<StampedTwist> twists;
  for_each_row(file, [&](TextRow& row) {
    StampedTwist twist;
    twist.t_s = row.number("t");
    for (int i = 0; i < 3; ++i)
      twist.velocity[i] = row.number(std::array{"vx", "vy", "vz"}[static_cast<std::size_t>(i)]);
    for (int i = 0; i < 3; ++i)
      twist.angular_velocity[i] =
          row.number(std::array{"wx", "wy", "wz"}[static_cast<std::size_t>(i)]);
    row.expect_end(kTwist);
    append(twists, twist, row);
    return true;
  });
  return twists;
}

void write_twists(const std::filesystem::path& file, std::span<const StampedTwist> twists) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "# {}\n", kTwist);
  for (const StampedTwist& twist : twists) {
    const Eigen::Vector3d& v = twist.velocity;
    const Eigen::Vector3d& w = twist.angular_velocity;
    fmt::format_to(std::back_inserter(text), "{:.9f} {} {} {} {} {} {}\n", twist.t_s, v.x(), v.y(),
                   v.z(), w.x(), w.y(), w.z());
  }
  write_atomically(file, {text.data(), text.size()});
}

std::vector<StampedTwist> read_angular_velocities(const std::filesystem::path& file) {
  std::vector<StampedTwist> twists;
  for_each_row(file, [&](TextRow& row) {
    StampedTwist twist;
    twist.t_s = row.number("t");
    for (int i = 0; i < 3; ++i)
      twist.angular_velocity[i] =
          row.number(std::array{"wx", "wy", "wz"}[static_cast<std::size_t>(i)]);
    row.expect_end(kRate);
    append(twists, twist, row);
    return true;
  });
  return twists;
}

void write_angular_velocities(const std::filesystem::path& file,
                              std::span<const StampedTwist> twists) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "# {}\n", kRate);
  for (const StampedTwist& twist : twists) {
    const Eigen::Vector3d& w = twist.angular_velocity;
    fmt::format_to(std::back_inserter(text), "{:.9f} {} {} {}\n", twist.t_s, w.x(), w.y(), w.z());
  }
  write_atomically(file, {text.data(), text.size()});
}

std::vector<ObjectPose> read_object_poses(const std::filesystem::path& file) {
  std::vector<ObjectPose> poses;
  for_each_row(file, [&](TextRow& row) {
    ObjectPose pose;
    pose.t_s = row.number("t");
    const std::int64_t object = row.integer("object");
    if (object < 0 || object > std::numeric_limits<std::uint32_t>::max())
      row.fail(fmt::format("object {} is not an index into a list of meshes", object));
    pose.object = static_cast<std::uint32_t>(object);
    pose.world_from_object = read_pose(row);
    row.expect_end(kObject);
    const auto rank = [](const ObjectPose& p) { return std::pair(p.t_s, p.object); };
    if (!poses.empty() && !(rank(poses.back()) < rank(pose)))
      row.fail(
          fmt::format("lines must be in order of time, then of the object: object {} at "
                      "{:.9f} s comes after object {} at {:.9f} s",
                      pose.object, pose.t_s, poses.back().object, poses.back().t_s));
    poses.push_back(pose);
    return true;
  });
  return poses;
}

void write_object_poses(const std::filesystem::path& file, std::span<const ObjectPose> poses) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "# {}\n", kObject);
  for (const ObjectPose& pose : poses)
    fmt::format_to(std::back_inserter(text), "{:.9f} {} {}\n", pose.t_s, pose.object,
                   text_of(pose.world_from_object));
  write_atomically(file, {text.data(), text.size()});
}

}  // namespace saccade
