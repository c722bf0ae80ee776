#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"
#include "eval/metrics/metrics.h"

namespace saccade::python {

namespace py = pybind11;

/// Whatever numpy turns into rows t x y z qx qy qz qw.
using PoseArray = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Fields x, y (u16), p (bool) and t (i64, ns) where Event has them, so that arrays of events are
/// views of its memory.
[[nodiscard]] py::dtype event_dtype();

/// A one-dimensional array of event_dtype() that owns the events; nothing is copied.
[[nodiscard]] py::array events_array(Events events);

/// Length of an array of event_dtype(). Throws InputError for another type or shape.
[[nodiscard]] std::size_t event_count(const py::array& array);
/// Copies all of such an array; `events` is as long.
void copy_events(const py::array& array, std::span<Event> events);
/// Both.
[[nodiscard]] Events events_from(const py::array& array);

/// Poses as rows t x y z qx qy qz qw, seconds and metres, (N, 8) float64.
[[nodiscard]] py::array_t<double> poses_array(std::span<const StampedPose> poses);

/// The inverse. Throws InputError that calls the array `name` for another shape, what is not finite,
/// times that do not increase, and quaternions whose length is off 1 by more than 1e-3.
[[nodiscard]] std::vector<StampedPose> poses_from(const PoseArray& array, const std::string& name);

/// (height, width) float32.
[[nodiscard]] py::array_t<float> image_array(const ImageF& image);

/// An array that owns the values.
template <class T>
[[nodiscard]] py::array_t<T> values_array(std::vector<T> values) {
  auto* owned = new std::vector<T>(std::move(values));
  const py::capsule owner(owned, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(static_cast<py::ssize_t>(owned->size()), owned->data(), owner);
}

/// Keys as in metrics.json, with dots; None where nothing was measured.
[[nodiscard]] py::dict metrics_dict(const Metrics& metrics);

/// width, height, fx, fy, cx, cy [px] and distortion (k1 k2 p1 p2 k3), as a configuration has them.
[[nodiscard]] py::dict camera_dict(const PinholeCamera& camera);

}  // namespace saccade::python
