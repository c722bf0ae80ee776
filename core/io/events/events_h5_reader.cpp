#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/io/events/event_formats.h"
#include "core/io/events/events_h5.h"
#include "core/io/events/packed_columns.h"
#include "core/io/tables/h5_file.h"
#include "core/io/tables/h5_handle.h"
#include "core/process/parallel.h"
#include "core/time_search.h"

namespace saccade {
namespace {

constexpr std::uint64_t kH5Block = std::uint64_t{1} << 20;  // events in memory besides the result
constexpr std::size_t kH5Grain = std::size_t{1} << 16;      // that one thread makes at a time

/// Smallest tick whose time is not before `t_ns`.
std::int64_t ceil_ticks(TimeNs t_ns, TimeNs unit) {
  return t_ns / unit + static_cast<std::int64_t>(t_ns % unit > 0);
}

std::int64_t saturating_subtract(std::int64_t a, std::int64_t b) {
  std::int64_t result = 0;
  if (!__builtin_sub_overflow(a, b, &result)) return result;
  return a < 0 ? std::numeric_limits<std::int64_t>::min()
               : std::numeric_limits<std::int64_t>::max();
}

/// A half-open range of event indices.
struct Range {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

/// One of x, y, p and t: a dataset of its own, a field of a table, or a column of a matrix.
struct Column {
  H5Handle dataset;
  std::string path;  ///< what errors call it
  std::string field;
  std::optional<hsize_t> matrix_column;
};

/// Where events are looked for when nobody says it (events_h5.h).
constexpr std::array<const char*, 5> kUsualPlaces{"/events", "/CD/events", "/prophesee/left",
                                                  "/davis/left/events", "/"};

bool is_group(hid_t file, const std::string& path) {
  H5O_info_t info;
  return H5Oget_info_by_name(file, path.c_str(), &info, H5P_DEFAULT) >= 0 &&
         info.type == H5O_TYPE_GROUP;
}

std::string below(const std::string& group, const char* name) {
  return group == "/" ? group + name : group + "/" + name;
}

}  // namespace

struct EventH5Reader::State {
  explicit State(const std::filesystem::path& path) : name(event_file_place(path).file.string()) {
    const H5Lock lock;
    open(name);
    open_columns(find_events(event_file_place(path).member));
    read_sensor();
    if (!times_in_seconds && x.field.empty())
      packed = PackedColumns::of(x.dataset, y.dataset, p.dataset, t.dataset);
    if (place != "/events" && place != "/") return;
    read_offset();
    read_index();
  }

  [[noreturn]] void fail(const std::string& path, const std::string& problem) const {
    throw InputError(name + ":" + path, problem);
  }
  [[noreturn]] void fail_at(const char* path, std::uint64_t index,
                            const std::string& problem) const {
    fail(std::string(path) + "[" + std::to_string(index) + "]", problem);
  }

  void open(const std::filesystem::path& file_name);
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

  template <class T>
  void read(const Column& column, hid_t type, Range range, std::vector<T>& values) const;
  [[nodiscard]] std::vector<std::int64_t> read_seconds(Range range) const;
  [[nodiscard]] std::vector<std::int64_t> read_times(Range range) const;
  void check_order(std::span<const std::int64_t> times, std::uint64_t first) const;
  void read_columns(Range range, EventColumns& columns) const;
  [[nodiscard]] Range bracket(std::int64_t start_tick, std::int64_t end_tick) const;
  [[nodiscard]] Range find(TimeWindow window) const;
  [[nodiscard]] TimeNs time_ns(std::int64_t tick, std::uint64_t index) const;
  void append_block(Range range, SensorSize size, Events& events) const;
  [[nodiscard]] bool make_events(const EventColumns& columns, SensorSize size,
                                 std::span<Event> events) const;
  [[noreturn]] void report(const EventColumns& columns, std::uint64_t first, SensorSize size,
                           TimeNs last_ns) const;

