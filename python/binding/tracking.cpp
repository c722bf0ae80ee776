#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/event_file.h"
#include "estimator/tracking/live_tracker.h"
#include "python/binding/bindings.h"
#include "python/binding/conversions.h"

namespace saccade::python {
namespace {

/// From the dataset's first event to its last, unless another window is stated.
std::unique_ptr<LiveTracker> make_tracker(const config::Document& document,
                                          const std::string& folder,
                                          const std::optional<double>& start_s,
                                          const std::optional<double>& duration_s) {
  const auto config = config::read<TrackConfig>(document);
  const py::gil_scoped_release release;
  const Dataset dataset = Dataset::open(folder);
  if (dataset.events_file().empty() && !start_s)
    throw InputError(folder, "holds no events; state start_s, from which events are fed");
  EventFileInfo info;
  if (!dataset.events_file().empty()) info = read_event_file_info(dataset.events_file());
  const double from_s = start_s.value_or(seconds_from_ns(info.first_ns));
  const double to_s = duration_s       ? from_s + *duration_s
                      : info.count > 0 ? seconds_from_ns(info.last_ns)
                                       : std::numeric_limits<double>::infinity();
  return std::make_unique<LiveTracker>(config, dataset, from_s, to_s);
}

/// Rows of poses, and of what says how good they are: is_lost, probability, inlier_ratio, residual,
/// position_sigma_m, rotation_sigma_rad. Two arrays, because making one takes as long as a pose.
py::tuple pose_arrays(const std::vector<TrackedPose>& poses) {
  std::vector<StampedPose> stamped;
  stamped.reserve(poses.size());
  py::array_t<double> evidence({static_cast<py::ssize_t>(poses.size()), py::ssize_t{6}});
  double* row = evidence.mutable_data();
  for (const TrackedPose& pose : poses) {
    stamped.push_back({seconds_from_ns(pose.t_ns), pose.world_from_camera});
    for (const double value :
         {pose.status == TrackStatus::kLost ? 1.0 : 0.0, pose.probability, pose.inlier_ratio,
          pose.residual, pose.position_sigma_m, pose.rotation_sigma_rad})
      *row++ = value;
  }
  return py::make_tuple(poses_array(stamped), evidence);
}

py::tuple feed(LiveTracker& tracker, const py::array& array) {
  copy_events(array, tracker.room(event_count(array)));
  std::vector<TrackedPose> poses;
  {
    const py::gil_scoped_release release;
    poses = tracker.feed();
  }
  return pose_arrays(poses);
}

py::tuple finish(LiveTracker& tracker) {
  std::vector<TrackedPose> poses;
  {
    const py::gil_scoped_release release;
    poses = tracker.finish();
  }
  return pose_arrays(poses);
}

py::array_t<double> map_array(const LiveTracker& tracker) {
  const MapPoints& map = tracker.world().edge_points;
  const Rigid3& world_from_map = tracker.world().intensity_map.world_from_map();
  py::array_t<double> array({static_cast<py::ssize_t>(map.size()), py::ssize_t{3}});
  double* row = array.mutable_data();
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Eigen::Vector3d point =
        world_from_map * Eigen::Vector3f(map.x[i], map.y[i], map.z[i]).cast<double>();
    for (int k = 0; k < 3; ++k) *row++ = point[k];
  }
  return array;
}

}  // namespace

void bind_tracking(py::module_& module) {
  py::class_<LiveTracker>(module, "LiveTracker")
      .def(py::init(&make_tracker))
      .def("feed", &feed)
      .def("finish", &finish)
      .def_property_readonly("waiting", &LiveTracker::waiting)
      .def_property_readonly("map", &map_array);
}

}  // namespace saccade::python
