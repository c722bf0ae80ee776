#include "core/io/colmap_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/error.h"
#include "core/io/tables/text_table.h"

namespace saccade {
namespace {

constexpr double kColmapUnitTolerance = 1e-3;
constexpr const char* kColmapColumns = "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME";

NamedPose read_image_line(TextRow& row, const std::string& location) {
  static_cast<void>(row.integer("IMAGE_ID"));
  Eigen::Quaterniond q;
  q.w() = row.number("QW");
  q.x() = row.number("QX");
  q.y() = row.number("QY");
  q.z() = row.number("QZ");
  Eigen::Vector3d t;
  for (int i = 0; i < 3; ++i) t[i] = row.number("TX TY TZ");
  static_cast<void>(row.integer("CAMERA_ID"));
  const std::string name(row.word("NAME"));
  row.expect_end(kColmapColumns);
  if (!(std::abs(q.norm() - 1) <= kColmapUnitTolerance))
    row.fail(fmt::format("the quaternion's length is {:.6g}; a rotation's is 1 (within {})",
                         q.norm(), kColmapUnitTolerance));
  return {name, Rigid3(q, t).inverse(), location};
}

}  // namespace

std::vector<NamedPose> read_colmap_images(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file.string(), "cannot be opened");
  std::vector<NamedPose> poses;
  const std::string name = file.string();
  std::string line;
  // Not a TextReader: a picture without points has a blank line.
  bool is_image = true;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    if (line.starts_with('#')) continue;
    if (is_image) {
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      TextRow row(name, number, line);
      poses.push_back(read_image_line(row, fmt::format("{}:{}", name, number)));
    }
    is_image = !is_image;
  }
  if (poses.empty()) throw InputError(name, "holds no poses");
  return poses;
}

bool is_colmap_images(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file) || file.extension() != ".txt") return false;
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line))
    if (!line.starts_with('#') && line.find_first_not_of(" \t\r") != std::string::npos) break;
  const std::string name = file.string();
  TextRow row(name, 1, line);
  try {
    static_cast<void>(read_image_line(row, ""));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

Trajectory trajectory_of(const std::vector<NamedPose>& poses,
                         const std::map<std::string, double>& times_s) {
  std::vector<StampedPose> stamped;
  for (const NamedPose& pose : poses) {
    const auto time = times_s.find(std::filesystem::path(pose.name).filename().string());
    if (time == times_s.end())
      throw InputError(pose.location,
                       fmt::format("the picture {} is not in the dataset's images.txt", pose.name));
    stamped.push_back({time->second, pose.world_from_camera});
  }
  std::sort(stamped.begin(), stamped.end(),
            [](const StampedPose& a, const StampedPose& b) { return a.t_s < b.t_s; });
  for (std::size_t i = 1; i < stamped.size(); ++i)
    if (!(stamped[i].t_s > stamped[i - 1].t_s))
      throw InputError(poses.front().location,
                       fmt::format("two pictures have the time {:.9f} s", stamped[i].t_s));
  return Trajectory(std::move(stamped));
}

}  // namespace saccade
