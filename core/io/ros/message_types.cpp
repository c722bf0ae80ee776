#include "core/io/ros/message_types.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <optional>
#include <vector>

#include "core/check.h"

namespace saccade {
namespace {

struct TypeDefinition {
  std::string_view name;
  std::string_view fields;  ///< a line each, as ROS 1 has them
};

constexpr std::array<TypeDefinition, 19> kTypes{{
    {"std_msgs/Header", "uint32 seq\ntime stamp\nstring frame_id"},
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z"},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose"},
    {"geometry_msgs/Transform",
     "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms"},
    {"sensor_msgs/Image",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 "
     "is_bigendian\nuint32 step\nuint8[] data"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] "
     "orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\nfloat64[9] "
     "angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\nfloat64[9] "
     "linear_acceleration_covariance"},
    {"sensor_msgs/RegionOfInterest",
     "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify"},
    {"sensor_msgs/CameraInfo",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] "
     "D\nfloat64[9] K\nfloat64[9] R\nfloat64[12] P\nuint32 binning_x\nuint32 "
     "binning_y\nsensor_msgs/RegionOfInterest roi"},
    {"sensor_msgs/PointField",
     "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 "
     "UINT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 "
     "datatype\nuint32 count"},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool "
     "is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense"},
    {"dvs_msgs/Event", "uint16 x\nuint16 y\ntime ts\nbool polarity"},
    {"dvs_msgs/EventArray",
     "std_msgs/Header header\nuint32 height\nuint32 width\ndvs_msgs/Event[] events"},
    {"event_camera_msgs/EventPacket",
     "std_msgs/Header header\nuint32 height\nuint32 width\nuint64 seq\nuint64 time_base\nstring "
     "encoding\nbool is_bigendian\nuint8[] events"},
}};

const TypeDefinition* find_type(std::string_view name) {
  const auto* found = std::find_if(kTypes.begin(), kTypes.end(),
                                   [&](const TypeDefinition& type) { return type.name == name; });
  return found == kTypes.end() ? nullptr : found;
}

struct FieldLine {
  std::string type;  ///< with its brackets
  std::string name;  ///< "INT8=1" of a constant

  [[nodiscard]] bool is_constant() const { return name.find('=') != std::string::npos; }
  [[nodiscard]] std::string element() const { return type.substr(0, type.find('[')); }
};

std::vector<FieldLine> lines_of(std::string_view type) {
  const TypeDefinition* definition = find_type(type);
  SACCADE_CHECK(definition != nullptr);
  std::vector<FieldLine> lines;
  for (std::string_view rest = definition->fields; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    const std::size_t space = line.find(' ');
    lines.push_back({std::string(line.substr(0, space)), std::string(line.substr(space + 1))});
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return lines;
}

/// The same as ROS 2 has it: times are a type of their own, headers do not count, and names of
/// fields are of small letters.
std::vector<FieldLine> ros2_lines(std::string_view type) {
  std::vector<FieldLine> lines = lines_of(type);
  if (type == "std_msgs/Header") lines.erase(lines.begin());
  for (FieldLine& line : lines) {
    if (line.type == "time") line.type = "builtin_interfaces/Time";
    if (!line.is_constant())
      std::transform(line.name.begin(), line.name.end(), line.name.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  }
  return lines;
}

using Lines = std::vector<FieldLine> (*)(std::string_view);

void collect_parts(std::string_view type, Lines lines, std::vector<std::string>& parts) {
  for (const FieldLine& line : lines(type)) {
    const std::string element = line.element();
    if (find_type(element) == nullptr ||
        std::find(parts.begin(), parts.end(), element) != parts.end())
      continue;
    parts.push_back(element);
    collect_parts(element, lines, parts);
  }
}

std::string text_of(std::string_view type, Lines lines) {
  std::string text;
  for (const FieldLine& line : lines(type)) text += line.type + " " + line.name + "\n";
  return text;
}

std::string definition_of(std::string_view type, Lines lines) {
  std::vector<std::string> parts;
  collect_parts(type, lines, parts);
  std::string text = text_of(type, lines);
  for (const std::string& part : parts)
    text += std::string(80, '=') + "\nMSG: " + part + "\n" + text_of(part, lines);
  return text;
}

std::string md5_of(const std::string& text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  SACCADE_CHECK(EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_md5(), nullptr) ==
                1);
  std::string hex;
  for (unsigned i = 0; i < size; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

}  // namespace

std::string ros1_definition(std::string_view type) { return definition_of(type, lines_of); }
std::string ros2_definition(std::string_view type) { return definition_of(type, ros2_lines); }

std::string ros1_md5(std::string_view type) {
  std::string text;
  for (const bool constants : {true, false})
    for (const FieldLine& line : lines_of(type)) {
      if (line.is_constant() != constants) continue;
      const bool is_builtin = find_type(line.element()) == nullptr;
      text += (text.empty() ? "" : "\n") + (is_builtin ? line.type : ros1_md5(line.element())) +
              " " + line.name;
    }
  return md5_of(text);
}

std::string ros2_type_name(std::string_view type) {
  const std::size_t slash = type.find('/');
  return fmt::format("{}/msg/{}", type.substr(0, slash), type.substr(slash + 1));
}

}  // namespace saccade
