#include "core/io/events/event_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <vector>

#include "core/error.h"
#include "core/io/events/aedat/aedat2.h"
#include "core/io/events/aedat/aedat4.h"
#include "core/io/events/aedat/aedat4_file.h"
#include "core/io/events/events_h5.h"
#include "core/io/events/events_text.h"
#include "core/io/events/numpy/numpy_events.h"
#include "core/io/events/prophesee/evt2.h"
#include "core/io/events/prophesee/evt3.h"
#include "core/io/events/prophesee/raw_header.h"
#include "core/io/ros/bag_file.h"
#include "core/io/ros/event_messages.h"
#include "core/io/ros/mcap_file.h"
#include "core/io/ros/message_events.h"
#include "core/io/ros/rosbag2_file.h"

namespace saccade {
namespace {

constexpr std::size_t kHeadBytes = 4096;

constexpr std::string_view kH5Magic = "\x89HDF\r\n\x1a\n";
constexpr std::string_view kAedat2Magic = "#!AER-DAT2.0";

template <const std::string_view& kMagic>
bool begins_with(const EventFileHead& head) {
  return head.bytes.starts_with(kMagic);
}

/// Also an empty file, which holds no events; not AEDAT of versions that are not read.
bool is_text(const EventFileHead& head) {
  if (head.bytes.starts_with("#!AER-DAT")) return false;
  return std::none_of(head.bytes.begin(), head.bytes.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte == 0x7F || (byte < 0x20 && c != '\t' && c != '\n' && c != '\r');
  });
}

bool is_rosbag2(const EventFileHead& head) {
  return head.bytes.starts_with(kSqliteMagic) || is_rosbag2_folder(head.file);
}

template <RawEncoding kEncoding>
bool is_raw(const EventFileHead& head) {
  return parse_raw_header(head.bytes).encoding == kEncoding;
}

EventFileInfo read_h5_info(const std::filesystem::path& file) { return EventH5Reader(file).info(); }

std::unique_ptr<EventWriter> make_h5(const std::filesystem::path& file, TimestampUnit unit,
                                     SensorSize sensor) {
  return std::make_unique<EventH5Writer>(file, unit, sensor);
}

std::unique_ptr<EventWriter> make_text(const std::filesystem::path& file, TimestampUnit /*unit*/,
                                       SensorSize /*sensor*/) {
  return std::make_unique<EventTextWriter>(file);
}

constexpr EventFormat kEventFormats[] = {
    {.name = "HDF5",
     .ending = ".h5",
     .help = "HDF5 in the layout of DSEC.",
     .states_sensor = true,
     .finest = TimestampUnit::kNanoseconds,
     .recognises = begins_with<kH5Magic>,
     .open = open_events_h5,
     .read_info = read_h5_info,
     .make_writer = make_h5},
    {.name = "HDF5",
     .ending = ".hdf5",
     .help = "The same.",
     .states_sensor = true,
     .finest = TimestampUnit::kNanoseconds,
     .recognises = begins_with<kH5Magic>,
     .open = open_events_h5,
     .read_info = read_h5_info,
     .make_writer = make_h5},
    {.name = "EVT3",
     .ending = ".raw",
     .help = "Prophesee's RAW in the encoding EVT 3.0.",
     .states_sensor = true,
     .finest = TimestampUnit::kMicroseconds,
     .recognises = is_raw<RawEncoding::kEvt3>,
     .open = open_evt3,
     .read_info = nullptr,
     .make_writer = make_evt3_writer},
    {.name = "EVT2",
     .ending = ".raw",
     .help = "Prophesee's RAW in the encoding EVT 2.0.",
     .states_sensor = true,
     .finest = TimestampUnit::kMicroseconds,
     .recognises = is_raw<RawEncoding::kEvt2>,
     .open = open_evt2,
     .read_info = nullptr,
     .make_writer = make_evt2_writer},
    {.name = "EVT2.1",
     .ending = ".raw",
     .help = "Prophesee's RAW in the encoding EVT 2.1.",
     .states_sensor = true,
     .finest = TimestampUnit::kMicroseconds,
     .recognises = is_raw<RawEncoding::kEvt21>,
     .open = open_evt21,
     .read_info = nullptr,
     .make_writer = nullptr},
    {.name = "DAT",
     .ending = ".dat",
     .help = "Prophesee's DAT of events.",
     .states_sensor = true,
     .finest = TimestampUnit::kMicroseconds,
     .recognises = is_raw<RawEncoding::kDat>,
     .open = open_dat,
     .read_info = nullptr,
     .make_writer = nullptr},
    {.name = "AEDAT4",
     .ending = ".aedat4",
     .help = "AEDAT 4.0 of iniVation's DV.",
     .states_sensor = true,
     .finest = TimestampUnit::kMicroseconds,
     .recognises = begins_with<kAedat4Magic>,
     .open = open_aedat4,
     .read_info = nullptr,
     .make_writer = make_aedat4_writer},
    {.name = "AEDAT2",
     .ending = ".aedat",
     .help = "AEDAT 2.0 of jAER, of a DAVIS.",
     .states_sensor = true,
     .finest = TimestampUnit::kMicroseconds,
     .recognises = begins_with<kAedat2Magic>,
     .open = open_aedat2,
     .read_info = nullptr,
     .make_writer = nullptr},
    {.name = "NumPy archive",
     .ending = ".npz",
     .help = "NumPy arrays t, x, y and p.",
     .states_sensor = true,
     .finest = TimestampUnit::kNanoseconds,
     .recognises = is_npz,
     .open = open_numpy,
     .read_info = nullptr,
     .make_writer = make_npz_writer},
    {.name = "NumPy array",
     .ending = ".npy",
     .help = "One NumPy array with fields or columns t, x, y and p.",
     .states_sensor = false,
     .finest = TimestampUnit::kNanoseconds,
     .recognises = is_npy,
     .open = open_numpy,
     .read_info = nullptr,
     .make_writer = nullptr},
    {.name = "zipped text",
     .ending = ".zip",
     .help = "A zip archive with events.txt, as of the Event Camera Dataset.",
     .states_sensor = false,
     .finest = TimestampUnit::kNanoseconds,
     .recognises = is_events_zip,
     .open = open_events_zip,
     .read_info = nullptr,
     .make_writer = nullptr},
    {.name = "ROS bag",
     .ending = ".bag",
     .help = "A bag of ROS 1 with messages dvs_msgs/EventArray or EventPacket.",
     .states_sensor = true,
     .finest = TimestampUnit::kNanoseconds,
     .recognises = begins_with<kBagMagic>,
     .open = open_message_events,
     .read_info = nullptr,
     .make_writer = make_message_event_writer},
    {.name = "MCAP",
     .ending = ".mcap",
     .help = "An MCAP of ROS 1 or 2 with messages EventPacket or EventArray.",
     .states_sensor = true,
     .finest = TimestampUnit::kNanoseconds,
     .recognises = begins_with<kMcapMagic>,
     .open = open_message_events,
     .read_info = nullptr,
     .make_writer = make_message_event_writer},
    {.name = "rosbag2",
     .ending = ".db3",
     .help = "A SQLite file of rosbag2, or its folder, with messages EventPacket or EventArray.",
     .states_sensor = true,
     .finest = TimestampUnit::kNanoseconds,
     .recognises = is_rosbag2,
     .open = open_message_events,
     .read_info = nullptr,
     .make_writer = nullptr},
    {.name = "text",
     .ending = ".txt",
     .help = "Text lines t x y p, t in seconds.",
     .states_sensor = false,
     .finest = TimestampUnit::kNanoseconds,
     .recognises = is_text,
     .open = open_events_text,
     .read_info = nullptr,
     .make_writer = make_text},
};

std::string read_head(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw InputError(file.string(), "no such file");
  if (std::filesystem::is_directory(file))
    throw InputError(file.string(), "is a folder, not a file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string(), "cannot be opened");
  std::string head(kHeadBytes, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head;
}

/// "89 48 44 46", for people who compare it with a format's description.
std::string hexadecimal(std::string_view bytes) {
  std::string text;
  for (const char c : bytes)
    text += fmt::format("{}{:02x}", text.empty() ? "" : " ", static_cast<unsigned char>(c));
  return text;
}

/// "HDF5, text", each once.
std::string format_names() {
  std::string names;
  std::string_view last;
  for (const EventFormat& format : kEventFormats) {
    if (format.name != last) names.append(names.empty() ? "" : ", ").append(format.name);
    last = format.name;
  }
  return names;
}

std::vector<std::string_view> endings(bool written) {
  std::vector<std::string_view> list;
  for (const EventFormat& format : kEventFormats)
    if ((!written || format.make_writer != nullptr) &&
        std::find(list.begin(), list.end(), format.ending) == list.end())
      list.push_back(format.ending);
  return list;
}

}  // namespace

std::span<const EventFormat> event_formats() { return kEventFormats; }

EventFilePlace event_file_place(const std::filesystem::path& path) {
  const std::string text = path.string();
  const std::size_t inside = text.find("!/");
  if (inside == std::string::npos || std::filesystem::exists(path)) return {path, ""};
  return {text.substr(0, inside), text.substr(inside + 1)};
}

const EventFormat& recognise_event_format(const std::filesystem::path& path) {
  const std::filesystem::path file = event_file_place(path).file;
  // What comes through a pipe cannot be looked at before it is read.
  if (std::filesystem::exists(file) && !std::filesystem::is_regular_file(file) &&
      !std::filesystem::is_directory(file))
    return *std::rbegin(kEventFormats);
  const std::string bytes = is_rosbag2_folder(file) ? "" : read_head(file);
  const EventFileHead head{file, bytes};
  for (const EventFormat& format : kEventFormats)
    if (format.recognises(head)) return format;
  constexpr std::size_t kShownBytes = 8;
  throw InputError(file.string(),
                   fmt::format("holds events in none of the formats that are read ({}), or is "
                               "damaged: it begins with the bytes {}",
                               format_names(), hexadecimal(head.bytes.substr(0, kShownBytes))));
}

const EventFormat* find_written_format(const std::filesystem::path& file, std::string_view name) {
  for (const EventFormat& format : kEventFormats)
    if (file.extension() == format.ending && format.make_writer != nullptr &&
        (name.empty() || name == format.name))
      return &format;
  return nullptr;
}

bool is_event_file_name(const std::filesystem::path& file) {
  return std::any_of(std::begin(kEventFormats), std::end(kEventFormats),
                     [&](const EventFormat& f) { return file.extension() == f.ending; });
}

std::string event_file_endings(bool written) {
  std::string list;
  for (const std::string_view ending : endings(written))
    list.append(list.empty() ? "" : ", ").append(ending);
  return list;
}

std::string event_file_names() {
  std::string names;
  for (const std::string_view ending : endings(false))
    names.append(names.empty() ? "" : ", ").append("events").append(ending);
  return names;
}

}  // namespace saccade
