#include <fmt/format.h>

#include "core/error.h"
#include "core/io/import/camera_files.h"
#include "core/io/import/folder_search.h"
#include "core/io/import/layouts.h"
#include "core/io/tables/h5_file.h"
#include "core/io/trajectory_file.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

ChainCamera eds_camera(const fs::path& folder, const fs::path& calibration) {
  if (!calibration.empty()) return read_any_calibration(calibration, {});
  fs::path chain = find_near(folder, "camchain", ".yaml");
  if (chain.empty()) chain = find_near(folder, "calib", ".yaml");
  if (chain.empty())
    throw InputError(
        folder.string(),
        "has no camchain*.yaml or calib*.yaml in it, beside it or in a folder of both; "
        "name the calibration of the event camera with --calibration");
  // The frame camera comes first, where it is there.
  const std::size_t last = read_camera_chain(chain).size() - 1;
  return read_any_calibration(chain.string() + fmt::format("!/cam{}", last), {});
}

}  // namespace

bool is_eds(const fs::path& folder) {
  const fs::path events = folder / "events.h5";
  return fs::is_regular_file(events) && fs::exists(folder / "stamped_groundtruth.txt") &&
         !fs::exists(folder / "dataset.yaml") && is_hdf5(events) && H5File(events).has("/t");
}

PublicSequence open_eds(const fs::path& folder, const fs::path& calibration) {
  PublicSequence sequence;
  sequence.layout = "EDS";
  sequence.events = folder / "events.h5";
  sequence.camera = eds_camera(folder, calibration);
  const Trajectory truth = read_tum_trajectory(folder / "stamped_groundtruth.txt");
  sequence.groundtruth.assign(truth.poses().begin(), truth.poses().end());
  return sequence;
}

}  // namespace saccade