  std::string name;
  std::string place;  ///< of the events in the file
  H5Handle file;
  Column x, y, p, t;
  std::optional<PackedColumns> packed;  ///< of these, where they are stored so
  bool times_in_seconds = false;
  bool is_opened = false;  ///< whether `count` is known
  std::uint64_t count = 0;
  TimeNs unit = 1000;  ///< [ns]
  SensorSize sensor;
  std::int64_t offset = 0;
  std::optional<std::vector<std::uint64_t>> ms_to_idx;
};

void EventH5Reader::State::open(const std::filesystem::path& file_name) {
  if (!std::filesystem::exists(file_name)) throw InputError(name, "no such file");
  const H5Handle access = {H5Pcreate(H5P_FILE_ACCESS), H5Pclose};
  H5Pset_file_locking(access, false, true);  // read-only media and parallel readers
  file = {H5Fopen(file_name.c_str(), H5F_ACC_RDONLY, access), H5Fclose};
  if (!file.valid())
    throw InputError(name,
                     "is no HDF5 file, or is truncated or damaged (HDF5: " + h5_reason() + ")");
}

/// The path of a group of columns or of a dataset.
std::string EventH5Reader::State::find_events(const std::string& member) const {
  if (!member.empty()) {
    if (!has_h5_link(file, member)) fail(member, "there is no such group or dataset");
    return is_group(file, member) && has_h5_link(file, below(member, "events"))
               ? below(member, "events")
               : member;
  }
  for (const std::string usual : kUsualPlaces)
    if (has_h5_link(file, usual) && (usual != "/" || has_h5_link(file, "/t"))) return usual;
  fail("/events", fmt::format("the group is missing; events are looked for there and in {}",
                              fmt::join(kUsualPlaces.begin() + 1, kUsualPlaces.end(), ", ")));
}

void EventH5Reader::State::open_columns(const std::string& events) {
  place = events;
  if (!is_group(file, events)) {
    const H5Handle dataset = {H5Dopen2(file, events.c_str(), H5P_DEFAULT), H5Dclose};
    if (!dataset.valid()) fail(events, "is no dataset that can be opened");
    const H5Handle type = {H5Dget_type(dataset), H5Tclose};
    return H5Tget_class(type) == H5T_COMPOUND ? open_table(events) : open_matrix(events);
  }
  // Those of DSEC are 0 and 1; others write bytes with a sign.
  const bool may_be_signed = events != "/events";
  x = column(below(events, "x"), 2, may_be_signed);
  y = column(below(events, "y"), 2, may_be_signed);
  p = column(below(events, "p"), 1, may_be_signed);
  t = column(below(events, "t"), 8, true);
  read_unit();
}

/// Prophesee's rows of x, y, p and t [us].
void EventH5Reader::State::open_table(const std::string& path) {
  const auto open_field = [&](const char* field) {
    Column column{{H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose},
                  path + "." + field,
                  field,
                  std::nullopt};
    const H5Handle type = {H5Dget_type(column.dataset), H5Tclose};
    const int index = H5Tget_member_index(type, field);
    if (index < 0 || H5Tget_member_class(type, static_cast<unsigned>(index)) != H5T_INTEGER)
      fail(path, fmt::format("must hold rows with the whole numbers x, y, p and t; {} is none of "
                             "them",
                             field));
    take_length(column);
    return column;
  };
  x = open_field("x");
  y = open_field("y");
  p = open_field("p");
  t = open_field("t");
}

/// MVSEC's rows x y t p, t in seconds.
void EventH5Reader::State::open_matrix(const std::string& path) {
  constexpr std::array<const char*, 4> kNames{"x", "y", "t", "p"};
  std::array<Column, 4> columns;
  for (hsize_t i = 0; i < columns.size(); ++i) {
    columns[i] = {{H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose},
                  fmt::format("{}.{}", path, kNames[i]),
                  "",
                  i};
    const H5Handle space = {H5Dget_space(columns[i].dataset), H5Sclose};
    std::array<hsize_t, 2> size{};
    if (H5Sget_simple_extent_ndims(space) != 2 ||
        H5Sget_simple_extent_dims(space, size.data(), nullptr) != 2 || size[1] != columns.size())
      fail(path, "must be a table of x, y, p and t, or a matrix of rows x y t p");
    const H5Handle type = {H5Dget_type(columns[i].dataset), H5Tclose};
    if (H5Tget_class(type) != H5T_FLOAT || H5Tget_size(type) != 8)
      fail(path, "must hold numbers of double precision, t in seconds");
    take_length(columns[i]);
  }
  x = std::move(columns[0]);
  y = std::move(columns[1]);
  t = std::move(columns[2]);
  p = std::move(columns[3]);
  times_in_seconds = true;
}

H5Handle EventH5Reader::State::open_dataset(const std::string& path) const {
  if (!has_h5_link(file, path)) fail(path, "the dataset is missing");
  H5Handle dataset = {H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose};
  if (!dataset.valid()) fail(path, "is no dataset that can be opened");
  const H5Handle type = {H5Dget_type(dataset), H5Tclose};
  if (H5Tget_class(type) != H5T_INTEGER) fail(path, "must hold whole numbers");
  return dataset;
}

/// Opens a column; its integers have at most `widest` bytes.
Column EventH5Reader::State::column(const std::string& path, std::size_t widest,
                                    bool may_be_signed) {
  Column column{open_dataset(path), path, "", std::nullopt};
  const H5Handle type = {H5Dget_type(column.dataset), H5Tclose};
  if (H5Tget_size(type) > widest || (!may_be_signed && H5Tget_sign(type) != H5T_SGN_NONE))
    fail(path, widest < 8
                   ? "must hold unsigned whole numbers of " + std::to_string(8 * widest) + " bits"
                   : "must hold whole numbers of at most 64 bits");
  const H5Handle space = {H5Dget_space(column.dataset), H5Sclose};
  if (H5Sget_simple_extent_ndims(space) != 1) fail(path, "must have one dimension");
  take_length(column);
  return column;
}

void EventH5Reader::State::take_length(const Column& column) {
  const H5Handle space = {H5Dget_space(column.dataset), H5Sclose};
  const std::array<hsize_t, 2> none{};
  std::array<hsize_t, 2> size = none;
  if (H5Sget_simple_extent_ndims(space) > 2 ||
      H5Sget_simple_extent_dims(space, size.data(), nullptr) < 1)
    fail(column.path, "must have one dimension");
  if (!is_opened) count = size[0];
  is_opened = true;
  // Times differ, so that no filter packs them tighter than others; the other columns are as long.
  if (H5Tget_size(H5Handle{H5Dget_type(column.dataset), H5Tclose}) >= sizeof(std::int64_t))
    check_h5_size(column.dataset, name + ":" + column.path);
  if (size[0] != count)
    fail(column.path, "has " + std::to_string(size[0]) + " entries, " + x.path + " has " +
                          std::to_string(count));
}

std::string EventH5Reader::State::read_text(hid_t object, const char* name_of_attribute) const {
  const H5Handle attribute = {H5Aopen(object, name_of_attribute, H5P_DEFAULT), H5Aclose};
  const std::optional<std::string> text = read_h5_text_attribute(attribute);
  if (!text) fail(place, fmt::format("attribute \"{}\" must be a single text", name_of_attribute));
  return *text;
}

void EventH5Reader::State::read_unit() {
  if (H5Aexists(t.dataset, "unit") <= 0) return;  // DSEC: microseconds
  const std::string text = read_text(t.dataset, "unit");
  if (text != "us" && text != "ns")
    fail(t.path, "attribute \"unit\" is '" + text + "'; it must be \"us\" or \"ns\"");
  unit = text == "us" ? 1000 : 1;
}

/// Of attributes "width" and "height" of the group, of Prophesee's attribute "geometry", or of
/// M3ED's calibration beside the events.
void EventH5Reader::State::read_sensor() {
  if (place == "/events" && is_group(file, place)) {
    sensor = {read_size("width"), read_size("height")};
  } else if (H5Aexists(file, "geometry") > 0) {
    const std::string text = read_text(file, "geometry");
    if (std::sscanf(text.c_str(), "%dx%d", &sensor.width, &sensor.height) != 2 ||
        sensor.width < 1 || sensor.height < 1 || sensor.width > 65536 || sensor.height > 65536)
      fail("/", "attribute \"geometry\" is '" + text + "'; it must be like 1280x720");
  } else if (const std::string path = place + "/calib/resolution"; has_h5_link(file, path)) {
    const Column resolution{open_dataset(path), path, "", std::nullopt};
    std::vector<std::int32_t> sides;
    const H5Handle space = {H5Dget_space(resolution.dataset), H5Sclose};
    if (H5Sget_simple_extent_ndims(space) != 1 || H5Sget_simple_extent_npoints(space) != 2)
      fail(path, "must hold width and height");
    read(resolution, H5T_NATIVE_INT32, {0, 2}, sides);
    if (sides[0] < 1 || sides[1] < 1 || sides[0] > 65536 || sides[1] > 65536)
      fail(path, "must hold numbers of pixels");
    sensor = {sides[0], sides[1]};
  }
}

/// [px]; 0 where it is not stated.
int EventH5Reader::State::read_size(const char* side) const {
  const H5Handle group = {H5Gopen2(file, "events", H5P_DEFAULT), H5Gclose};
  if (H5Aexists(group, side) <= 0) return 0;
  const H5Handle attribute = {H5Aopen(group, side, H5P_DEFAULT), H5Aclose};
  const H5Handle space = {H5Aget_space(attribute), H5Sclose};
  int pixels = 0;
  if (H5Sget_simple_extent_npoints(space) != 1 || H5Aread(attribute, H5T_NATIVE_INT, &pixels) < 0 ||
      pixels < 1 || pixels > 65536)
    fail("/events", fmt::format("attribute \"{}\" must be a number of pixels", side));
  return pixels;
}

void EventH5Reader::State::read_offset() {
  if (H5Lexists(file, "t_offset", H5P_DEFAULT) <= 0) return;
  const H5Handle dataset = open_dataset("/t_offset");
  const H5Handle space = {H5Dget_space(dataset), H5Sclose};
  if (H5Sget_simple_extent_npoints(space) != 1) fail("/t_offset", "must hold one number");
  if (H5Dread(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &offset) < 0)
    fail("/t_offset", "cannot be read (HDF5: " + h5_reason() + ")");
}

void EventH5Reader::State::read_index() {
  if (H5Lexists(file, "ms_to_idx", H5P_DEFAULT) <= 0) return;
  H5Handle dataset = open_dataset("/ms_to_idx");
  const H5Handle space = {H5Dget_space(dataset), H5Sclose};
  if (H5Sget_simple_extent_ndims(space) != 1) fail("/ms_to_idx", "must have one dimension");
  check_h5_size(dataset, name + ":/ms_to_idx");
  std::vector<std::uint64_t> index;
  const auto length = static_cast<std::uint64_t>(H5Sget_simple_extent_npoints(space));
  read({std::move(dataset), "/ms_to_idx", "", std::nullopt}, H5T_NATIVE_UINT64, {0, length}, index);
  for (std::size_t i = 0; i < index.size(); ++i)
    if (index[i] > count || (i > 0 && index[i] < index[i - 1]))
      fail_at("/ms_to_idx", i, "indices must not decrease nor exceed the number of events");
  ms_to_idx = std::move(index);
}

template <class T>
void EventH5Reader::State::read(const Column& column, hid_t type, Range range,
                                std::vector<T>& values) const {
  const hsize_t length = range.end - range.begin;
  const std::array<hsize_t, 2> start{range.begin, column.matrix_column.value_or(0)};
  const std::array<hsize_t, 2> size{length, 1};
  values.resize(length);
  if (length == 0) return;
  const H5Handle space = {H5Dget_space(column.dataset), H5Sclose};
  const H5Handle memory = {H5Screate_simple(1, &length, nullptr), H5Sclose};
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr);
  H5Handle field;
  if (!column.field.empty()) {
    field = {H5Tcreate(H5T_COMPOUND, sizeof(T)), H5Tclose};
    H5Tinsert(field, column.field.c_str(), 0, type);
    type = field;
  }
  if (H5Dread(column.dataset, type, memory, space, H5P_DEFAULT, values.data()) >= 0) return;
  const std::string reason = h5_reason();  // before the hint, which asks HDF5 other things
  fail_at(column.path.c_str(), range.begin,
          "cannot be read: damaged, or its compression filter is not installed (HDF5: " + reason +
              ")" + h5_filter_hint(column.dataset));
}

/// Seconds as whole microseconds, which is what cameras measure.
std::vector<std::int64_t> EventH5Reader::State::read_seconds(Range range) const {
  std::vector<double> seconds;
  read(t, H5T_NATIVE_DOUBLE, range, seconds);
  std::vector<std::int64_t> times(seconds.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!(std::abs(seconds[i]) < 9e9))
      fail_at(t.path.c_str(), range.begin + i, fmt::format("{} s is no time", seconds[i]));
    times[i] = std::llround(1e6 * seconds[i]);
  }
  return times;
}

