#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/error.h"
#include "core/io/import/camera_files.h"
#include "core/io/import/folder_search.h"
#include "core/io/import/h5_arrays.h"
#include "core/io/import/layouts.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

const std::string kM3edEvents = "/prophesee/left";
const std::string kM3edImu = "/ovc/imu";
constexpr double kSecondsPerUs = 1e-6;

fs::path m3ed_file(const fs::path& path) {
  return fs::is_regular_file(path) && path.extension() == ".h5"
             ? path
             : file_or_in_folder(path, "_data.h5");
}

std::vector<double> expect_numbers(const H5File& file, const std::string& path, std::size_t count) {
  std::vector<double> values = file.numbers(path);
  if (values.size() != count) file.fail(path, fmt::format("must hold {} numbers", count));
  return values;
}

ChainCamera m3ed_camera(const H5File& file) {
  const std::string group = kM3edEvents + "/calib/";
  if (const std::string lens = file.text(group + "distortion_model"); lens != "radtan")
    file.fail(group + "distortion_model", fmt::format("is '{}'; 'radtan' can be read", lens));
  const std::vector<double> k = expect_numbers(file, group + "intrinsics", 4);
  const std::vector<double> lens = expect_numbers(file, group + "distortion_coeffs", 4);
  const std::vector<double> size = expect_numbers(file, group + "resolution", 2);
  ChainCamera chained;
  chained.camera = {static_cast<int>(size[0]),
                    static_cast<int>(size[1]),
                    k[0],
                    k[1],
                    k[2],
                    k[3],
                    {lens[0], lens[1], lens[2], lens[3], 0}};
  chained.camera.check(file.location(group + "intrinsics"));
  return chained;
}

std::vector<ImuSample> m3ed_imu(const H5File& file) {
  const std::vector<double> times = file.numbers(kM3edImu + "/ts");
  const std::vector<double> forces = expect_numbers(file, kM3edImu + "/accel", 3 * times.size());
  const std::vector<double> rates = expect_numbers(file, kM3edImu + "/omega", 3 * times.size());
  std::vector<ImuSample> samples;
  for (std::size_t i = 0; i < times.size(); ++i) {
    ImuSample sample;
    sample.t_ns = ns_from_seconds(kSecondsPerUs * times[i]);
    sample.specific_force = Eigen::Map<const Eigen::Vector3d>(forces.data() + 3 * i);
    sample.angular_velocity = Eigen::Map<const Eigen::Vector3d>(rates.data() + 3 * i);
    if (!sample.specific_force.allFinite() || !sample.angular_velocity.allFinite())
      file.fail(fmt::format("{}[{}]", kM3edImu, i), "a sample is not finite");
    if (samples.empty() || sample.t_ns > samples.back().t_ns) samples.push_back(sample);
  }
  return samples;
}

/// "NAME_data.h5" -> "NAME_depth_gt.h5"; empty where there is none.
fs::path m3ed_sibling(const fs::path& data, const char* ending) {
  std::string stem = data.stem().string();
  if (stem.ends_with("_data")) stem.resize(stem.size() - 5);
  const fs::path file = data.parent_path() / (stem + ending);
  return fs::exists(file) ? file : fs::path();
}

void add_m3ed_depth(const fs::path& name, const PinholeCamera& camera, PublicSequence& sequence) {
  const auto file = std::make_shared<H5File>(name);
  const std::string path = "/depth" + kM3edEvents;
  sequence.depth_times_s = read_h5_times(*file, "/ts", kSecondsPerUs);
  if (file->shape(path).empty() || file->shape(path)[0] != sequence.depth_times_s.size())
    file->fail(path, fmt::format("must hold an image for each of the {} times in /ts",
                                 sequence.depth_times_s.size()));
  sequence.load_depth = [file, path, camera](std::size_t index) {
    return read_h5_depth(*file, path, index, camera.width, camera.height);
  };
}

}  // namespace

bool is_m3ed(const fs::path& path) {
  const fs::path file = m3ed_file(path);
  return !file.empty() && is_hdf5(file) && H5File(file).has(kM3edEvents + "/calib");
}

PublicSequence open_m3ed(const fs::path& path, const fs::path& calibration) {
  const fs::path name = m3ed_file(path);
  const H5File file(name);
  PublicSequence sequence;
  sequence.layout = "M3ED";
  sequence.events = name.string() + "!" + kM3edEvents;
  sequence.camera = m3ed_camera(file);
  const PinholeCamera& camera = sequence.camera.camera;
  if (!calibration.empty())
    sequence.camera = read_any_calibration(calibration, {camera.width, camera.height});
  if (file.has(kM3edImu + "/ts")) {
    sequence.imu = m3ed_imu(file);
    const std::string mounting = kM3edImu + "/calib/T_to_prophesee_left";
    if (file.has(mounting))
      sequence.camera.camera_from_imu =
          rigid_of(expect_numbers(file, mounting, 16).data(), file.location(mounting));
  }
  if (const fs::path poses = m3ed_sibling(name, "_pose_gt.h5"); !poses.empty())
    sequence.groundtruth = read_h5_poses(H5File(poses), "/Cn_T_C0", "/ts", kSecondsPerUs, true);
  if (const fs::path depth = m3ed_sibling(name, "_depth_gt.h5"); !depth.empty())
    add_m3ed_depth(depth, camera, sequence);
  return sequence;
}

}  // namespace saccade
