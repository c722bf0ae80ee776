#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "python/binding/bindings.h"
#include "python/binding/conversions.h"

namespace saccade::python {
namespace {

std::vector<double> times_of(const std::vector<StampedFile>& files) {
  std::vector<double> times;
  for (const StampedFile& file : files) times.push_back(file.t_s);
  return times;
}

/// Rows t ax ay az gx gy gz [s, m/s^2, rad/s].
py::array_t<double> imu_array(const std::vector<ImuSample>& samples) {
  py::array_t<double> array({static_cast<py::ssize_t>(samples.size()), py::ssize_t{7}});
  double* row = array.mutable_data();
  for (const ImuSample& sample : samples) {
    *row++ = seconds_from_ns(sample.t_ns);
    for (int k = 0; k < 3; ++k) *row++ = sample.specific_force[k];
    for (int k = 0; k < 3; ++k) *row++ = sample.angular_velocity[k];
  }
  return array;
}

py::dict labels_dict(EventLabels labels) {
  py::dict dict;
  dict["depth"] = values_array(std::move(labels.depth));
  dict["flow_x"] = values_array(std::move(labels.flow_x));
  dict["flow_y"] = values_array(std::move(labels.flow_y));
  dict["object"] = values_array(std::move(labels.object));
  dict["instance"] = values_array(std::move(labels.instance));
  dict["class_id"] = values_array(std::move(labels.class_id));
  dict["origin"] = values_array(std::move(labels.origin));
  return dict;
}

py::array load_events_of(const Dataset& dataset, double start_s, double end_s) {
  Events events;
  {
    const py::gil_scoped_release release;
    events = dataset.load_events(start_s, end_s);
  }
  return events_array(std::move(events));
}

ImageF unlocked(const Dataset& dataset, ImageF (Dataset::*load)(std::size_t) const,
                std::size_t index) {
  const py::gil_scoped_release release;
  return (dataset.*load)(index);
}

py::array_t<float> flow_array(const Dataset& dataset, std::size_t index) {
  const FlowField flow = [&] {
    const py::gil_scoped_release release;
    return dataset.load_flow(index);
  }();
  py::array_t<float> array({2, flow.u.height(), flow.u.width()});
  std::copy(flow.u.pixels().begin(), flow.u.pixels().end(), array.mutable_data());
  std::copy(flow.v.pixels().begin(), flow.v.pixels().end(), array.mutable_data(1, 0, 0));
  return array;
}

py::dict facts_dict(const DatasetFacts& facts) {
  py::dict dict;
  dict["name"] = facts.name;
  dict["mean_depth_m"] = facts.mean_depth_m;
  dict["contrast_on"] = facts.contrast_on;
  dict["contrast_off"] = facts.contrast_off;
  dict["log_eps"] = facts.log_eps;
  return dict;
}

}  // namespace

void bind_dataset(py::module_& module) {
  py::class_<Dataset>(module, "Dataset")
      .def(py::init([](const std::string& folder) { return Dataset::open(folder); }),
           py::call_guard<py::gil_scoped_release>())
      .def_property_readonly("folder", [](const Dataset& d) { return d.folder().string(); })
      .def_property_readonly("events_file",
                             [](const Dataset& d) { return d.events_file().string(); })
      .def_property_readonly("camera", [](const Dataset& d) { return camera_dict(d.camera()); })
      .def_property_readonly("facts", [](const Dataset& d) { return facts_dict(d.facts()); })
      .def_property_readonly(
          "config_yaml",
          [](const Dataset& d) { return d.record() ? d.record()->config_yaml : std::string(); })
      .def_property_readonly("poses",
                             [](const Dataset& d) { return poses_array(d.groundtruth().poses()); })
      .def_property_readonly("frame_times", [](const Dataset& d) { return times_of(d.frames()); })
      .def_property_readonly("depth_times",
                             [](const Dataset& d) { return times_of(d.depth_maps()); })
      .def_property_readonly("flow_times", [](const Dataset& d) { return times_of(d.flow_maps()); })
      .def_property_readonly("has_imu", &Dataset::has_imu)
      .def_property_readonly("has_labels", &Dataset::has_labels)
      .def_property_readonly("further_cameras",
                             [](const Dataset& d) {
                               std::vector<std::string> folders;
                               for (const auto& folder : d.further_cameras())
                                 folders.push_back(folder.string());
                               return folders;
                             })
      .def("load_events", &load_events_of)
      .def("load_frame",
           [](const Dataset& d, std::size_t i) {
             return image_array(unlocked(d, &Dataset::load_frame, i));
           })
      .def("load_depth",
           [](const Dataset& d, std::size_t i) {
             return image_array(unlocked(d, &Dataset::load_depth, i));
           })
      .def("load_flow", &flow_array)
      .def("load_imu", [](const Dataset& d) { return imu_array(d.load_imu()); })
      .def("load_labels", [](const Dataset& d, double start_s, double end_s) {
        return labels_dict(d.load_labels(start_s, end_s));
      });
}

}  // namespace saccade::python
