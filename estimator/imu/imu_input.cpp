#include "estimator/imu/imu_input.h"

#include "core/error.h"
#include "core/io/calibration_file.h"

namespace saccade {

ImuInput load_imu_input(const Dataset& dataset, const std::string& needs) {
  const std::string place = dataset.folder().string();
  if (!dataset.has_imu()) throw InputError(place, "holds no imu.txt, which " + needs + " needs");
  ImuInput input;
  input.samples = dataset.load_imu();
  if (input.samples.empty())
    throw InputError(place, "holds an imu.txt without readings; " + needs + " needs them");
  const std::filesystem::path chain = dataset.folder() / "camera.yaml";
  if (std::filesystem::exists(chain))
    if (const auto camera_from_imu = read_camera_chain(chain).front().camera_from_imu)
      input.camera_from_imu = camera_from_imu->rotation_matrix();
  return input;
}

}  // namespace saccade