std::vector<std::int64_t> EventH5Reader::State::read_times(Range range) const {
  std::vector<std::int64_t> times;
  if (times_in_seconds)
    times = read_seconds(range);
  else
    read(t, H5T_NATIVE_INT64, range, times);
  check_order(times, range.begin);
  return times;
}

void EventH5Reader::State::check_order(std::span<const std::int64_t> times,
                                       std::uint64_t first) const {
  for (std::size_t i = 1; i < times.size(); ++i)
    if (times[i] < times[i - 1])
      fail_at(
          t.path.c_str(), first + i,
          "time goes back: " + std::to_string(times[i]) + " after " + std::to_string(times[i - 1]));
}

/// A range of indices that holds all events with start_tick <= t < end_tick, by the index.
Range EventH5Reader::State::bracket(std::int64_t start_tick, std::int64_t end_tick) const {
  Range range{0, count};
  if (!ms_to_idx || ms_to_idx->empty()) return range;
  const std::int64_t ticks_per_ms = 1'000'000 / unit;
  const auto length = static_cast<std::int64_t>(ms_to_idx->size());
  const std::int64_t first_ms = std::clamp<std::int64_t>(start_tick / ticks_per_ms, 0, length - 1);
  if (start_tick > 0) range.begin = (*ms_to_idx)[static_cast<std::size_t>(first_ms)];
  if (end_tick < (length - 1) * ticks_per_ms) {
    const std::int64_t last_ms = std::max<std::int64_t>(end_tick, 0) / ticks_per_ms + 1;
    range.end = (*ms_to_idx)[static_cast<std::size_t>(last_ms)];
  }
  // The neighbours outside prove that the index tells the truth.
  const auto tick_at = [&](std::uint64_t i) { return read_times({i, i + 1}).front(); };
  if ((range.begin > 0 && tick_at(range.begin - 1) >= start_tick) ||
      (range.end < count && tick_at(range.end) < end_tick))
    fail("/ms_to_idx", "contradicts the times in /events/t");
  return range;
}

