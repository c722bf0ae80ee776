#include "simulator/simulation_config.h"

namespace saccade {
namespace {

constexpr double kHighestRate_hz = 1e6;

}  // namespace

void describe(config::Fields& fields, PinholeCamera& camera) {
  fields.value("width", camera.width, "[px]").range(2, 65535);
  fields.value("height", camera.height, "[px]").range(2, 65535);
  fields.value("fx", camera.fx, "focal length [px]").range(1, 1e6);
  fields.value("fy", camera.fy, "focal length [px]").range(1, 1e6);
  // The principal point of another sensor size is its own centre unless stated.
  if (fields.reading()) {
    camera.cx = 0.5 * (camera.width - 1);
    camera.cy = 0.5 * (camera.height - 1);
  }
  fields.value("cx", camera.cx, "principal point [px]; default: the image's centre")
      .range(-1e6, 1e6);
  fields.value("cy", camera.cy, "principal point [px]; default: the image's centre")
      .range(-1e6, 1e6);
  fields.value("distortion", camera.distortion, "k1 k2 p1 p2 k3").range(-100, 100);
}

void describe(config::Fields& fields, FrameOptions& options) {
  fields.value("rate_hz", options.rate_hz, "grey frames per second; 0: none")
      .range(0, kHighestRate_hz);
  fields.value("exposure_s", options.exposure_s, "centred on the frame's time; 0: sharp [s]")
      .range(0, 1);
}

void describe(config::Fields& fields, GroundtruthOptions& options) {
  fields.value("pose_rate_hz", options.pose_rate_hz, "poses per second, both ends included")
      .range(0.1, kHighestRate_hz);
  fields.value("depth_rate_hz", options.depth_rate_hz, "depth maps per second besides the frames'")
      .range(0, kHighestRate_hz);
  fields.value("flow_rate_hz", options.flow_rate_hz, "motion fields per second")
      .range(0, kHighestRate_hz);
}

void describe(config::Fields& fields, SimulationConfig& config) {
  fields.section("scene", config.scene, "meshes, background and light").required();
  fields.section("trajectory", config.trajectory, "motion of the camera").required();
  fields.value("start_s", config.start_s, "from the trajectory's first pose [s]").at_least(0);
  fields.value("duration_s", config.duration_s, "default: to the trajectory's end [s]").above(0);
  fields.section("camera", config.camera, "pinhole camera with lens distortion");
  fields.section("events", config.events, "event pixels");
  fields.section("imu", config.imu, "inertial sensor");
  fields.section("frames", config.frames, "grey frames");
  fields.section("groundtruth", config.groundtruth, "rates of the ground truth");
  fields.value("gravity_m_s2", config.gravity_m_s2, "gravity in the world [m/s^2]")
      .range(-1000, 1000);
  fields.value("seed", config.seed, "of all random numbers");
}

}  // namespace saccade
