// Event files of every format, and the labels beside them.

#include "tests/fuzz/core/core_targets.h"

#include <hdf5.h>

#include <cstdint>
#include <limits>
#include <stdexcept>

#include "core/error.h"
#include "core/io/events/event_formats.h"
#include "core/io/events/labels_h5.h"
#include "core/io/files/zip_archive.h"
#include "core/io/tables/npy_header.h"
#include "tests/support/h5_content.h"
#include "tests/unit/core/io/events/random_events.h"
#include "tests/unit/core/io/ros/ros2_bytes.h"

namespace saccade::fuzz {
namespace {

namespace fs = std::filesystem;
using testing::H5Content;
using testing::kSensor;

constexpr std::size_t kEvents = 40;

void decode_events(const fs::path& folder, const std::string& name) {
  const fs::path file = folder / name;
  static_cast<void>(read_event_file_info(file));
  static_cast<void>(stated_sensor(file));
  static_cast<void>(read_events(file, {}, {1'000'000, 50'000'000}));
  EventStream stream(file, kSensor);
  TimeNs last_ns = std::numeric_limits<TimeNs>::min();
  while (true) {
    const std::span<const Event> events = stream.next();
    if (events.empty()) return;
    for (const Event& event : events) {
      if (event.t_ns < last_ns || event.x >= kSensor.width || event.y >= kSensor.height ||
          (event.polarity != 1 && event.polarity != -1))
        throw std::logic_error("an event out of order or of no pixel was let through");
      last_ns = event.t_ns;
    }
  }
}

Events some_events() {
  Events events = testing::random_events(kEvents, 0, 1'000'000);
  for (Event& event : events) event.t_ns -= event.t_ns % 1000;
  sort_ties(events);
  return events;
}

void write_by_ending(const fs::path& file) {
  const auto writer = make_event_writer(file, TimestampUnit::kMicroseconds, kSensor);
  writer->append(some_events());
  writer->close();
}

template <class T>
std::string little(std::initializer_list<T> numbers) {
  std::string bytes;
  for (const T number : numbers) bytes += testing::bytes_of(number);
  return bytes;
}

void write_raw(const fs::path& folder) {
  write_by_ending(folder / "evt3.raw");
  write_bytes(folder / "evt2.raw",
              "% evt 2.0\n% geometry 240x180\n% end\n" +
                  little<std::uint32_t>({0x80000000, 0x10000000 | 5U << 22U | 7U << 11U | 8U,
                                         0x80000001, 0x00000000 | 9U << 22U | 3U << 11U | 2U}));
  write_bytes(
      folder / "evt21.raw",
      "% evt 2.1\n% geometry 240x180\n% end\n" +
          little<std::uint64_t>({0x8000000000000000U,
                                 0x1000000000000000U | std::uint64_t{5} << 54U |
                                     std::uint64_t{32} << 43U | std::uint64_t{8} << 32U | 0x81U}));
  write_bytes(folder / "e.dat",
              "% Data file containing CD events.\n% Version 2\n% Width 240\n% "
              "Height 180\n\x0c\x08" +
                  little<std::uint32_t>({5, 7U << 14U | 8U | 1U << 28U, 9, 3U << 14U | 2U}));
}

void write_aedat(const fs::path& folder) {
  std::string text = "#!AER-DAT2.0\r\n# AEChip: eu.seebetter.ini.chips.davis.DAVIS240C\r\n";
  for (const std::uint32_t number : {7U << 22U | 3U << 12U | 0x800U, 5U, 9U << 22U, 8U})
    for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(number >> shift);
  write_bytes(folder / "e.aedat", text);
  write_by_ending(folder / "e.aedat4");
}

void write_numpy(const fs::path& folder) {
  const std::string header = npy_header_text("<i8", {3, 4});
  write_bytes(folder / "e.npy",
              header + little<std::int64_t>({5, 1, 2, 1, 6, 3, 4, 0, 7, 5, 6, 1}));
  write_by_ending(folder / "e.npz");
  write_bytes(folder / "events.txt", "0.000001000 1 2 1\n0.000002000 3 4 0\n");
  write_zip(folder / "e.zip", {{"events.txt", folder / "events.txt"}});
}

void write_ros(const fs::path& folder) {
  write_by_ending(folder / "e.bag");
  testing::write_rosbag2(
      folder / "e.db3", {{"/events", "event_camera_msgs/msg/EventPacket"}},
      {{1, testing::event_packet(1'000'000, 0, "evt3",
                                 little<std::uint16_t>({0x8000, 0x6000, 0x0005, 0x2807}))}});
  using namespace testing;
  write_bytes(
      folder / "e.mcap",
      kMcapHead +
          mcap_chunk("zstd",
                     mcap_channel(1, "/events", "event_camera_msgs/msg/EventPacket") +
                         mcap_message(1, event_packet(1'000'000, 0, "evt3",
                                                      little<std::uint16_t>(
                                                          {0x8000, 0x6000, 0x0005, 0x2807})))) +
          kMcapEnd);
}

/// The columns of the events in HDF5, where each layout has them.
struct H5Columns {
  std::vector<std::uint16_t> x, y;
  std::vector<std::uint8_t> p;
  std::vector<std::int64_t> t;
  std::vector<double> rows;  ///< x y t[s] p

