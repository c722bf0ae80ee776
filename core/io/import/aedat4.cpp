#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <numbers>

#include "core/error.h"
#include "core/io/events/aedat/aedat4.h"
#include "core/io/events/aedat/aedat4_file.h"
#include "core/io/events/event_formats.h"
#include "core/io/images/picture_bytes.h"
#include "core/io/images/rgb_grey.h"
#include "core/io/import/camera_files.h"
#include "core/io/import/layouts.h"
#include "core/process/progress.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr TimeNs kNsPerUs = 1000;

/// The first stream of a type; nullptr where there is none.
const Aedat4Stream* find_stream(const Aedat4File& file, std::string_view type) {
  const auto found = std::find_if(file.streams().begin(), file.streams().end(),
                                  [&](const Aedat4Stream& s) { return s.type == type; });
  return found == file.streams().end() ? nullptr : &*found;
}

[[noreturn]] void fail_in(const Aedat4File& file, const Aedat4Packet& packet,
                          const std::string& problem) {
  file.bytes().fail(packet.offset, "in the packet that begins here: " + problem);
}

/// Calls `take` with every packet of a type, as the table of that type.
template <class Take>
void for_each_packet(Aedat4File& file, std::string_view type, Take take) {
  const Aedat4Stream* stream = find_stream(file, type);
  if (stream == nullptr) return;
  file.rewind();
  while (const auto packet = file.next(stream->id)) {
    try {
      take(*packet, FlatTable::root(packet->buffer, type));
    } catch (const FlatBufferError& error) {
      fail_in(file, *packet, error.problem);
    }
  }
}

TimeNs time_in(const Aedat4File& file, const Aedat4Packet& packet, const FlatTable& table,
               unsigned field) {
  const auto t_us = table.number<std::int64_t>(field, 0);
  if (std::abs(t_us) > std::numeric_limits<TimeNs>::max() / kNsPerUs)
    fail_in(file, packet, fmt::format("the time {} us is too large", t_us));
  return t_us * kNsPerUs;
}

// IMU: time [us], temperature, accelerometer [g], gyroscope [deg/s], magnetometer.
std::vector<ImuSample> read_imu_packets(Aedat4File& file) {
  constexpr double kStandardGravity = 9.80665;
  constexpr double kRadPerDeg = std::numbers::pi / 180;
  std::vector<ImuSample> samples;
  for_each_packet(file, "IMUS", [&](const Aedat4Packet& packet, const FlatTable& root) {
    for (const FlatTable& table : root.tables(0)) {
      ImuSample sample;
      sample.t_ns = time_in(file, packet, table, 0);
      for (unsigned i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        sample.specific_force[axis] =
            kStandardGravity * static_cast<double>(table.number<float>(2 + i, 0));
        sample.angular_velocity[axis] =
            kRadPerDeg * static_cast<double>(table.number<float>(5 + i, 0));
      }
      if (!sample.specific_force.allFinite() || !sample.angular_velocity.allFinite())
        fail_in(file, packet, "an inertial sample is not finite");
      // A sample that is delivered twice, or late, counts once.
      if (samples.empty() || sample.t_ns > samples.back().t_ns) samples.push_back(sample);
    }
  });
  return samples;
}

std::vector<Trigger> read_trigger_packets(Aedat4File& file) {
  std::vector<Trigger> triggers;
  for_each_packet(file, "TRIG", [&](const Aedat4Packet& packet, const FlatTable& root) {
    for (const FlatTable& table : root.tables(0))
      triggers.push_back(
          {time_in(file, packet, table, 0), static_cast<int>(table.number<std::int8_t>(1, 0))});
  });
  return triggers;
}