/// The events of the window, by bisection over blocks within the bracket.
Range EventH5Reader::State::find(TimeWindow window) const {
  const std::int64_t start = saturating_subtract(ceil_ticks(window.start_ns, unit), offset);
  const std::int64_t end = saturating_subtract(ceil_ticks(window.end_ns, unit), offset);
  if (start >= end || count == 0) return {};
  const Range range = bracket(start, end);
  const auto first_at_or_after = [&](std::int64_t tick) {
    std::uint64_t low = range.begin;
    std::uint64_t high = range.end;
    // About a chunk, which has to be unpacked anyway.
    while (high - low > kH5Grain) {
      const std::uint64_t middle = low + (high - low) / 2;
      if (read_times({middle, middle + 1}).front() < tick)
        low = middle + 1;
      else
        high = middle;
    }
    return low + count_before(read_times({low, high}), tick, std::identity{});
  };
  constexpr std::int64_t kAlways = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  return {window.start_ns == kAlways ? range.begin : first_at_or_after(start),
          window.end_ns == kNever ? range.end : first_at_or_after(end)};
}

TimeNs EventH5Reader::State::time_ns(std::int64_t tick, std::uint64_t index) const {
  TimeNs t_ns = 0;
  if (__builtin_add_overflow(tick, offset, &t_ns) || __builtin_mul_overflow(t_ns, unit, &t_ns))
    fail_at(t.path.c_str(), index, "the time is too large: " + std::to_string(tick));
  return t_ns;
}

