#include <fmt/format.h>

#include <memory>

#include "core/error.h"
#include "core/io/import/camera_files.h"
#include "core/io/import/folder_search.h"
#include "core/io/import/h5_arrays.h"
#include "core/io/import/layouts.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

const std::string kDavis = "/davis/left/";

fs::path mvsec_file(const fs::path& path) { return file_or_in_folder(path, "_data.hdf5"); }

ChainCamera mvsec_camera(const fs::path& data, const fs::path& calibration) {
  const fs::path chain =
      calibration.empty() ? find_near(data.parent_path(), "camchain", ".yaml") : calibration;
  if (chain.empty())
    throw InputError(data.string(),
                     "has no camchain*.yaml beside it or in a folder beside it: MVSEC publishes it "
                     "in the calibration of each scene; or name one with --calibration");
  return read_any_calibration(chain, {});
}

/// Rows of an acceleration [m/s^2] and a rate [rad/s].
std::vector<ImuSample> mvsec_imu(const H5File& file) {
  const std::vector<double> times = file.numbers(kDavis + "imu_ts");
  const std::vector<double> rows = file.numbers(kDavis + "imu");
  if (rows.size() != 6 * times.size())
    file.fail(kDavis + "imu",
              fmt::format("must hold 6 numbers for each of {} times", times.size()));
  std::vector<ImuSample> samples;
  for (std::size_t i = 0; i < times.size(); ++i) {
    ImuSample sample;
    sample.t_ns = ns_from_seconds(times[i]);
    sample.specific_force = Eigen::Map<const Eigen::Vector3d>(rows.data() + 6 * i);
    sample.angular_velocity = Eigen::Map<const Eigen::Vector3d>(rows.data() + 6 * i + 3);
    if (!sample.specific_force.allFinite() || !sample.angular_velocity.allFinite())
      file.fail(fmt::format("{}imu[{}]", kDavis, i), "a sample is not finite");
    if (samples.empty() || sample.t_ns > samples.back().t_ns) samples.push_back(sample);
  }
  return samples;
}

void add_mvsec_truth(const fs::path& name, PublicSequence& sequence) {
  const auto file = std::make_shared<H5File>(name);
  const PinholeCamera camera = sequence.camera.camera;
  if (file->has(kDavis + "pose"))
    sequence.groundtruth = read_h5_poses(*file, kDavis + "pose", kDavis + "pose_ts", 1, false);
  if (!file->has(kDavis + "depth_image_raw")) return;
  sequence.depth_times_s = read_h5_times(*file, kDavis + "depth_image_raw_ts", 1);
  sequence.load_depth = [file, camera](std::size_t index) {
    return read_h5_depth(*file, kDavis + "depth_image_raw", index, camera.width, camera.height);
  };
}

}  // namespace

bool is_mvsec(const fs::path& path) {
  const fs::path file = mvsec_file(path);
  return !file.empty() && is_hdf5(file) && H5File(file).has(kDavis + "events");
}

PublicSequence open_mvsec(const fs::path& path, const fs::path& calibration) {
  const fs::path name = mvsec_file(path);
  const auto file = std::make_shared<H5File>(name);
  PublicSequence sequence;
  sequence.layout = "MVSEC";
  sequence.events = name.string() + "!" + kDavis + "events";
  sequence.camera = mvsec_camera(name, calibration);
  const PinholeCamera camera = sequence.camera.camera;
  if (file->has(kDavis + "imu")) sequence.imu = mvsec_imu(*file);
  for (ImuSample& sample : sequence.imu)
    sample.t_ns -= ns_from_seconds(sequence.camera.timeshift_s);
  if (file->has(kDavis + "image_raw")) {
    sequence.frame_times_s = read_h5_times(*file, kDavis + "image_raw_ts", 1);
    sequence.load_frame = [file, camera](std::size_t index) {
      return read_h5_grey(*file, kDavis + "image_raw", index, camera.width, camera.height);
    };
  }
  std::string truth = name.filename().string();
  truth.replace(truth.size() - std::string("data.hdf5").size(), std::string::npos, "gt.hdf5");
  if (const fs::path file_of_truth = name.parent_path() / truth; fs::exists(file_of_truth))
    add_mvsec_truth(file_of_truth, sequence);
  return sequence;
}

}  // namespace saccade
