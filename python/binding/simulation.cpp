#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "python/binding/bindings.h"
#include "python/binding/conversions.h"
#include "python/binding/interruption.h"
#include "simulator/dataset_cache.h"
#include "simulator/live_simulation.h"
#include "simulator/simulate.h"
#include "simulator/steered_camera.h"

namespace saccade::python {
namespace {

void run_simulation(const config::Document& document, const std::string& output,
                    const py::object& progress) {
  const auto config = config::read<SimulationConfig>(document);
  without_lock(progress, [&] {
    unlink_dataset(output);
    return simulate(config, output);
  });
}

py::array take_until(LiveSimulation& simulation, double t_s) {
  return events_array(
      without_lock(py::none(), [&] { return simulation.take_until(t_s, check_signals); }));
}

py::array_t<double> sampled_poses(const LiveSimulation& simulation,
                                  const std::vector<double>& times_s) {
  std::vector<StampedPose> poses;
  for (const double t_s : times_s) poses.push_back({t_s, simulation.world_from_camera().pose(t_s)});
  return poses_array(poses);
}

py::tuple flow_images(const FlowField& flow) {
  return py::make_tuple(image_array(flow.u), image_array(flow.v));
}

std::unique_ptr<SteeredCamera> make_steered_camera(const config::Document& document,
                                                   const PoseArray& start, double dt_s) {
  const std::vector<StampedPose> poses = poses_from(start, "start");
  if (poses.size() != 1) throw InputError("start", "must be one pose");
  const auto config = config::read<SimulationConfig>(document);
  const py::gil_scoped_release release;
  return std::make_unique<SteeredCamera>(config, poses.front().world_from_camera, dt_s);
}

py::array advance(SteeredCamera& camera, const std::vector<double>& command) {
  if (command.size() != 6) throw InputError("policy", "must return six numbers: vx vy vz wx wy wz");
  return events_array(without_lock(
      py::none(), [&] { return camera.advance(Eigen::Map<const Twist>(command.data())); }));
}

/// What render() gives, without the interpreter's lock, as an array.
template <class Render>
py::array_t<float> rendered(const Render& render) {
  return image_array(without_lock(py::none(), render));
}

}  // namespace

void bind_simulation(py::module_& module) {
  module.def("simulate", &run_simulation, py::arg("document"), py::arg("output"),
             py::arg("progress"));
  py::class_<LiveSimulation>(module, "LiveSimulation")
      .def(py::init([](const config::Document& document) {
        const auto config = config::read<SimulationConfig>(document);
        const py::gil_scoped_release release;
        return std::make_unique<LiveSimulation>(config);
      }))
      .def_property_readonly("camera",
                             [](const LiveSimulation& s) { return camera_dict(s.camera()); })
      .def_property_readonly("duration_s", &LiveSimulation::duration_s)
      .def("restart", &LiveSimulation::restart)
      .def("take_until", &take_until)
      .def("poses", &sampled_poses)
      .def("frame", [](const LiveSimulation& s,
                       double t_s) { return rendered([&] { return s.frame(t_s); }); })
      .def("depth", [](const LiveSimulation& s,
                       double t_s) { return rendered([&] { return s.depth(t_s); }); })
      .def("flow", [](const LiveSimulation& s, double t_s) {
        return flow_images(without_lock(py::none(), [&] { return s.flow(t_s); }));
      });
  py::class_<SteeredCamera>(module, "SteeredCamera")
      .def(py::init(&make_steered_camera))
      .def_property_readonly("camera",
                             [](const SteeredCamera& c) { return camera_dict(c.camera()); })
      .def_property_readonly("t_s", &SteeredCamera::t_s)
      .def_property_readonly("pose",
                             [](const SteeredCamera& c) {
                               const StampedPose pose{c.t_s(), c.world_from_camera()};
                               return poses_array(std::span(&pose, 1));
                             })
      .def("advance", &advance)
      .def("frame", [](const SteeredCamera& c) { return rendered([&] { return c.frame(); }); })
      .def("depth", [](const SteeredCamera& c) { return rendered([&] { return c.depth(); }); });
}

}  // namespace saccade::python
