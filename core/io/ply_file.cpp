#include "core/io/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <functional>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/file_bytes.h"
#include "core/io/tables/text_table.h"

namespace saccade {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY is written as it lies in memory");

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct Property {
  std::string name;
  PlyType type;
};

struct PlyHeader {
  bool ascii = false;
  std::size_t vertices = 0;
  std::vector<Property> properties;
  std::size_t size = 0;  ///< [bytes]
  std::size_t lines = 0;
};

std::optional<PlyType> type_named(std::string_view name) {
  constexpr std::array<std::array<std::string_view, 2>, 8> kNames{{{"char", "int8"},
                                                                   {"uchar", "uint8"},
                                                                   {"short", "int16"},
                                                                   {"ushort", "uint16"},
                                                                   {"int", "int32"},
                                                                   {"uint", "uint32"},
                                                                   {"float", "float32"},
                                                                   {"double", "float64"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (name == kNames[i][0] || name == kNames[i][1]) return static_cast<PlyType>(i);
  return std::nullopt;
}

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

template <class T>
double value_as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double binary_value(PlyType type, const char* bytes) {
  switch (type) {
    case PlyType::kInt8:
      return value_as<std::int8_t>(bytes);
    case PlyType::kUint8:
      return value_as<std::uint8_t>(bytes);
    case PlyType::kInt16:
      return value_as<std::int16_t>(bytes);
    case PlyType::kUint16:
      return value_as<std::uint16_t>(bytes);
    case PlyType::kInt32:
      return value_as<std::int32_t>(bytes);
    case PlyType::kUint32:
      return value_as<std::uint32_t>(bytes);
    case PlyType::kFloat:
      return value_as<float>(bytes);
    default:
      return value_as<double>(bytes);
  }
}

/// Reads the header's lines; vertices must be the first element.
class HeaderParser {
 public:
  HeaderParser(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  PlyHeader parse() {
    if (next_line() != "ply") fail("a PLY file starts with a line 'ply'");
    for (std::string line = next_line(); line != "end_header"; line = next_line()) take(line);
    if (!has_vertices_) fail("there is no element 'vertex'");
    header_.size = position_;
    header_.lines = line_;
    return header_;
  }

 private:
  std::string next_line() {
    const std::size_t end = text_.find('\n', position_);
    if (end == std::string_view::npos) fail("the header has no end_header");
    std::string line(text_.substr(position_, end - position_));
    if (line.ends_with('\r')) line.pop_back();
    position_ = end + 1;
    ++line_;
    return line;
  }

  void take(const std::string& line) {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "format") take_format(words);
    if (keyword == "element") take_element(words);
    if (keyword == "property" && in_vertices_) take_property(words);
  }

  void take_format(std::istringstream& words) {
    std::string format;
    words >> format;
    header_.ascii = format == "ascii";
    if (!header_.ascii && format != "binary_little_endian")
      fail("format '" + format + "' is not supported; ascii and binary_little_endian are");
  }

  void take_element(std::istringstream& words) {
    std::string name;
    std::size_t count = 0;
    if (!(words >> name >> count)) fail("expected `element NAME COUNT`");
    in_vertices_ = name == "vertex";
    if (!in_vertices_ && !has_vertices_) fail("the first element must be 'vertex'");
    if (!in_vertices_) return;
    has_vertices_ = true;
    header_.vertices = count;
  }

  void take_property(std::istringstream& words) {
    std::string type;
    std::string name;
    words >> type >> name;
    if (type == "list") fail("a list property of vertices is not supported");
    const std::optional<PlyType> known = type_named(type);
    if (!known) fail("'" + type + "' is no PLY type");
    for (const Property& property : header_.properties)
      if (property.name == name) fail("property '" + name + "' is stated twice");
    constexpr std::size_t kMostProperties = 1000;
    if (header_.properties.size() == kMostProperties) fail("has too many properties");
    header_.properties.push_back({name, *known});
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(file_ + ":" + std::to_string(line_), problem);
  }

  std::string_view text_;
  std::string file_;
  std::size_t position_ = 0;
  std::size_t line_ = 0;
  bool in_vertices_ = false;
  bool has_vertices_ = false;
  PlyHeader header_;
};

using Store = std::function<void(std::size_t vertex, double value)>;

/// Where the values of one property go; grows the cloud by the attribute.
Store store_for(const std::string& name, std::size_t vertices, PointCloud& cloud) {
  constexpr std::array<std::string_view, 3> kPosition{"x", "y", "z"};
  constexpr std::array<std::string_view, 3> kNormal{"nx", "ny", "nz"};
  constexpr std::array<std::string_view, 3> kColour{"red", "green", "blue"};
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    if (name == kPosition[axis])
      return [&cloud, i](std::size_t v, double value) {
        cloud.positions[v][i] = static_cast<float>(value);
      };
    if (name == kNormal[axis]) {
      cloud.normals.resize(vertices, Eigen::Vector3f::Zero());
      return [&cloud, i](std::size_t v, double value) {
        cloud.normals[v][i] = static_cast<float>(value);
      };
    }
    if (name == kColour[axis]) {
      cloud.colours.resize(vertices);
      return [&cloud, axis](std::size_t v, double value) {
        // Other programs also write colours as floats, of any size.
        cloud.colours[v][axis] = value > 0 ? static_cast<std::uint8_t>(std::min(value, 255.0)) : 0;
      };
    }
  }
  const std::size_t index = cloud.scalars.size();
  cloud.scalars.push_back({name, std::vector<float>(vertices)});
  return [&cloud, index](std::size_t v, double value) {
    cloud.scalars[index].values[v] = static_cast<float>(value);
  };
}

/// A count beyond what the file can hold is no reason to allocate.
void check_length(const PlyHeader& header, std::size_t bytes, const std::string& file) {
  // In text a number takes a digit and what separates it from the next; the line where one is missing is
  // named when it is read.
  std::size_t least = 0;
  for (const Property& property : header.properties)
    least += header.ascii ? 2 : size_of(property.type);
  constexpr std::size_t kMissingLines = 1000;
  const std::size_t present = header.ascii ? bytes + kMissingLines : bytes;
  if (present / least < header.vertices)
    throw InputError(file,
                     fmt::format("is truncated: {} vertices of {}{} bytes are announced, {} "
                                 "bytes follow the header",
                                 header.vertices, header.ascii ? "at least " : "", least, bytes));
}

void read_binary(std::string_view body, const PlyHeader& header, const std::vector<Store>& stores) {
  const char* bytes = body.data();
  for (std::size_t v = 0; v < header.vertices; ++v)
    for (std::size_t i = 0; i < stores.size(); ++i) {
      stores[i](v, binary_value(header.properties[i].type, bytes));
      bytes += size_of(header.properties[i].type);
    }
}

void read_ascii(std::string_view body, const PlyHeader& header, const std::vector<Store>& stores,
                const std::string& file) {
  std::size_t line = header.lines;
  for (std::size_t v = 0; v < header.vertices; ++v) {
    if (body.empty())
      throw InputError(file, fmt::format("is truncated: {} vertices are announced, {} are there",
                                         header.vertices, v));
    const std::size_t end = std::min(body.find('\n'), body.size());
    TextRow row(file, ++line, body.substr(0, end));
    for (std::size_t i = 0; i < stores.size(); ++i)
      stores[i](v, row.number(header.properties[i].name.c_str()));
    row.expect_end("the properties of one vertex");
    body.remove_prefix(std::min(end + 1, body.size()));
  }
}

}  // namespace

PointCloud read_ply(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = read_file_bytes(file);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const PlyHeader header = HeaderParser(text, file.string()).parse();
  std::size_t axes = 0;
  for (const Property& p : header.properties)
    axes += p.name == "x" || p.name == "y" || p.name == "z";
  if (axes != 3) throw InputError(file.string(), "the vertices need properties x, y and z");
  check_length(header, bytes.size() - header.size, file.string());
  PointCloud cloud;
  cloud.positions.resize(header.vertices);
  std::vector<Store> stores;
  for (const Property& p : header.properties)
    stores.push_back(store_for(p.name, header.vertices, cloud));
  const std::string_view body = text.substr(header.size);
  if (header.ascii)
    read_ascii(body, header, stores, file.string());
  else
    read_binary(body, header, stores);
  return cloud;
}

void write_ply(const std::filesystem::path& file, const PointCloud& cloud) {
  const std::size_t count = cloud.positions.size();
  const bool normals = !cloud.normals.empty();
  const bool colours = !cloud.colours.empty();
  SACCADE_CHECK(!normals || cloud.normals.size() == count);
  SACCADE_CHECK(!colours || cloud.colours.size() == count);
  std::string text =
      fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", count);
  text += "property float x\nproperty float y\nproperty float z\n";
  if (normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (colours) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  for (const PointCloud::Scalar& scalar : cloud.scalars) {
    SACCADE_CHECK(scalar.values.size() == count);
    text += "property float " + scalar.name + "\n";
  }
  text += "end_header\n";
  const auto put = [&text](const auto& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (std::size_t i = 0; i < count; ++i) {
    for (const float v : cloud.positions[i]) put(v);
    if (normals)
      for (const float v : cloud.normals[i]) put(v);
    if (colours) put(cloud.colours[i]);
    for (const PointCloud::Scalar& scalar : cloud.scalars) put(scalar.values[i]);
  }
  write_atomically(file, text);
}

}  // namespace saccade
