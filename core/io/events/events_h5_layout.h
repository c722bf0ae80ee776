#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/event.h"
#include "core/io/events/event_formats.h"
#include "core/io/tables/h5_handle.h"

namespace saccade {

/// A half-open range of event indices.
struct EventRange {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

/// An open HDF5 file and where its events lie: the columns, what their times mean, and what is known
/// of the sensor, in the layouts that events_h5.h lists. All errors are InputErrors with the file and
/// the path in it. Not thread-safe: callers hold an H5Lock.
class EventH5Layout {
 public:
  /// One of x, y, p and t: a dataset of its own, a field of a table, or a column of a matrix.
  struct Column {
    H5Handle dataset;
    std::string path;  ///< what errors call it
    std::string field;
    std::optional<hsize_t> matrix_column;
  };

  /// `path`: a file, or a place in it (event_file_place()).
  explicit EventH5Layout(const std::filesystem::path& path);

  [[noreturn]] void fail(const std::string& path, const std::string& problem) const;
  [[noreturn]] void fail_at(const std::string& path, std::uint64_t index,
                            const std::string& problem) const;

  /// Values of a column as `type`, which is that of T in memory.
  template <class T>
  void read(const Column& column, hid_t type, EventRange range, std::vector<T>& values) const {
    values.resize(range.end - range.begin);
    if (!values.empty()) read(column, type, sizeof(T), range, values.data());
  }

  std::string name;   ///< of the file
  std::string place;  ///< of the events in the file
  H5Handle file;
  Column x, y, p, t;
  bool times_in_seconds = false;
  std::uint64_t count = 0;
  TimeNs unit = 1000;  ///< of a tick [ns]
  SensorSize sensor;
  std::int64_t offset = 0;                              ///< of the times [ticks]
  std::optional<std::vector<std::uint64_t>> ms_to_idx;  ///< first event of every millisecond

 private:
  [[nodiscard]] std::string find_events(const std::string& member) const;
  void open_columns(const std::string& events);
  void open_table(const std::string& path);
  void open_matrix(const std::string& path);
  [[nodiscard]] H5Handle open_dataset(const std::string& path) const;
  [[nodiscard]] Column column(const std::string& path, std::size_t widest, bool may_be_signed);
  void take_length(const Column& column);
  void read_unit();
  void read_sensor();
  [[nodiscard]] int read_size(const char* side) const;
  [[nodiscard]] std::string read_text(hid_t object, const char* attribute) const;
  void read_offset();
  void read_index();
  void read(const Column& column, hid_t type, std::size_t size, EventRange range,
            void* values) const;

  bool has_length_ = false;  ///< whether `count` is known
};

}  // namespace saccade
