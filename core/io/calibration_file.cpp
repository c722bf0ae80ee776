#include "core/io/calibration_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string>
#include <vector>

#include "core/config/convert.h"
#include "core/config/document.h"
#include "core/error.h"
#include "core/io/atomic_file.h"
#include "core/io/text_table.h"

namespace saccade {
namespace {

constexpr const char* kColumns = "fx fy cx cy k1 k2 p1 p2 k3";

/// The value of a key that must be there.
const config::Node& require(const config::Node& map, const std::string& key) {
  const config::Entry* entry = map.find(key);
  if (entry == nullptr) throw InputError(map.place.text(), "key '" + key + "' is missing");
  return entry->value;
}

void expect_text(const config::Node& node, const std::string& key,
                 std::initializer_list<const char*> allowed) {
  std::string text;
  config::from_node(node, key, text);
  for (const char* candidate : allowed)
    if (text == candidate) return;
  throw InputError(node.place.text(), fmt::format("{}: '{}' is not supported; supported: {}", key,
                                                  text, fmt::join(allowed, ", ")));
}

void read_distortion(const config::Node& cam, PinholeCamera& camera) {
  const config::Node& model = require(cam, "distortion_model");
  expect_text(model, "distortion_model", {"radtan", "none"});
  if (model.text == "none") return;
  const config::Node& node = require(cam, "distortion_coeffs");
  std::vector<double> values;
  config::from_node(node, "distortion_coeffs", values);
  if (values.size() != 4 && values.size() != 5)
    throw InputError(node.place.text(), "distortion_coeffs holds k1, k2, p1, p2 and perhaps k3");
  std::copy(values.begin(), values.end(), camera.distortion.begin());
}

}  // namespace

PinholeCamera read_calib_txt(const std::filesystem::path& file) {
  PinholeCamera camera;
  bool found = false;
  for_each_row(file, [&](TextRow& row) {
    if (found) row.fail(std::string("only one line is expected: `") + kColumns + "`");
    found = true;
    camera.fx = row.number("fx");
    camera.fy = row.number("fy");
    camera.cx = row.number("cx");
    camera.cy = row.number("cy");
    if (row.at_end()) return true;
    for (const std::size_t i : {0U, 1U, 2U, 3U, 4U})
      camera.distortion[i] = row.number(std::array{"k1", "k2", "p1", "p2", "k3"}[i]);
    row.expect_end(kColumns);
    return true;
  });
  if (!found) throw InputError(file.string(), std::string("is empty; expected `") + kColumns + "`");
  return camera;
}

void write_calib_txt(const std::filesystem::path& file, const PinholeCamera& camera) {
  write_atomically(file, fmt::format("{} {} {} {} {}\n", camera.fx, camera.fy, camera.cx, camera.cy,
                                     fmt::join(camera.distortion, " ")));
}

PinholeCamera read_camera_yaml(const std::filesystem::path& file) {
  const config::Document document = config::load(file);
  const config::Node& cam = require(document.root(), "cam0");
  expect_text(require(cam, "camera_model"), "camera_model", {"pinhole"});
  std::array<double, 4> intrinsics{};
  config::from_node(require(cam, "intrinsics"), "intrinsics", intrinsics);
  std::array<int, 2> resolution{};
  config::from_node(require(cam, "resolution"), "resolution", resolution);
  PinholeCamera camera;
  camera.width = resolution[0];
  camera.height = resolution[1];
  camera.fx = intrinsics[0];
  camera.fy = intrinsics[1];
  camera.cx = intrinsics[2];
  camera.cy = intrinsics[3];
  read_distortion(cam, camera);
  camera.check(cam.place.text());
  return camera;
}

void write_camera_yaml(const std::filesystem::path& file, const PinholeCamera& camera) {
  const std::size_t coefficients = camera.distortion[4] != 0 ? 5 : 4;
  write_atomically(file,
                   fmt::format("cam0:\n"
                               "  camera_model: pinhole\n"
                               "  intrinsics: [{}, {}, {}, {}]\n"
                               "  distortion_model: radtan\n"
                               "  distortion_coeffs: [{}]\n"
                               "  resolution: [{}, {}]\n",
                               camera.fx, camera.fy, camera.cx, camera.cy,
                               fmt::join(std::span(camera.distortion).first(coefficients), ", "),
                               camera.width, camera.height));
}

}  // namespace saccade