/// By the library where the chunks are stored in a way that only it knows, or are damaged, which it
/// reports.
void EventH5Reader::State::read_columns(Range range, EventColumns& columns) const {
  if (packed && packed->read(range.begin, range.end, columns)) return;
  const H5Lock lock;
  read(x, H5T_NATIVE_UINT16, range, columns.x);
  read(y, H5T_NATIVE_UINT16, range, columns.y);
  read(p, H5T_NATIVE_INT16, range, columns.p);
  columns.t = read_times(range);
}

/// False where one of them cannot be an event, or comes before its predecessor.
bool EventH5Reader::State::make_events(const EventColumns& columns, SensorSize size,
                                       std::span<Event> events) const {
  const int width = size.width > 0 ? size.width : 65536;
  const int height = size.height > 0 ? size.height : 65536;
  const int lowest = place == "/events" ? 0 : -1;
  // Between these no time overflows.
  const std::int64_t highest =
      saturating_subtract(std::numeric_limits<TimeNs>::max() / unit, offset);
  const std::int64_t least = saturating_subtract(std::numeric_limits<TimeNs>::min() / unit, offset);
  std::atomic<bool> is_sound = true;
  const auto make = [&](std::size_t begin, std::size_t end) {
    bool is_fine = true;
    std::int64_t before = columns.t[begin > 0 ? begin - 1 : 0];
    for (std::size_t i = begin; i < end; ++i) {
      const std::int64_t tick = columns.t[i];
      const int p_of = columns.p[i];
      // Without a branch, which would keep the loop from several events at a time.
      is_fine &= static_cast<bool>(
          static_cast<int>(columns.x[i] < width) & static_cast<int>(columns.y[i] < height) &
          static_cast<int>(p_of <= 1) & static_cast<int>(p_of >= lowest) &
          static_cast<int>(tick >= std::max(least, before)) & static_cast<int>(tick <= highest));
      before = tick;
      // Unsigned, because a time that is refused may overflow.
      const std::uint64_t t_ns =
          (static_cast<std::uint64_t>(tick) + static_cast<std::uint64_t>(offset)) *
          static_cast<std::uint64_t>(unit);
      events[i] = {static_cast<TimeNs>(t_ns), columns.x[i], columns.y[i],
                   static_cast<std::int8_t>(p_of == 1 ? 1 : -1)};
    }
    if (!is_fine) is_sound = false;
  };
  parallel_for_ranges(events.size(), kH5Grain, make);
  return is_sound;
}

