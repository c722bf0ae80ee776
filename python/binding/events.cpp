#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/events/event_file.h"
#include "core/representation/event_filter.h"
#include "core/representation/event_frame.h"
#include "core/representation/voxel_grid.h"
#include "python/binding/bindings.h"
#include "python/binding/conversions.h"

namespace saccade::python {
namespace {

py::array_t<float> grid_array(const EventGrid& grid, int channels, const SensorSize& size) {
  return py::array_t<float>({channels, size.height, size.width}, grid.data());
}

/// One window over all of `events`; the times [ns] may be wider than theirs.
GridWindow window_over(const Events& events, std::optional<TimeNs> from_ns,
                       std::optional<TimeNs> to_ns) {
  GridWindow window;
  window.last = events.size();
  window.from_ns = from_ns.value_or(events.empty() ? 0 : events.front().t_ns);
  window.to_ns = to_ns.value_or(events.empty() ? 0 : events.back().t_ns);
  return window;
}

void expect_on_sensor(const Events& events, const SensorSize& size) {
  for (std::size_t i = 0; i < events.size(); ++i)
    if (events[i].x >= size.width || events[i].y >= size.height)
      throw InputError(fmt::format("events[{}]", i),
                       fmt::format("pixel ({}, {}) is not on the sensor of {} x {} pixels",
                                   events[i].x, events[i].y, size.width, size.height));
}

py::array_t<float> make_voxel_grid(const py::array& array, const SensorSize& size,
                                   const config::Document& options, std::optional<TimeNs> from_ns,
                                   std::optional<TimeNs> to_ns) {
  const auto stated = config::read<VoxelGridOptions>(options);
  const Events events = events_from(array);
  expect_on_sensor(events, size);
  EventGrid grid;
  {
    const py::gil_scoped_release release;
    grid = voxel_grid(events, window_over(events, from_ns, to_ns), size, stated);
  }
  return grid_array(grid, stated.channels(), size);
}

py::array_t<float> make_event_frame(const py::array& array, const SensorSize& size,
                                    const config::Document& options, std::optional<TimeNs> from_ns,
                                    std::optional<TimeNs> to_ns) {
  const auto stated = config::read<FrameGridOptions>(options);
  const Events events = events_from(array);
  expect_on_sensor(events, size);
  EventGrid grid;
  {
    const py::gil_scoped_release release;
    grid = EventFrameMaker(size, stated).next(events, window_over(events, from_ns, to_ns));
  }
  return grid_array(grid, stated.channels(), size);
}

py::array next_events(EventStream& stream) {
  Events events;
  {
    const py::gil_scoped_release release;
    const std::span<const Event> next = stream.next();
    events.assign(next.begin(), next.end());
  }
  return events_array(std::move(events));
}

py::dict event_file_info(const std::string& file) {
  const EventFileInfo info = [&] {
    const py::gil_scoped_release release;
    return read_event_file_info(file);
  }();
  py::dict dict;
  dict["count"] = info.count;
  dict["first_ns"] = info.first_ns;
  dict["last_ns"] = info.last_ns;
  dict["width"] = info.sensor.width;
  dict["height"] = info.sensor.height;
  return dict;
}

void write_event_file(const std::string& file, const py::array& array, const SensorSize& size) {
  const Events events = events_from(array);
  const py::gil_scoped_release release;
  const auto writer = make_event_writer(file, TimestampUnit::kNanoseconds, size);
  writer->append(events);
  writer->close();
}

py::array_t<bool> supported_mask(const py::array& array, const SensorSize& size, TimeNs within_ns) {
  const Events events = events_from(array);
  expect_on_sensor(events, size);
  const std::vector<std::uint8_t> is_supported = supported_events(events, size, within_ns);
  py::array_t<bool> mask(static_cast<py::ssize_t>(is_supported.size()));
  std::copy(is_supported.begin(), is_supported.end(), mask.mutable_data());
  return mask;
}

}  // namespace

void bind_events(py::module_& module) {
  module.attr("EVENT_DTYPE") = event_dtype();
  py::class_<SensorSize>(module, "SensorSize").def(py::init([](int width, int height) {
    return SensorSize{width, height};
  }));
  module.def("voxel_grid", &make_voxel_grid);
  module.def("event_frame", &make_event_frame);
  module.def("supported_events", &supported_mask);
  module.def("event_file_info", &event_file_info);
  module.def("write_events", &write_event_file);
  py::class_<EventStream>(module, "EventStream")
      .def(py::init([](const std::string& file, const SensorSize& size) {
        return std::make_unique<EventStream>(file, size);
      }))
      .def("next", &next_events)
      .def_property_readonly("size", [](const EventStream& stream) {
        return std::pair(stream.sensor().width, stream.sensor().height);
      });
}

}  // namespace saccade::python
