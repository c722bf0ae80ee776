#include "core/io/import/camera_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/events/event_formats.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// What ROS's camera_calibration writes, row by row.
struct RosCameraFile {
  struct Matrix {
    std::vector<double> data;
  };
  int width = 0;
  int height = 0;
  Matrix camera;
  std::string model = "plumb_bob";
  Matrix distortion;
};

void describe(config::Fields& fields, RosCameraFile::Matrix& matrix) {
  fields.allow_unknown();
  fields.value("data", matrix.data, "entries, row by row").required();
}

void describe(config::Fields& fields, RosCameraFile& file) {
  fields.allow_unknown();
  fields.value("image_width", file.width, "[px]").required();
  fields.value("image_height", file.height, "[px]").required();
  fields.section("camera_matrix", file.camera, "K").required();
  fields.value("distortion_model", file.model, "lens").one_of({"plumb_bob", "radtan"});
  fields.section("distortion_coefficients", file.distortion, "k1 k2 p1 p2 k3").required();
  fields.expect(file.camera.data.size() == 9, "camera_matrix", "must hold 9 numbers");
  fields.expect(file.distortion.data.size() == 4 || file.distortion.data.size() == 5,
                "distortion_coefficients", "must hold k1 k2 p1 p2 and perhaps k3");
}

ChainCamera read_ros_camera(const config::Document& document) {
  const auto file = config::read<RosCameraFile>(document);
  const std::vector<double>& k = file.camera.data;
  ChainCamera chained;
  chained.camera = {file.width, file.height, k[0], k[4], k[2], k[5], {}};
  std::copy(file.distortion.data.begin(), file.distortion.data.end(),
            chained.camera.distortion.begin());
  return chained;
}

/// "cam1" -> 1; 0 where nothing is named.
std::size_t camera_index(const EventFilePlace& place) {
  if (place.member.empty()) return 0;
  std::size_t index = 0;
  const std::string_view name = std::string_view(place.member).substr(1);
  const auto [end, error] = std::from_chars(name.data() + std::min<std::size_t>(3, name.size()),
                                            name.data() + name.size(), index);
  if (!name.starts_with("cam") || error != std::errc() || end != name.data() + name.size())
    throw InputError(place.file.string(),
                     fmt::format("'{}' names no camera; cam0, cam1 ... do", name));
  return index;
}

ChainCamera read_yaml_camera(const EventFilePlace& place) {
  const config::Document document = config::load(place.file);
  if (document.root().find("camera_matrix") != nullptr) return read_ros_camera(document);
  const std::vector<ChainCamera> chain = read_camera_chain(place.file);
  const std::size_t index = camera_index(place);
  if (index >= chain.size())
    throw InputError(place.file.string(), fmt::format("holds {} cameras, cam0 to cam{}; cam{} is "
                                                      "none of them",
                                                      chain.size(), chain.size() - 1, index));
  return chain[index];
}

}  // namespace

ChainCamera read_any_calibration(const fs::path& path, SensorSize sensor) {
  const EventFilePlace place = event_file_place(path);
  if (!fs::exists(place.file)) throw InputError(place.file.string(), "no such file");
  ChainCamera chained;
  if (place.file.extension() == ".txt")
    chained.camera = read_calib_txt(place.file);
  else
    chained = read_yaml_camera(place);
  PinholeCamera& camera = chained.camera;
  if (camera.width == 0) {
    camera.width = sensor.width;
    camera.height = sensor.height;
  }
  if (sensor.width > 0 && (camera.width != sensor.width || camera.height != sensor.height))
    throw InputError(place.file.string(),
                     fmt::format("is of a camera of {} x {} px; the recording is of {} x {} px",
                                 camera.width, camera.height, sensor.width, sensor.height));
  camera.check(place.file.string());
  return chained;
}

std::optional<ChainCamera> find_calibration(const fs::path& chosen, const fs::path& folder,
                                            SensorSize sensor) {
  if (!chosen.empty()) return read_any_calibration(chosen, sensor);
  for (const char* name : {"calib.txt", "camera.yaml"})
    if (const fs::path file = folder / name; fs::exists(file))
      return read_any_calibration(file, sensor);
  return std::nullopt;
}

}  // namespace saccade