/// Throws for the first thing that is wrong.
void EventH5Reader::State::report(const EventColumns& columns, std::uint64_t first, SensorSize size,
                                  TimeNs last_ns) const {
  const auto& [xs, ys, ps, ts] = columns;
  check_order(ts, first);
  const int width = size.width > 0 ? size.width : 65536;
  const int height = size.height > 0 ? size.height : 65536;
  const int lowest = place == "/events" ? 0 : -1;
  for (std::size_t i = 0; i < ts.size(); ++i) {
    const TimeNs t_ns = time_ns(ts[i], first + i);
    if (t_ns < last_ns) fail_at(t.path.c_str(), first + i, "time goes back");
    if (xs[i] >= width || ys[i] >= height)
      fail_at((xs[i] >= width ? x : y).path.c_str(), first + i,
              "pixel (" + std::to_string(xs[i]) + ", " + std::to_string(ys[i]) +
                  ") lies outside the sensor of " + std::to_string(width) + " x " +
                  std::to_string(height) + " px");
    if (ps[i] > 1 || ps[i] < lowest)
      fail_at(p.path.c_str(), first + i,
              "polarity " + std::to_string(ps[i]) +
                  (lowest == 0 ? " must be 0 or 1" : " must be 1, 0 or -1"));
  }
  fail_at(t.path.c_str(), first, "a time is too large");
}

