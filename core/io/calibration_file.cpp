#include "core/io/calibration_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string>
#include <utility>

#include "core/config/convert.h"
#include "core/config/document.h"
#include "core/config/rigid3_node.h"
#include "core/config/yaml_emit.h"
#include "core/error.h"
#include "core/fisheye_camera.h"
#include "core/io/files/atomic_file.h"
#include "core/io/tables/text_table.h"

namespace saccade {
namespace {

constexpr const char* kCalibrationColumns = "fx fy cx cy k1 k2 p1 p2 k3";

/// The value of a key that must be there.
const config::Node& require(const config::Node& map, const std::string& key) {
  const config::Entry* entry = map.find(key);
  if (entry == nullptr) throw InputError(map.location.text(), "key '" + key + "' is missing");
  return entry->value;
}

void expect_text(const config::Node& node, const std::string& key,
                 std::initializer_list<const char*> allowed) {
  std::string text;
  config::from_node(node, key, text);
  for (const char* candidate : allowed)
    if (text == candidate) return;
  throw InputError(node.location.text(), fmt::format("{}: '{}' is not supported; supported: {}",
                                                     key, text, fmt::join(allowed, ", ")));
}

std::vector<double> read_coefficients(const config::Node& cam, std::size_t least, std::size_t most,
                                      const char* names) {
  const config::Node& node = require(cam, "distortion_coeffs");
  std::vector<double> values;
  config::from_node(node, "distortion_coeffs", values);
  if (values.size() < least || values.size() > most)
    throw InputError(node.location.text(), std::string("distortion_coeffs holds ") + names);
  return values;
}

/// Turns `chained.camera`, which has no distortion yet, into the nearest one to the lens.
void fit_equidistant(const config::Node& cam, ChainCamera& chained) {
  const std::vector<double> values = read_coefficients(cam, 4, 4, "k1, k2, k3, k4");
  const PinholeCamera& pinhole = chained.camera;
  FisheyeCamera lens{pinhole.width, pinhole.height, pinhole.fx, pinhole.fy,
                     pinhole.cx,    pinhole.cy,     {}};
  std::copy(values.begin(), values.end(), lens.k.begin());
  const FisheyeFit fit = fit_pinhole(lens, cam.location.text());
  if (fit.residual_px > kMostFitResidual_px)
    throw InputError(cam.location.text(),
                     fmt::format("no radial-tangential model is nearer to this lens than {:.2g} px",
                                 fit.residual_px));
  chained.camera = fit.camera;
  chained.residual_px = fit.residual_px;
}

void read_distortion(const config::Node& cam, ChainCamera& chained) {
  const config::Node& model = require(cam, "distortion_model");
  expect_text(model, "distortion_model", {"radtan", "equidistant", "none"});
  if (model.text == "none") return;
  if (model.text == "equidistant") return fit_equidistant(cam, chained);
  const std::vector<double> values = read_coefficients(cam, 4, 5, "k1, k2, p1, p2 and perhaps k3");
  std::copy(values.begin(), values.end(), chained.camera.distortion.begin());
}

ChainCamera read_camera(const config::Node& cam) {
  expect_text(require(cam, "camera_model"), "camera_model", {"pinhole"});
  std::array<double, 4> intrinsics{};
  config::from_node(require(cam, "intrinsics"), "intrinsics", intrinsics);
  std::array<int, 2> resolution{};
  config::from_node(require(cam, "resolution"), "resolution", resolution);
  ChainCamera chained;
  PinholeCamera& camera = chained.camera;
  camera.width = resolution[0];
  camera.height = resolution[1];
  camera.fx = intrinsics[0];
  camera.fy = intrinsics[1];
  camera.cx = intrinsics[2];
  camera.cy = intrinsics[3];
  camera.check(cam.location.text());
  read_distortion(cam, chained);
  camera.check(cam.location.text());
  return chained;
}

std::optional<Rigid3> read_transform(const config::Node& cam, const std::string& key) {
  const config::Entry* entry = cam.find(key);
  if (entry == nullptr) return std::nullopt;
  Rigid3 transform;
  from_node(entry->value, key, transform);
  return transform;
}

std::string camera_key(std::size_t index) { return fmt::format("cam{}", index); }

config::Node camera_node(const ChainCamera& chained) {
  const PinholeCamera& camera = chained.camera;
  const std::span<const double> coefficients(camera.distortion);
  config::Node node = config::Node::map();
  const auto add = [&](const char* key, config::Node value) {
    node.entries.push_back({key, {}, std::move(value), {}});
  };
  if (chained.camera_from_imu) add("T_cam_imu", to_node(*chained.camera_from_imu));
  if (chained.camera_from_previous) add("T_cn_cnm1", to_node(*chained.camera_from_previous));
  add("camera_model", config::Node::scalar("pinhole", false));
  add("intrinsics", config::to_node(std::array{camera.fx, camera.fy, camera.cx, camera.cy}));
  add("distortion_model", config::Node::scalar("radtan", false));
  const auto kept = coefficients.first(coefficients[4] != 0 ? 5 : 4);
  add("distortion_coeffs", config::to_node(std::vector<double>(kept.begin(), kept.end())));
  add("resolution", config::to_node(std::array{camera.width, camera.height}));
  // The clocks of all sensors agree.
  if (chained.camera_from_imu) add("timeshift_cam_imu", config::to_node(0.0));
  return node;
}

}  // namespace

PinholeCamera read_calib_txt(const std::filesystem::path& file) {
  PinholeCamera camera;
  bool found = false;
  for_each_row(file, [&](TextRow& row) {
    if (found) row.fail(std::string("only one line is expected: `") + kCalibrationColumns + "`");
    found = true;
    camera.fx = row.number("fx");
    camera.fy = row.number("fy");
    camera.cx = row.number("cx");
    camera.cy = row.number("cy");
    if (row.at_end()) return true;
    for (const std::size_t i : {0U, 1U, 2U, 3U, 4U})
      camera.distortion[i] = row.number(std::array{"k1", "k2", "p1", "p2", "k3"}[i]);
    row.expect_end(kCalibrationColumns);
    return true;
  });
  if (!found)
    throw InputError(file.string(),
                     std::string("is empty; expected `") + kCalibrationColumns + "`");
  return camera;
}

void write_calib_txt(const std::filesystem::path& file, const PinholeCamera& camera) {
  write_atomically(file, fmt::format("{} {} {} {} {}\n", camera.fx, camera.fy, camera.cx, camera.cy,
                                     fmt::join(camera.distortion, " ")));
}

PinholeCamera read_camera_yaml(const std::filesystem::path& file) {
  const config::Document document = config::load(file);
  return read_camera(require(document.root(), "cam0")).camera;
}

void write_camera_yaml(const std::filesystem::path& file, const PinholeCamera& camera) {
  write_camera_chain(file, std::vector<ChainCamera>{{.camera = camera}});
}

std::vector<ChainCamera> read_camera_chain(const std::filesystem::path& file) {
  const config::Document document = config::load(file);
  static_cast<void>(require(document.root(), "cam0"));
  std::vector<ChainCamera> cameras;
  while (const config::Entry* entry = document.root().find(camera_key(cameras.size()))) {
    const config::Node& cam = entry->value;
    ChainCamera& chained = cameras.emplace_back(read_camera(cam));
    chained.camera_from_imu = read_transform(cam, "T_cam_imu");
    chained.camera_from_previous = read_transform(cam, "T_cn_cnm1");
    if (const config::Entry* shift = cam.find("timeshift_cam_imu"))
      config::from_node(shift->value, "timeshift_cam_imu", chained.timeshift_s);
  }
  return cameras;
}

void write_camera_chain(const std::filesystem::path& file, std::span<const ChainCamera> cameras) {
  config::Node chain = config::Node::map();
  for (const ChainCamera& camera : cameras)
    chain.entries.push_back({camera_key(chain.entries.size()), {}, camera_node(camera), {}});
  write_atomically(file, config::to_yaml(chain));
}

}  // namespace saccade
