#include "simulator/simulation_config.h"

#include <algorithm>

#include "core/config/rigid3_node.h"

namespace saccade {
namespace {

constexpr double kHighestRate_hz = 1e6;

}  // namespace

void describe(config::Fields& fields, PinholeCamera& camera) {
  fields.value("width", camera.width, "Width of the image, in pixels.").range(2, 65535);
  fields.value("height", camera.height, "Height of the image, in pixels.").range(2, 65535);
  fields.value("fx", camera.fx, "Horizontal focal length, in pixels.").range(1, 1e6);
  fields.value("fy", camera.fy, "Vertical focal length, in pixels.").range(1, 1e6);
  // The principal point of another sensor size is its own centre unless stated.
  if (fields.has("width") || fields.has("height")) {
    camera.cx = 0.5 * (camera.width - 1);
    camera.cy = 0.5 * (camera.height - 1);
  }
  fields
      .value("cx", camera.cx,
             "Column of the principal point, in pixels; the default is the centre of the image.")
      .range(-1e6, 1e6);
  fields
      .value("cy", camera.cy,
             "Row of the principal point, in pixels; the default is the centre of the image.")
      .range(-1e6, 1e6);
  fields.value("distortion", camera.distortion, "Lens distortion k1, k2, p1, p2, k3 as in OpenCV.")
      .range(-100, 100);
}

void describe(config::Fields& fields, FrameOptions& options) {
  fields.value("rate_hz", options.rate_hz, "Number of frames per second. 0 disables frames.")
      .range(0, kHighestRate_hz);
  fields
      .value("exposure_s", options.exposure_s,
             "Exposure of a frame, centred on its time, in seconds; longer exposures blur motion. "
             "0 gives sharp frames.")
      .range(0, 1);
  fields
      .value("readout_s", options.readout_s,
             "Time from the exposure of the first row to that of the last one, in seconds, as a "
             "rolling shutter reads out an image. The time of the frame is in the middle. 0 "
             "exposes all rows at once.")
      .range(0, 1);
  fields.choice("colour", options.colour,
                {{"grey", FrameOptions::Colour::kGrey},
                 {"rgb", FrameOptions::Colour::kRgb},
                 {"rggb", FrameOptions::Colour::kRggb}},
                "Colours of the frames: grey shows the luminance; rgb the linear primaries of "
                "sRGB in three planes; rggb one plane in which each pixel shows its own, as a "
                "sensor behind Bayer's filter with red in the top left corner delivers it. Both "
                "take three more copies of the scene in memory.");
  fields.choice("radiance", options.radiance,
                {{"exposed", FrameOptions::Radiance::kExposed},
                 {"instant", FrameOptions::Radiance::kInstant}},
                "Whether the EXR file shows the exposure, as the PNG file does, or the scene at "
                "the time of the frame, without blur and with all rows at once.");
  fields
      .value("gain", options.tone.gain,
             "Gain of the 8-bit frames: radiance 1 / gain becomes white; the tone curve is sRGB.")
      .range(1e-6, 1e6);
}

void describe(config::Fields& fields, RigCameraOptions& options) {
  fields.section("camera", options.camera,
                 "Lens and image size; the default is that of the first camera.");
  fields
      .value("T_camera0_camera", options.camera0_from_camera,
             "Pose as a 4 x 4 matrix: a point in the first camera is T times the point in this "
             "camera, in metres.")
      .range(-1e6, 1e6)
      .required();
  fields.section("events", options.events,
                 "Event pixels; the default is those of the first camera.");
}

void describe(config::Fields& fields, GroundtruthOptions& options) {
  fields
      .value("pose_rate_hz", options.pose_rate_hz,
             "Number of ground-truth poses per second; the first and the last time of the "
             "recording are included.")
      .range(0.1, kHighestRate_hz);
  fields
      .value("depth_rate_hz", options.depth_rate_hz,
             "Number of depth maps per second, in addition to one at every frame. 0 gives those of "
             "the frames alone.")
      .range(0, kHighestRate_hz);
  fields
      .value("flow_rate_hz", options.flow_rate_hz,
             "Number of motion fields per second. 0 disables them.")
      .range(0, kHighestRate_hz);
  fields
      .value("masks_rate_hz", options.masks_rate_hz,
             "Number of masks per second of instances and classes, with the boxes of what is "
             "visible, in addition to one at every frame. 0 disables them.")
      .range(0, kHighestRate_hz);
  fields
      .value("normals_rate_hz", options.normals_rate_hz,
             "Number of maps per second of the surface normals, in addition to one at every frame. "
             "0 disables them.")
      .range(0, kHighestRate_hz);
  fields
      .value(
          "optical_flow_rate_hz", options.optical_flow_rate_hz,
          "Number of optical flows per second: displacements in pixels from k / rate to "
          "(k + 1) / rate and back, with masks of what is occluded. The rate of the frames gives "
          "the flow between consecutive frames; 0 disables it.")
      .range(0, kHighestRate_hz);
  fields.value("event_labels", options.event_labels,
               "Whether labels.h5 is written: depth, motion, object, instance, class and origin of "
               "every event.");
  fields
      .value("panorama_px_per_rad", options.panorama_px_per_rad,
             "Resolution of panorama.exr, the whole sphere as seen from the first position, in "
             "pixels per radian. 0 disables it.")
      .range(0, 5000);
}

void describe(config::Fields& fields, SimulationConfig& config) {
  fields.section("scene", config.scene, "Meshes, background and light.").required();
  fields.section("trajectory", config.trajectory, "Motion of the camera.").required();
  fields
      .value("start_s", config.start_s,
             "Start of the recording, in seconds after the first pose of the trajectory.")
      .at_least(0);
  fields
      .value("duration_s", config.duration_s,
             "Length of the recording, in seconds; the default is the rest of the trajectory.")
      .range(1e-6, 1e6);
  fields.section("camera", config.camera, "Pinhole camera with lens distortion.");
  const ModelCameraOptions& model = config.trajectory.model_camera;
  if (fields.reading() && config.trajectory.source == MotionSource::kModelCamera &&
      model.sets_focal_length && !model.file.empty())
    config.camera.fx = config.camera.fy = model_focal_length_px(model, config.camera.height);
  fields
      .path("sensor", config.sensor,
            "File of a calibrated sensor (`saccade calibrate`), whose known values are the "
            "defaults of the keys of events, before those of events.preset; ~ takes none.")
      .must_exist();
  if (fields.has("sensor") && config.sensor)
    config.events.sensor = read_sensor_file(*config.sensor).events;
  fields.section("events", config.events, "Event pixels and their imperfections.");
  const bool is_animated = std::ranges::any_of(
      config.scene.meshes, [](const MeshOptions& mesh) { return mesh.animation.has_value(); });
  fields.expect(!is_animated || config.events.sampling != Sampling::kExact, "events",
                "sampling: exact cannot be combined with an animated mesh, because its proofs hold "
                "for rigid motion; state sampling: adaptive, auto or frames");
  fields
      .list("rig", config.rig, "Further cameras, fixed to the first one.",
            {config.camera, Rigid3(), config.events})
      .length(0, 63);
  fields.section("imu", config.imu, "Inertial sensor.");
  fields.section("frames", config.frames, "Frames.");
  fields.section("groundtruth", config.groundtruth, "Rates of the ground truth.");
  fields.value("gravity_m_s2", config.gravity_m_s2, "Gravity in the world, in m/s^2.")
      .range(-1000, 1000);
  fields
      .value("seed", config.seed,
             "Seed of all random numbers of the sensors; another seed gives another realisation "
             "of their noise.")
      .at_least(0);
}

}  // namespace saccade