void EventH5Reader::State::append_block(Range range, SensorSize size, Events& events) const {
  EventColumns columns;
  read_columns(range, columns);
  const TimeNs last_ns = events.empty() ? std::numeric_limits<TimeNs>::min() : events.back().t_ns;
  const std::size_t before = events.size();
  events.resize(before + columns.t.size());
  const std::span<Event> block = std::span(events).subspan(before);
  if (make_events(columns, size, block) && (block.empty() || block.front().t_ns >= last_ns)) return;
  events.resize(before);
  report(columns, range.begin, size, last_ns);
}

EventH5Reader::EventH5Reader(const std::filesystem::path& file)
    : state_(std::make_unique<State>(file)) {}

EventH5Reader::~EventH5Reader() = default;
EventH5Reader::EventH5Reader(EventH5Reader&&) noexcept = default;
EventH5Reader& EventH5Reader::operator=(EventH5Reader&&) noexcept = default;

EventFileInfo EventH5Reader::info() const {
  const H5Lock lock;
  EventFileInfo info;
  info.count = state_->count;
  info.unit = state_->unit == 1 ? TimestampUnit::kNanoseconds : TimestampUnit::kMicroseconds;
  info.sensor = state_->sensor;
  if (info.count == 0) return info;
  const auto time_at = [&](std::uint64_t i) {
    return state_->time_ns(state_->read_times({i, i + 1}).front(), i);
  };
  info.first_ns = time_at(0);
  info.last_ns = time_at(info.count - 1);
  return info;
}

std::uint64_t EventH5Reader::block_events() const {
  // The library unpacks chunks of any length, and keeps few.
  if (!state_->packed) return kH5Block;
  constexpr std::uint64_t kLeast = std::uint64_t{1} << 18U;  // work for several threads
  const std::uint64_t chunk = state_->packed->longest_chunk();
  return (kLeast + chunk - 1) / chunk * chunk;
}

std::pair<std::uint64_t, std::uint64_t> EventH5Reader::range(TimeWindow window) const {
  const H5Lock lock;
  const Range range = state_->find(window);
  return {range.begin, range.end};
}

void EventH5Reader::append(std::uint64_t begin, std::uint64_t end, SensorSize size,
                           Events& events) const {
  // Blocks end at multiples of kH5Block, so that no chunk is unpacked twice.
  while (begin < end) {
    const std::uint64_t block_end = std::min(end, (begin / kH5Block + 1) * kH5Block);
    state_->append_block({begin, block_end}, size, events);
    begin = block_end;
  }
}

Events EventH5Reader::read(SensorSize size, TimeWindow window) const {
  const auto [begin, end] = range(window);
  Events events;
  events.reserve(end - begin);
  append(begin, end, size, events);
  sort_ties(events);
  return events;
}

}  // namespace saccade
