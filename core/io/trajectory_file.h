#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/trajectory.h"

namespace saccade {

/// Lines `t tx ty tz qx qy qz qw` (TUM, Event Camera Dataset): seconds, world-from-camera.
/// InputError with `file:line` for malformed lines, times that do not increase, and quaternions
/// whose length is off 1 by more than 1e-3; smaller deviations are normalised away. An empty file
/// is an error.
[[nodiscard]] Trajectory read_tum_trajectory(const std::filesystem::path& file);

/// Comma-separated lines of a time in ns, a position and a quaternion, below a line that names the
/// columns, because programs differ in the order of the quaternion: rpg_esim writes
/// `# timestamp, x, y, z, qx, qy, qz, qw`, EuRoC's ground truth (ASL)
/// `#timestamp, p_RS_R_x [m], ..., q_RS_w [], q_RS_x [], ...`. The pose is that of the frame that the
/// file is about. Further columns are left out. The same checks; without names an InputError that
/// says which line to add.
[[nodiscard]] Trajectory read_csv_trajectory(const std::filesystem::path& file);

/// Whether the first line that is not blank names the columns of such a file.
[[nodiscard]] bool is_csv_trajectory(const std::filesystem::path& file);

/// Either of them: CSV when the first line with numbers holds a comma.
[[nodiscard]] Trajectory read_trajectory(const std::filesystem::path& file);

/// TUM text; times with 9 decimals, the rest exact in double.
void write_tum_trajectory(const std::filesystem::path& file, std::span<const StampedPose> poses);

/// Lines `t qx qy qz qw`: seconds, world_from_camera; as poses at the origin, with the checks of
/// read_tum_trajectory().
[[nodiscard]] Trajectory read_orientations(const std::filesystem::path& file);
/// Leaves the positions out; times with 9 decimals, the rest exact in double.
void write_orientations(const std::filesystem::path& file, std::span<const StampedPose> poses);

/// Lines `t vx vy vz wx wy wz` below a comment that names the columns: seconds with 9 decimals, the
/// camera's velocity [m/s] and angular velocity [rad/s] in its own axes, exact in double. Times
/// must increase; InputError with `file:line`.
[[nodiscard]] std::vector<StampedTwist> read_twists(const std::filesystem::path& file);
void write_twists(const std::filesystem::path& file, std::span<const StampedTwist> twists);

/// Lines `t wx wy wz` below a comment that names the columns; the velocities are zero and left out.
/// Likewise.
[[nodiscard]] std::vector<StampedTwist> read_angular_velocities(const std::filesystem::path& file);
void write_angular_velocities(const std::filesystem::path& file,
                              std::span<const StampedTwist> twists);

/// Lines `t object tx ty tz qx qy qz qw` (T_world_object) below a comment that names the columns:
/// seconds with 9 decimals, the object's index in the scene's mesh list, its pose exact in double.
/// In order of time, then of the object; InputError with `file:line`.
[[nodiscard]] std::vector<ObjectPose> read_object_poses(const std::filesystem::path& file);
void write_object_poses(const std::filesystem::path& file, std::span<const ObjectPose> poses);

}  // namespace saccade