  H5Columns() {
    for (const Event& event : some_events()) {
      x.push_back(event.x);
      y.push_back(event.y);
      p.push_back(event.polarity > 0 ? 1 : 0);
      t.push_back(event.t_ns / 1000);
      for (const double value :
           {static_cast<double>(event.x), static_cast<double>(event.y),
            1e-9 * static_cast<double>(event.t_ns), static_cast<double>(event.polarity)})
        rows.push_back(value);
    }
  }
};

/// Prophesee's rows, with the attribute that states the sensor.
void write_h5_table(const fs::path& file) {
  struct Row {
    std::uint16_t x, y;
    std::int64_t t;
    std::int16_t p;
  };
  const std::vector<Row> rows{{1, 2, 5, 1}, {3, 4, 6, 0}};
  H5Content content(file);
  content.column("/CD/indexes", std::vector<std::int64_t>{0});
  const hid_t type = H5Tcreate(H5T_COMPOUND, sizeof(Row));
  H5Tinsert(type, "x", HOFFSET(Row, x), H5T_NATIVE_UINT16);
  H5Tinsert(type, "y", HOFFSET(Row, y), H5T_NATIVE_UINT16);
  H5Tinsert(type, "t", HOFFSET(Row, t), H5T_NATIVE_INT64);
  H5Tinsert(type, "p", HOFFSET(Row, p), H5T_NATIVE_INT16);
  const hsize_t size = rows.size();
  const hid_t space = H5Screate_simple(1, &size, nullptr);
  const hid_t set =
      H5Dcreate2(content.id(), "/CD/events", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data());
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, 8);
  const hid_t one = H5Screate(H5S_SCALAR);
  const hid_t geometry = H5Acreate2(content.id(), "geometry", text, one, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(geometry, text, "240x180");
  H5Aclose(geometry);
  H5Sclose(one);
  H5Tclose(text);
  H5Dclose(set);
  H5Sclose(space);
  H5Tclose(type);
}

void write_h5(const fs::path& folder) {
  write_by_ending(folder / "dsec.h5");
  write_h5_table(folder / "prophesee.h5");
  const H5Columns columns;
  H5Content(folder / "m3ed.h5")
      .column("/prophesee/left/x", columns.x)
      .column("/prophesee/left/y", columns.y)
      .column("/prophesee/left/p", columns.p)
      .column("/prophesee/left/t", columns.t)
      .column("/prophesee/left/calib/resolution", std::vector<std::int64_t>{240, 180});
  H5Content(folder / "mvsec.h5").array<double>("/davis/left/events", {kEvents, 4}, columns.rows);
  H5Content(folder / "root.h5")
      .column("/x", columns.x)
      .column("/y", columns.y)
      .column("/p", columns.p)
      .column("/t", columns.t);
}

void write_text(const fs::path& folder) { write_by_ending(folder / "e.txt"); }

void write_labels(const fs::path& folder) {
  EventLabels labels;
  labels.resize(kEvents);
  LabelsH5Writer writer(folder / "labels.h5");
  writer.append(labels);
  writer.close();
}

void decode_labels(const fs::path& folder, const std::string& file) {
  static_cast<void>(read_labels_h5(folder / file, kEvents, 3, kEvents));
}

}  // namespace

std::vector<Target> event_targets() {
  return {
      {"events-text",
       {"e.txt"},
       decode_events,
       write_text,
       {"1e-9", "-1", "0.999999999", "9223372036.854775807", "65535", "# ", ",", "\r\n"}},
      {"events-h5",
       {"dsec.h5", "prophesee.h5", "m3ed.h5", "mvsec.h5", "root.h5"},
       decode_events,
       write_h5,
       {"\x89HDF\r\n\x1a\n", "TREE", "SNOD", "HEAP", "OHDR", "FRHP", "GCOL", "unit", "width",
        "ms_to_idx", "t_offset", "geometry"}},
      {"events-raw",
       {"evt2.raw", "evt21.raw", "evt3.raw", "e.dat"},
       decode_events,
       write_raw,
       {"% end\n", "% evt 3.0\n", "% geometry 240x180\n", "% format EVT21;height=180;width=240\n"}},
      {"events-aedat",
       {"e.aedat", "e.aedat4"},
       decode_events,
       write_aedat,
       {"#!AER-DAT4.0\r\n", "IOHE", "EVTS", "<node name=\"", "LZ4", "ZSTD"}},
      {"events-numpy",
       {"e.npy", "e.npz", "e.zip"},
       decode_events,
       write_numpy,
       {"\x93NUMPY", "'descr': '<i8'", "'shape': (3, 4), ", "fortran_order", "('t', '<u8')",
        "PK\x03\x04", "PK\x01\x02", "PK\x05\x06", "<f4", "<U2"}},
      {"events-ros",
       {"e.bag", "e.mcap", "e.db3"},
       decode_events,
       write_ros,
       {"#ROSBAG V2.0\n", "op=\x05", "compression=bz2", "compression=lz4", "\x89MCAP0\r\n", "zstd",
        "SQLite format 3", "dvs_msgs/EventArray", "event_camera_msgs/msg/EventPacket", "mono",
        "evt3"}},
      {"labels", {"labels.h5"}, decode_labels, write_labels, {"OHDR", "TREE", "HEAP"}},
  };
}

}  // namespace saccade::fuzz
