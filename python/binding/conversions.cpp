#include "python/binding/conversions.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

#include "core/error.h"
#include "core/event_pair.h"

namespace saccade::python {

namespace {

py::dtype make_event_dtype() {
  const auto list = [](auto... items) {
    py::list all;
    (all.append(items), ...);
    return all;
  };
  return py::dtype(list("x", "y", "p", "t"), list("<u2", "<u2", "?", "<i8"), list(8, 10, 12, 0),
                   sizeof(Event));
}

/// Events with -1 and 1 where numpy's have 0 and another number. Without a branch, which would be
/// guessed wrong at every other event.
EventPair with_signs(const EventPair& pair) {
  constexpr EventPair kPolarity = event_pair(0, std::int64_t{0xFF} << 32);
  constexpr EventPair kOn = event_pair(0, std::int64_t{1} << 32);
  const EventPair off = ((pair & kPolarity) == 0) & kPolarity;
  return (pair & ~kPolarity) | off | (kOn & ~off);
}

}  // namespace

py::dtype event_dtype() {
  // Made once, as that takes longer than tracking some hundred events; lives as long as numpy.
  static const py::handle made = make_event_dtype().release();
  return py::reinterpret_borrow<py::dtype>(made);
}

py::array events_array(Events events) {
  // numpy's bool is 0 or 1; 255, as which -1 would be read, is neither.
  for (Event& event : events) event.polarity = event.polarity > 0 ? 1 : 0;
  auto owned = std::make_unique<Events>(std::move(events));
  const auto count = static_cast<py::ssize_t>(owned->size());
  const void* data = owned->data();
  const py::capsule owner(owned.release(), [](void* p) { delete static_cast<Events*>(p); });
  return py::array(event_dtype(), {count}, {static_cast<py::ssize_t>(sizeof(Event))}, data, owner);
}

std::size_t event_count(const py::array& array) {
  if (array.ndim() != 1 || !(array.dtype().is(event_dtype()) || array.dtype().equal(event_dtype())))
    throw InputError("events",
                     "must be a one-dimensional array of saccade.EVENT_DTYPE (fields x, y, p, t); "
                     "saccade.Events(...) makes one of other arrays");
  return static_cast<std::size_t>(array.shape(0));
}

void copy_events(const py::array& array, std::span<Event> events) {
  const auto* at = static_cast<const std::byte*>(array.data());
  const py::ssize_t stride = array.strides(0);
  std::size_t i = 0;
  if (stride == static_cast<py::ssize_t>(sizeof(Event)))
    for (; i + 2 <= events.size(); i += 2, at += 2 * stride)
      store_event_pair(with_signs(load_event_pair(at)), &events[i]);
  for (; i < events.size(); ++i, at += stride) {
    std::array<std::int64_t, 2> words;
    std::memcpy(words.data(), at, sizeof(Event));
    const EventPair pair = with_signs(EventPair{words[0], words[1], 0, 0});
    std::memcpy(static_cast<void*>(&events[i]), &pair, sizeof(Event));
  }
}

Events events_from(const py::array& array) {
  Events events(event_count(array));
  copy_events(array, events);
  return events;
}

py::array_t<double> poses_array(std::span<const StampedPose> poses) {
  py::array_t<double> array({static_cast<py::ssize_t>(poses.size()), py::ssize_t{8}});
  double* row = array.mutable_data();
  for (const StampedPose& pose : poses) {
    const Eigen::Vector3d& t = pose.world_from_camera.translation();
    const Eigen::Quaterniond& q = pose.world_from_camera.rotation();
    for (const double value : {pose.t_s, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()})
      *row++ = value;
  }
  return array;
}

std::vector<StampedPose> poses_from(const PoseArray& array, const std::string& name) {
  constexpr double kUnitTolerance = 1e-3;
  if (array.ndim() != 2 || array.shape(1) != 8)
    throw InputError(name, "must have rows t x y z qx qy qz qw, that is the shape (N, 8)");
  std::vector<StampedPose> poses;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const double* v = array.data(i, 0);
    const auto fail = [&](const std::string& problem) {
      throw InputError(fmt::format("{}[{}]", name, i), problem);
    };
    for (int k = 0; k < 8; ++k)
      if (!std::isfinite(v[k])) fail(fmt::format("number {} is not finite", k));
    const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
    if (!(std::abs(q.norm() - 1) <= kUnitTolerance))
      fail(fmt::format("the quaternion's length is {:.6g}; a rotation's is 1", q.norm()));
    if (!poses.empty() && !(v[0] > poses.back().t_s))
      fail(fmt::format("times must increase: {:.9f} s after {:.9f} s", v[0], poses.back().t_s));
    poses.push_back({v[0], {q, {v[1], v[2], v[3]}}});
  }
  return poses;
}

py::array_t<float> image_array(const ImageF& image) {
  return py::array_t<float>({image.height(), image.width()}, image.data());
}

py::dict metrics_dict(const Metrics& metrics) {
  py::dict dict;
  for (const auto& [key, value] : metrics.values())
    dict[py::str(key)] = value ? py::object(py::float_(*value)) : py::none();
  return dict;
}

py::dict camera_dict(const PinholeCamera& camera) {
  py::dict dict;
  dict["width"] = camera.width;
  dict["height"] = camera.height;
  dict["fx"] = camera.fx;
  dict["fy"] = camera.fy;
  dict["cx"] = camera.cx;
  dict["cy"] = camera.cy;
  py::list distortion;
  for (const double k : camera.distortion) distortion.append(k);
  dict["distortion"] = distortion;
  return dict;
}

}  // namespace saccade::python
