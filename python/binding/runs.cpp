#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <vector>

#include "core/io/covariance_file.h"
#include "core/io/images/exr_file.h"
#include "core/io/run/view_list.h"
#include "core/io/trajectory_file.h"
#include "core/process/parallel.h"
#include "estimator/external/external_module.h"
#include "estimator/registry.h"
#include "eval/run_folder.h"
#include "python/binding/bindings.h"
#include "python/binding/conversions.h"
#include "python/binding/interruption.h"

namespace saccade::python {
namespace {

py::dict summary_dict(const RunSummary& summary) {
  py::dict dict;
  dict["found"] = summary.found;
  dict["events"] = summary.events;
  dict["poses"] = summary.poses;
  dict["lost_poses"] = summary.lost_poses;
  dict["lost_since_s"] = summary.lost_since_s;
  dict["wall_s"] = summary.wall_s;
  return dict;
}

py::dict run_by_name(const std::string& name, RunRequest request, const py::object& progress) {
  request.threads = thread_count();
  return summary_dict(without_lock(progress, [&] { return run_module(name, request); }));
}

/// `method(camera, events, start, imu, seed)` gives rows of poses and seconds.
py::dict run_python_method(RunRequest request, const py::function& method) {
  request.threads = thread_count();
  return summary_dict(without_lock(py::none(), [&] {
    return run_method(request, [&](const MethodInputs& inputs) {
      const py::gil_scoped_acquire lock;
      py::array_t<double> imu({static_cast<py::ssize_t>(inputs.imu.size()), py::ssize_t{7}});
      double* row = imu.mutable_data();
      for (const ImuSample& sample : inputs.imu) {
        *row++ = seconds_from_ns(sample.t_ns);
        for (int k = 0; k < 3; ++k) *row++ = sample.specific_force[k];
        for (int k = 0; k < 3; ++k) *row++ = sample.angular_velocity[k];
      }
      const py::tuple found = method(camera_dict(inputs.camera),
                                     events_array({inputs.events.begin(), inputs.events.end()}),
                                     poses_array(inputs.start.poses()), imu, inputs.seed);
      return MethodResult{poses_from(found[0].cast<PoseArray>(), "poses"), found[1].cast<double>()};
    });
  }));
}

py::dict pose_columns(const std::vector<PoseRow>& rows) {
  std::vector<double> t, inliers, residual, probability;
  std::vector<std::string> status;
  for (const PoseRow& row : rows) {
    t.push_back(row.t_s);
    status.push_back(row.status);
    inliers.push_back(row.inlier_ratio);
    residual.push_back(row.residual);
    probability.push_back(row.probability);
  }
  py::dict dict;
  dict["t"] = values_array(std::move(t));
  dict["status"] = status;
  dict["inlier_ratio"] = values_array(std::move(inliers));
  dict["residual"] = values_array(std::move(residual));
  dict["probability"] = values_array(std::move(probability));
  return dict;
}

py::tuple covariance_arrays(const RunFolder& run) {
  const std::vector<StampedCovariance> all = run.load_covariances();
  const auto count = static_cast<py::ssize_t>(all.size());
  py::array_t<double> times(count);
  py::array_t<double> matrices({count, py::ssize_t{6}, py::ssize_t{6}});
  for (py::ssize_t i = 0; i < count; ++i) {
    const StampedCovariance& entry = all[static_cast<std::size_t>(i)];
    times.mutable_at(i) = entry.t_s;
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) matrices.mutable_at(i, r, c) = entry.covariance(r, c);
  }
  return py::make_tuple(times, matrices);
}

py::list view_dicts(const std::string& file) {
  py::list views;
  for (const RunView& view : read_view_list(file)) {
    const StampedPose pose{view.t_s, view.world_from_camera};
    py::dict dict;
    dict["t"] = view.t_s;
    dict["pose"] = poses_array(std::span(&pose, 1));
    dict["depth"] = view.depth.string();
    dict["gradient"] = view.gradient.string();
    dict["image"] = view.image.string();
    views.append(dict);
  }
  return views;
}

py::dict exr_dict(const std::string& file) {
  py::dict dict;
  for (const ExrChannel& channel : read_exr_channels(file))
    dict[py::str(channel.name)] = image_array(channel.image);
  return dict;
}

py::array_t<float> cloud_array(const RunFolder& run) {
  const PointCloud cloud = run.load_map();
  py::array_t<float> array({static_cast<py::ssize_t>(cloud.positions.size()), py::ssize_t{3}});
  float* row = array.mutable_data();
  for (const auto& point : cloud.positions)
    for (int k = 0; k < 3; ++k) *row++ = static_cast<float>(point[k]);
  return array;
}

RunRequest make_request(const config::Document& config, const std::string& dataset,
                        const std::string& output, const py::dict& options) {
  RunRequest request;
  request.config = config;
  request.dataset = dataset;
  request.output = output;
  const auto take = [&](const char* key, auto& target) {
    if (options.contains(key) && !options[key].is_none())
      target = options[key].cast<std::decay_t<decltype(*target)>>();
  };
  const auto take_path = [&](const char* key, std::optional<std::filesystem::path>& target) {
    if (options.contains(key) && !options[key].is_none()) target = options[key].cast<std::string>();
  };
  take("start_s", request.start_s);
  take("duration_s", request.duration_s);
  take("seed", request.seed);
  take_path("poses_from", request.poses_from);
  take("smooth_poses_s", request.smooth_poses_s);
  take_path("depth_from", request.depth_from);
  take_path("from", request.from);
  if (options.contains("repeat")) request.repeat = options["repeat"].cast<int>();
  if (options.contains("command")) request.command = options["command"].cast<std::string>();
  return request;
}

}  // namespace

void bind_runs(py::module_& module) {
  py::class_<RunRequest>(module, "RunRequest").def(py::init(&make_request));
  module.def("run_module", &run_by_name);
  module.def("run_method", &run_python_method);
  module.def("write_trajectory", [](const std::string& file, const PoseArray& poses) {
    write_tum_trajectory(file, poses_from(poses, "poses"));
  });
  module.def("read_exr", &exr_dict);
  module.def("read_views", &view_dicts);
  py::class_<RunFolder>(module, "RunFolder")
      .def(py::init([](const std::string& folder) { return RunFolder::open(folder); }))
      .def_property_readonly("module", [](const RunFolder& r) { return r.record.module; })
      .def_property_readonly("dataset",
                             [](const RunFolder& r) { return r.record.dataset.string(); })
      .def_property_readonly("problem", [](const RunFolder& r) { return r.record.problem(); })
      .def_property_readonly("config_yaml", [](const RunFolder& r) { return r.record.config_yaml; })
      .def_property_readonly("trajectory",
                             [](const RunFolder& r) -> py::object {
                               if (!r.trajectory) return py::none();
                               return poses_array(r.trajectory->poses());
                             })
      .def_property_readonly("poses",
                             [](const RunFolder& r) -> py::object {
                               if (!r.poses) return py::none();
                               return pose_columns(*r.poses);
                             })
      .def_property_readonly("timing", [](const RunFolder& r) { return metrics_dict(r.timing); })
      .def_property_readonly("metrics", [](const RunFolder& r) { return metrics_dict(r.metrics); })
      .def("covariances", &covariance_arrays)
      .def("map", &cloud_array);
}

}  // namespace saccade::python
