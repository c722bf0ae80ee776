#include "core/io/events/events_h5_layout.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <utility>

#include "core/error.h"
#include "core/io/tables/h5_file.h"

namespace saccade {
namespace {

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

EventH5Layout::EventH5Layout(const std::filesystem::path& path)
    : name(event_file_place(path).file.string()) {
  const H5Lock lock;
  file = open_h5_file(name);
  open_columns(find_events(event_file_place(path).member));
  read_sensor();
  if (place != "/events" && place != "/") return;
  read_offset();
  read_index();
}

void EventH5Layout::fail(const std::string& path, const std::string& problem) const {
  throw InputError(name + ":" + path, problem);
}

void EventH5Layout::fail_at(const std::string& path, std::uint64_t index,
                            const std::string& problem) const {
  fail(path + "[" + std::to_string(index) + "]", problem);
}

/// The path of a group of columns or of a dataset.
std::string EventH5Layout::find_events(const std::string& member) const {
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

void EventH5Layout::open_columns(const std::string& events) {
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
void EventH5Layout::open_table(const std::string& path) {
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
void EventH5Layout::open_matrix(const std::string& path) {
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

H5Handle EventH5Layout::open_dataset(const std::string& path) const {
  if (!has_h5_link(file, path)) fail(path, "the dataset is missing");
  H5Handle dataset = {H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose};
  if (!dataset.valid()) fail(path, "is no dataset that can be opened");
  const H5Handle type = {H5Dget_type(dataset), H5Tclose};
  if (H5Tget_class(type) != H5T_INTEGER) fail(path, "must hold whole numbers");
  return dataset;
}

/// Opens a column; its integers have at most `widest` bytes.
EventH5Layout::Column EventH5Layout::column(const std::string& path, std::size_t widest,
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

void EventH5Layout::take_length(const Column& column) {
  const H5Handle space = {H5Dget_space(column.dataset), H5Sclose};
  const std::array<hsize_t, 2> none{};
  std::array<hsize_t, 2> size = none;
  if (H5Sget_simple_extent_ndims(space) > 2 ||
      H5Sget_simple_extent_dims(space, size.data(), nullptr) < 1)
    fail(column.path, "must have one dimension");
  if (!has_length_) count = size[0];
  has_length_ = true;
  // Times differ, so that no filter packs them tighter than others; the other columns are as long.
  if (H5Tget_size(H5Handle{H5Dget_type(column.dataset), H5Tclose}) >= sizeof(std::int64_t))
    check_h5_size(column.dataset, name + ":" + column.path);
  if (size[0] != count)
    fail(column.path, "has " + std::to_string(size[0]) + " entries, " + x.path + " has " +
                          std::to_string(count));
}

std::string EventH5Layout::read_text(hid_t object, const char* name_of_attribute) const {
  const H5Handle attribute = {H5Aopen(object, name_of_attribute, H5P_DEFAULT), H5Aclose};
  const std::optional<std::string> text = read_h5_text_attribute(attribute);
  if (!text) fail(place, fmt::format("attribute \"{}\" must be a single text", name_of_attribute));
  return *text;
}

void EventH5Layout::read_unit() {
  if (H5Aexists(t.dataset, "unit") <= 0) return;  // DSEC: microseconds
  const std::string text = read_text(t.dataset, "unit");
  if (text != "us" && text != "ns")
    fail(t.path, "attribute \"unit\" is '" + text + "'; it must be \"us\" or \"ns\"");
  unit = text == "us" ? 1000 : 1;
}

/// Of attributes "width" and "height" of the group, of Prophesee's attribute "geometry", or of
/// M3ED's calibration beside the events.
void EventH5Layout::read_sensor() {
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
int EventH5Layout::read_size(const char* side) const {
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

void EventH5Layout::read_offset() {
  if (H5Lexists(file, "t_offset", H5P_DEFAULT) <= 0) return;
  const H5Handle dataset = open_dataset("/t_offset");
  const H5Handle space = {H5Dget_space(dataset), H5Sclose};
  if (H5Sget_simple_extent_npoints(space) != 1) fail("/t_offset", "must hold one number");
  if (H5Dread(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &offset) < 0)
    fail("/t_offset", "cannot be read (HDF5: " + h5_reason() + ")");
}

void EventH5Layout::read_index() {
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

void EventH5Layout::read(const Column& column, hid_t type, std::size_t size, EventRange range,
                         void* values) const {
  const hsize_t length = range.end - range.begin;
  const std::array<hsize_t, 2> start{range.begin, column.matrix_column.value_or(0)};
  const std::array<hsize_t, 2> extent{length, 1};
  const H5Handle space = {H5Dget_space(column.dataset), H5Sclose};
  const H5Handle memory = {H5Screate_simple(1, &length, nullptr), H5Sclose};
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr);
  H5Handle field;
  if (!column.field.empty()) {
    field = {H5Tcreate(H5T_COMPOUND, size), H5Tclose};
    H5Tinsert(field, column.field.c_str(), 0, type);
    type = field;
  }
  if (H5Dread(column.dataset, type, memory, space, H5P_DEFAULT, values) >= 0) return;
  const std::string reason = h5_reason();  // before the hint, which asks HDF5 other things
  fail_at(column.path, range.begin,
          "cannot be read: damaged, or its compression filter is not installed (HDF5: " + reason +
              ")" + h5_filter_hint(column.dataset));
}

}  // namespace saccade
