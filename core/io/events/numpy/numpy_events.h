#pragma once

#include <filesystem>
#include <memory>

#include "core/io/events/event_file.h"
#include "core/io/events/event_formats.h"

namespace saccade {

/// Events in NumPy's formats: an array (.npy) or an archive of arrays (.npz), not of Python objects:
///   a structured array with fields t, x, y and p, each by one of its usual names;
///   a plain array of N rows t, x, y, p;
///   in an archive, one of these or four arrays t, x, y and p.
/// Whole times are in us, or in ns where an array `t_unit` of the archive says "ns"; others in
/// seconds. Polarities are 0 and 1, or -1 and 1. Arrays `width` and `height` state the sensor.
/// InputError with the place "FILE:[INDEX]".
[[nodiscard]] std::unique_ptr<EventReader> open_numpy(const std::filesystem::path& file,
                                                      SensorSize size, TimeWindow window);

[[nodiscard]] bool is_npy(const EventFileHead& head);
/// An archive that holds arrays.
[[nodiscard]] bool is_npz(const EventFileHead& head);

/// Four arrays t (i64), x, y (u16), p (u8), with t_unit and, where it is known, width and height.
[[nodiscard]] std::unique_ptr<EventWriter> make_npz_writer(const std::filesystem::path& file,
                                                           TimestampUnit unit, SensorSize sensor);

}  // namespace saccade
