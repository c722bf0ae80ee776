#include "core/io/events/prophesee/raw_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "core/io/events/prophesee/raw_reader.h"

namespace saccade {
namespace {

constexpr std::size_t kMostHeaderBytes = std::size_t{1} << 16U;
constexpr std::string_view kOriginKey = "time_origin_us";

/// "KEY VALUE" of the line "% KEY VALUE".
struct HeaderLine {
  std::string_view key;
  std::string_view value;
};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r' || text.back() == '\t'))
    text.remove_suffix(1);
  return text;
}

/// The text of a header's line at the beginning of `text`, empty where data begin there: their
/// first byte may be '%', too, but hardly a whole line of characters behind it.
std::string_view header_line(std::string_view text) {
  if (!text.starts_with('%')) return {};
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return {};
  const std::string_view line = text.substr(0, end + 1);
  const bool is_text = std::all_of(line.begin(), end + line.begin(), [](char c) {
    return static_cast<unsigned char>(c) >= 0x20 || c == '\t' || c == '\r';
  });
  return is_text ? line : std::string_view();
}

HeaderLine split(std::string_view line) {
  line = trimmed(line.substr(1, line.size() - 2));
  const std::size_t space = std::min(line.find(' '), line.size());
  return {line.substr(0, space), trimmed(line.substr(space))};
}

template <class Integer>
bool parse_whole(std::string_view text, Integer& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

void set_side(std::string_view text, int& side) {
  int pixels = 0;
  if (parse_whole(text, pixels) && pixels > 0 && pixels <= 65536) side = pixels;
}

RawEncoding encoding_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, RawEncoding>, 6> kNames{
      {{"EVT2", RawEncoding::kEvt2},
       {"2.0", RawEncoding::kEvt2},
       {"EVT21", RawEncoding::kEvt21},
       {"2.1", RawEncoding::kEvt21},
       {"EVT3", RawEncoding::kEvt3},
       {"3.0", RawEncoding::kEvt3}}};
  for (const auto& [text, encoding] : kNames)
    if (name == text) return encoding;
  return RawEncoding::kUnknown;
}

/// "EVT3;height=720;width=1280".
void read_format(std::string_view value, RawHeader& header) {
  const std::size_t name_end = std::min(value.find(';'), value.size());
  header.encoding = encoding_of(value.substr(0, name_end));
  for (std::size_t begin = name_end; begin < value.size();) {
    const std::size_t end = std::min(value.find(';', begin + 1), value.size());
    const std::string_view item = value.substr(begin + 1, end - begin - 1);
    const std::size_t equals = std::min(item.find('='), item.size());
    const std::string_view key = item.substr(0, equals);
    const std::string_view text = item.substr(std::min(equals + 1, item.size()));
    if (key == "width") set_side(text, header.sensor.width);
    if (key == "height") set_side(text, header.sensor.height);
    if (key == "endianness") header.endianness = text;
    begin = end;
  }
}

/// What the sensor of a plug-in measures: older headers name nothing else.
SensorSize sensor_of_plugin(std::string_view plugin) {
  constexpr std::array<std::pair<std::string_view, SensorSize>, 4> kSensors{
      {{"gen3", {640, 480}},
       {"gen4", {1280, 720}},
       {"imx636", {1280, 720}},
       {"genx320", {320, 320}}}};
  for (const auto& [name, size] : kSensors)
    if (plugin.find(name) != std::string_view::npos) return size;
  return {};
}

void read_line(const HeaderLine& line, RawHeader& header, SensorSize& of_plugin) {
  if (line.key == "format") read_format(line.value, header);
  if (line.key == "evt" && header.encoding == RawEncoding::kUnknown)
    header.encoding = encoding_of(line.value);
  if (line.key == "Width" || line.key == "width") set_side(line.value, header.sensor.width);
  if (line.key == "Height" || line.key == "height") set_side(line.value, header.sensor.height);
  if (line.key == "endianness") header.endianness = line.value;
  if (line.key == "plugin_name") of_plugin = sensor_of_plugin(line.value);
  if (std::int64_t origin_us = 0; line.key == kOriginKey && parse_whole(line.value, origin_us) &&
                                  origin_us >= 0 && origin_us <= kMostTime_us)
    header.origin_us = origin_us;
  if (line.key == "geometry") {
    const std::size_t x = std::min(line.value.find('x'), line.value.size());
    set_side(line.value.substr(0, x), header.sensor.width);
    set_side(line.value.substr(std::min(x + 1, line.value.size())), header.sensor.height);
  }
}

/// Behind the lines of a DAT file stand the type of its events, 0 or 12 for changes of intensity,
/// and their size.
bool is_dat(std::string_view data) {
  return data.size() >= 2 && (data[0] == 0 || data[0] == 12) && data[1] == 8;
}

}  // namespace

RawHeader parse_raw_header(std::string_view head) {
  RawHeader header;
  SensorSize of_plugin;
  while (true) {
    const std::string_view line = header_line(head.substr(header.bytes));
    if (line.empty()) break;
    header.bytes += line.size();
    const HeaderLine parts = split(line);
    if (parts.key == "end") break;
    read_line(parts, header, of_plugin);
  }
  if (header.sensor.width == 0 || header.sensor.height == 0) header.sensor = of_plugin;
  if (header.encoding == RawEncoding::kUnknown && header.bytes > 0 &&
      is_dat(head.substr(header.bytes))) {
    header.encoding = RawEncoding::kDat;
    header.bytes += 2;
  }
  return header;
}

RawHeader read_raw_header(ByteReader& bytes) {
  const auto head = bytes.peek(kMostHeaderBytes);
  RawHeader header = parse_raw_header({reinterpret_cast<const char*>(head.data()), head.size()});
  bytes.skip(header.bytes);
  return header;
}

std::string raw_header_text(RawEncoding encoding, SensorSize sensor, std::int64_t origin_us) {
  const bool is_evt3 = encoding == RawEncoding::kEvt3;
  std::string text = fmt::format("% evt {}\n", is_evt3 ? "3.0" : "2.0");
  const std::string_view name = is_evt3 ? "EVT3" : "EVT2";
  if (sensor.width > 0)
    text += fmt::format("% format {0};height={2};width={1}\n% geometry {1}x{2}\n", name,
                        sensor.width, sensor.height);
  else
    text += fmt::format("% format {}\n", name);
  if (origin_us != 0) text += fmt::format("% {} {}\n", kOriginKey, origin_us);
  return text + "% end\n";
}

}  // namespace saccade