/// The codes of a frame's table as grey ones.
ImageU8 decode_frame(const Aedat4File& file, const Aedat4Packet& packet, const FlatTable& table) {
  constexpr unsigned kFormat = 5, kSizeX = 6, kSizeY = 7, kPixels = 10;
  const auto format = table.number<std::int8_t>(kFormat, 0);
  const int width = table.number<std::int16_t>(kSizeX, 0);
  const int height = table.number<std::int16_t>(kSizeY, 0);
  constexpr std::int8_t kGrey = 0, kBgr = 16, kBgra = 24;
  if (format != kGrey && format != kBgr && format != kBgra)
    fail_in(file, packet,
            fmt::format("the frame's format has the unknown number {}; it must be 0 "
                        "(grey), 16 (BGR) or 24 (BGRA)",
                        format));
  const int channels = format == kGrey ? 1 : format == kBgr ? 3 : 4;
  const std::span<const std::byte> codes = table.structs(kPixels, 1);
  if (width < 1 || height < 1 ||
      codes.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                          static_cast<std::size_t>(channels))
    fail_in(file, packet,
            fmt::format("{} bytes are no frame of {} x {} px with {} channels", codes.size(), width,
                        height, channels));
  if (channels == 1) {
    ImageU8 grey(width, height);
    std::memcpy(grey.data(), codes.data(), codes.size());
    return grey;
  }
  ImageRgb8 colours(width, height);
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const std::byte* code = codes.data() + i * static_cast<std::size_t>(channels);
    for (std::size_t c = 0; c < 3; ++c)
      colours.data()[i][c] = std::to_integer<std::uint8_t>(code[2 - c]);
  }
  return grey_from(colours);
}

/// Where frames lie in the file, so that one is in memory at a time.
struct FrameIndex {
  explicit FrameIndex(const fs::path& name) : file(name) {}
  Aedat4File file;
  int stream = -1;
  std::vector<std::uint64_t> offsets;
};

void index_frames(const std::shared_ptr<FrameIndex>& index, SensorSize sensor,
                  PublicSequence& sequence) {
  const Aedat4Stream* stream = find_stream(index->file, "FRME");
  if (stream == nullptr) return;
  index->stream = stream->id;
  for_each_packet(index->file, "FRME", [&](const Aedat4Packet& packet, const FlatTable& table) {
    const double t_s = seconds_from_ns(time_in(index->file, packet, table, 0));
    const ImageU8 frame = decode_frame(index->file, packet, table);
    if (frame.width() != sensor.width || frame.height() != sensor.height)
      fail_in(index->file, packet,
              fmt::format("the frame is {} x {} px, the sensor {} x {} px", frame.width(),
                          frame.height(), sensor.width, sensor.height));
    if (!sequence.frame_times_s.empty() && !(t_s > sequence.frame_times_s.back()))
      fail_in(index->file, packet, "the time of the frame goes back");
    sequence.frame_times_s.push_back(t_s);
    index->offsets.push_back(packet.offset);
  });
  sequence.load_frame = [index](std::size_t i) {
    index->file.seek(index->offsets[i]);
    const auto packet = index->file.next(index->stream);
    return decode_frame(index->file, *packet, FlatTable::root(packet->buffer, "FRME"));
  };
}

ChainCamera assumed_camera(const fs::path& file, SensorSize sensor) {
  show_notice(
      fmt::format("{} holds no calibration: a focal length of {} px without distortion is assumed, "
                  "with which poses and depths are wrong; name one with --calibration, or put a "
                  "calib.txt or camera.yaml beside the file",
                  file.string(), sensor.width));
  const double focal = sensor.width;
  return {.camera = {sensor.width,
                     sensor.height,
                     focal,
                     focal,
                     (sensor.width - 1) / 2.0,
                     (sensor.height - 1) / 2.0,
                     {}}};
}

}  // namespace

bool is_aedat4(const fs::path& file) {
  return fs::is_regular_file(file) && recognise_event_format(file).open == open_aedat4;
}

PublicSequence open_aedat4_sequence(const fs::path& file, const fs::path& calibration) {
  const auto index = std::make_shared<FrameIndex>(file);
  const SensorSize sensor = stated_sensor(file);
  PublicSequence sequence;
  sequence.layout = "AEDAT4";
  sequence.events = file;
  const auto found = find_calibration(calibration, file.parent_path(), sensor);
  if (!found && sensor.width == 0)
    throw InputError(file.string(),
                     "states neither a calibration nor the size of the sensor; name a calibration "
                     "with --calibration");
  sequence.camera = found ? *found : assumed_camera(file, sensor);
  sequence.imu = read_imu_packets(index->file);
  for (ImuSample& sample : sequence.imu)
    sample.t_ns -= ns_from_seconds(sequence.camera.timeshift_s);
  sequence.triggers = read_trigger_packets(index->file);
  index_frames(index, {sequence.camera.camera.width, sequence.camera.camera.height}, sequence);
  return sequence;
}

}  // namespace saccade
