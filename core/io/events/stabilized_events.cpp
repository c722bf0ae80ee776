#include "core/io/events/stabilized_events.h"

#include <array>

#include "core/io/tables/csv_file.h"
#include "core/io/tables/csv_reader.h"

namespace saccade {
namespace {

constexpr const char* kPlacesGroup = "places";

std::array<H5Source, 4> h5_columns_of(const StabilizedCoordinates& places) {
  return {h5_source("x", places.x), h5_source("y", places.y),
          h5_source("source_x", places.source_x), h5_source("source_y", places.source_y)};
}

}  // namespace

StabilizedCoordinatesWriter::StabilizedCoordinatesWriter(const std::filesystem::path& file)
    : table_(file, kPlacesGroup, h5_columns_of(StabilizedCoordinates())) {}

void StabilizedCoordinatesWriter::append(const StabilizedCoordinates& places) {
  table_.append(h5_columns_of(places));
}

StabilizedCoordinates read_stabilized_coordinates(const std::filesystem::path& file,
                                                  std::uint64_t count) {
  StabilizedCoordinates places;
  places.x.resize(count);
  places.y.resize(count);
  places.source_x.resize(count);
  places.source_y.resize(count);
  const std::array columns{h5_target("x", places.x), h5_target("y", places.y),
                           h5_target("source_x", places.source_x),
                           h5_target("source_y", places.source_y)};
  read_h5_table(file, kPlacesGroup, count, 0, columns);
  return places;
}

std::vector<StabilizedWindow> read_stabilized_windows(const std::filesystem::path& file) {
  const CsvColumns table(file);
  std::array<std::size_t, 7> columns{};
  std::size_t c = 0;
  for (const char* name : {"start_s", "end_s", "at_s", "qx", "qy", "qz", "qw"})
    columns[c++] = table.require(name);
  std::vector<StabilizedWindow> windows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto at = [&](std::size_t column) { return table.number(row, columns[column]); };
    const Eigen::Quaterniond rotation(at(6), at(3), at(4), at(5));
    windows.push_back({at(0), at(1), at(2), rotation.normalized()});
  }
  return windows;
}

void write_stabilized_windows(const std::filesystem::path& file,
                              std::span<const StabilizedWindow> windows) {
  CsvTable table({"start_s", "end_s", "at_s", "qx", "qy", "qz", "qw"});
  for (const StabilizedWindow& window : windows) {
    const Eigen::Quaterniond& q = window.steady_from_camera;
    table.add({window.start_s, window.end_s, window.at_s, q.x(), q.y(), q.z(), q.w()});
  }
  table.save(file);
}

}  // namespace saccade
