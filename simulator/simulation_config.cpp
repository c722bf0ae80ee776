#include "simulator/simulation_config.h"

#include "core/config/rigid3_node.h"

namespace saccade {
namespace {

constexpr double kHighestRate_hz = 1e6;

/// `gamma: srgb` or a number.
void describe_gamma(config::Fields& fields, std::optional<double>& gamma) {
  const char* const help = "8-bit pictures: srgb, or a number for the power 1 / gamma";
  const bool number =
      fields.reading() ? fields.form("gamma") == config::Form::kNumber : gamma.has_value();
  if (number) {
    double value = gamma.value_or(1);
    fields.value("gamma", value, help).range(0.1, 10);
    gamma = value;
  } else {
    std::string curve = "srgb";
    fields.value("gamma", curve, help).one_of({"srgb"});
    if (fields.has("gamma")) gamma.reset();
  }
}

}  // namespace

void describe(config::Fields& fields, PinholeCamera& camera) {
  fields.value("width", camera.width, "[px]").range(2, 65535);
  fields.value("height", camera.height, "[px]").range(2, 65535);
  fields.value("fx", camera.fx, "focal length [px]").range(1, 1e6);
  fields.value("fy", camera.fy, "focal length [px]").range(1, 1e6);
  // The principal point of another sensor size is its own centre unless stated.
  if (fields.has("width") || fields.has("height")) {
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
  fields.choice("radiance", options.radiance,
                {{"exposed", FrameOptions::Radiance::kExposed},
                 {"instant", FrameOptions::Radiance::kInstant}},
                "the EXR shows the exposure, as the PNG does, or the frame's instant");
  fields.value("gain", options.tone.gain, "8-bit pictures: radiance 1 / gain is white")
      .range(1e-6, 1e6);
  describe_gamma(fields, options.tone.gamma);
}

void describe(config::Fields& fields, RigCameraOptions& options) {
  fields.section("camera", options.camera, "default: the first camera's");
  fields
      .value("T_camera0_camera", options.camera0_from_camera,
             "4 x 4, point in the first camera = T * point in this one [m]")
      .required();
  fields.section("events", options.events, "default: the first camera's");
}

void describe(config::Fields& fields, GroundtruthOptions& options) {
  fields.value("pose_rate_hz", options.pose_rate_hz, "poses per second, both ends included")
      .range(0.1, kHighestRate_hz);
  fields.value("depth_rate_hz", options.depth_rate_hz, "depth maps per second besides the frames'")
      .range(0, kHighestRate_hz);
  fields.value("flow_rate_hz", options.flow_rate_hz, "motion fields per second")
      .range(0, kHighestRate_hz);
  fields.value("event_labels", options.event_labels,
               "labels.h5: depth, motion, object and origin of every event");
  fields
      .value("panorama_px_per_rad", options.panorama_px_per_rad,
             "panorama.exr: all that is seen from the first position, so fine; 0: none")
      .range(0, 5000);
}

void describe(config::Fields& fields, SimulationConfig& config) {
  fields.section("scene", config.scene, "meshes, background and light").required();
  fields.section("trajectory", config.trajectory, "motion of the camera").required();
  fields.value("start_s", config.start_s, "from the trajectory's first pose [s]").at_least(0);
  fields.value("duration_s", config.duration_s, "default: to the trajectory's end [s]").above(0);
  fields.section("camera", config.camera, "pinhole camera with lens distortion");
  fields.section("events", config.events, "event pixels");
  fields
      .list("rig", config.rig, "further cameras, fixed to the first",
            {config.camera, Rigid3(), config.events})
      .length(0, 63);
  fields.section("imu", config.imu, "inertial sensor");
  fields.section("frames", config.frames, "grey frames");
  fields.section("groundtruth", config.groundtruth, "rates of the ground truth");
  fields.value("gravity_m_s2", config.gravity_m_s2, "gravity in the world [m/s^2]")
      .range(-1000, 1000);
  fields.value("seed", config.seed, "of all random numbers");
}

}  // namespace saccade
