#include "simulator/simulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/calibration_file.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/events_h5.h"
#include "core/io/images/image_file.h"
#include "core/io/imu_file.h"
#include "core/io/labels/box_file.h"
#include "core/io/labels/label_images.h"
#include "core/io/labels/label_record.h"
#include "core/io/labels/optical_flow_file.h"
#include "core/panorama.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "core/srgb.h"
#include "tests/support/closed_form_plane.h"
#include "tests/support/command.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::ClosedFormPlane;

/// A folder with a plane's files, and the configuration that simulates it.
class SimulatePlane : public ::testing::Test {
 protected:
  void SetUp() override {
    set_progress_quiet(true);
    folder_ = fs::path(::testing::TempDir()) /
              ("simulate_" +
               std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    plane_.duration_s = 0.25;
    mesh_ = plane_.write_mesh(folder_);
  }

  void TearDown() override {
    set_thread_count(0);
    set_progress_quiet(false);
    fs::remove_all(folder_);
  }

  /// The configuration as a user writes it, with `more` lines.
  [[nodiscard]] SimulationConfig config(const std::string& more = "") const {
    const Eigen::Vector2d end = plane_.start + plane_.duration_s * plane_.velocity;
    std::ostringstream yaml;
    yaml << "scene: {meshes: [{file: " << mesh_ << "}]}\n"
         << "trajectory:\n  source: waypoints\n  waypoints:\n"
         << "    - [5, " << plane_.start.x() << ", " << plane_.start.y() << ", 0, 0, 0, 0, 1]\n"
         << "    - [" << 5 + plane_.duration_s << ", " << end.x() << ", " << end.y()
         << ", 0, 0, 0, 0, 1]\n"
         << "camera: {width: 61, height: 46, fx: 100, fy: 100}\n"
         << more;
    return config::read<SimulationConfig>(config::parse(yaml.str(), "test.yaml", folder_));
  }

  [[nodiscard]] fs::path output(const std::string& name = "out") const { return folder_ / name; }

  ClosedFormPlane plane_ = ClosedFormPlane::smooth(61, 46);
  fs::path folder_, mesh_;
};

std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) {
      std::ifstream file(entry.path(), std::ios::binary);
      std::ostringstream bytes;
      bytes << file.rdbuf();
      files[entry.path().lexically_relative(folder).string()] = bytes.str();
    }
  return files;
}

TEST_F(SimulatePlane, WritesADatasetThatAgreesWithTheClosedForm) {
  const CameraReport report =
      simulate(config("events: {timestamp_unit: ns}\ngroundtruth: {flow_rate_hz: 20}\n"), output())
          .cameras.front();
  const Dataset dataset = Dataset::open(output());
  EXPECT_EQ(dataset.camera().cx, 30);
  const Events events = dataset.load_events();
  const auto match = testing::match_exact(plane_.events(0.15, 0.15, 1e-3), events, 61, 46);
  EXPECT_EQ(match.found, match.expected);
  EXPECT_EQ(match.wrong_pixels, 0U);
  EXPECT_LE(match.median_us, 0.1);
  EXPECT_LE(match.p99_us, 1);
  EXPECT_EQ(report.event_count(), static_cast<std::int64_t>(events.size()));
  EXPECT_NEAR(*report.record.path_length_m, 0.25 * plane_.velocity.norm(), 1e-9);
  EXPECT_LE(*report.record.time_bound_us, 1);

  EXPECT_EQ(dataset.groundtruth().start_s(), 0);
  EXPECT_EQ(dataset.groundtruth().end_s(), 0.25);
  EXPECT_EQ(dataset.groundtruth().size(), 251U);
  ASSERT_EQ(dataset.frames().size(), 7U);      // 24 Hz: 0 .. 6 / 24
  ASSERT_EQ(dataset.depth_maps().size(), 9U);  // and 10 Hz: 0.1, 0.2
  EXPECT_NEAR(*dataset.facts().mean_depth_m, plane_.distance_m, 1e-6);
  EXPECT_EQ(report.record.counts->flow_maps, 6);
  EXPECT_EQ(report.record.counts->imu_samples, 251);
  EXPECT_TRUE(verify_hashes(output()).empty());
}

TEST_F(SimulatePlane, SamplesWholeFramesWhenAskedTo) {
  const CameraReport report =
      simulate(config("events: {sampling: frames, frames_rate_hz: 100}\n"), output())
          .cameras.front();
  EXPECT_EQ(report.record.rays, 26 * 61 * 46);
  EXPECT_NEAR(*report.record.time_bound_us, 1e4, 1e-6);
  EXPECT_GT(report.event_count(), 1000);
}

TEST_F(SimulatePlane, StatesTheMotionAndTheImuThatWereSimulated) {
  simulate(config("imu: {rate_hz: 100, gyro_noise_density: 0.01, accel_bias: [0, 1, 0]}\n"
                  "events: {contrast_on: 1, contrast_off: 1}\n"),
           output());
  const Dataset dataset = Dataset::open(output());
  const std::vector<StampedTwist> twists = dataset.load_twists();
  ASSERT_EQ(twists.size(), dataset.groundtruth().size());
  const Eigen::Vector3d velocity(plane_.velocity.x(), plane_.velocity.y(), 0);
  for (const StampedTwist& twist : twists) {
    EXPECT_LT((twist.velocity - velocity).norm(), 1e-9);
    EXPECT_LT(twist.angular_velocity.norm(), 1e-12);
  }
  const std::vector<ImuSample> readings = dataset.load_imu();
  const std::vector<ImuTruth> truth = dataset.load_imu_truth();
  ASSERT_EQ(readings.size(), 26U);
  ASSERT_EQ(truth.size(), readings.size());
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_EQ(readings[k].t_ns, truth[k].ideal.t_ns);
    EXPECT_LT((truth[k].ideal.specific_force - Eigen::Vector3d(0, 0, 9.81)).norm(), 1e-8);
    EXPECT_LT((readings[k].specific_force - Eigen::Vector3d(0, 1, 9.81)).norm(), 1e-8);
    EXPECT_NE(readings[k].angular_velocity, truth[k].ideal.angular_velocity);
  }
  EXPECT_EQ(read_imu_yaml(output() / "imu.yaml").gyroscope.density, 0.01);
  EXPECT_TRUE(read_camera_chain(output() / "camera.yaml").front().camera_from_imu.has_value());
}

TEST_F(SimulatePlane, FramesShowTheRadianceAtTheirTime) {
  simulate(config(), output());
  const Dataset dataset = Dataset::open(output());
  const ImageF frame = dataset.load_frame(3);
  const ImageU8 picture = read_image_grey(output() / "images" / "frame_00000003.png");
  for (int y = 0; y < 46; y += 5)
    for (int x = 0; x < 61; x += 5) {
      const Eigen::Vector2d texel = plane_.texel(x, y, 3 / 24.0);
      const double radiance = sample(plane_.texture, texel.x(), texel.y());
      EXPECT_NEAR(frame(x, y), radiance, 1e-5 * radiance);
      EXPECT_EQ(picture(x, y), srgb8_from_linear(static_cast<float>(radiance)));
    }
}

TEST_F(SimulatePlane, ThePanoramaShowsWhatTheFirstFrameShows) {
  simulate(config("groundtruth: {panorama_px_per_rad: 200}\nframes: {rate_hz: 24}\n"), output());
  const Dataset dataset = Dataset::open(output());
  const ImageF image = dataset.load_panorama();
  const Panorama sphere = Panorama::sphere(image.width());
  EXPECT_GE(sphere.pixels_per_radian(), 200);
  const ImageF frame = dataset.load_frame(0);
  const Eigen::Matrix3d turn = dataset.groundtruth().at_clamped(0).rotation_matrix();
  for (int y = 5; y < frame.height(); y += 9)
    for (int x = 5; x < frame.width(); x += 9) {
      const Eigen::Vector2d at = sphere.pixel(turn * dataset.camera().ray({x, y}));
      const double column = std::clamp(at.x(), 0.0, image.width() - 1.0);
      const double row = std::clamp(at.y(), 0.0, image.height() - 1.0);
      EXPECT_NEAR(sample(image, column, row), static_cast<double>(frame(x, y)), 0.01);
    }
  EXPECT_EQ(image(2, image.height() / 2), 0.5F) << "the background beside the camera";
}

TEST_F(SimulatePlane, ThereIsNoPanoramaUnlessItIsAskedFor) {
  simulate(config(), output());
  EXPECT_TRUE(Dataset::open(output()).load_panorama().empty());
}

TEST_F(SimulatePlane, LabelsEveryEvent) {
  simulate(config("groundtruth: {event_labels: true}\n"), output());
  const Dataset dataset = Dataset::open(output());
  const EventLabels labels = dataset.load_labels();
  ASSERT_EQ(labels.size(), dataset.load_events().size());
  ASSERT_GT(labels.size(), 100U);
  const Eigen::Vector2d flow = -100 / plane_.distance_m * plane_.velocity;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    EXPECT_NEAR(labels.depth[i], plane_.distance_m, 1e-6);
    EXPECT_NEAR(labels.flow_x[i], flow.x(), 1e-4);
    EXPECT_NEAR(labels.flow_y[i], flow.y(), 1e-4);
    EXPECT_EQ(labels.object[i], 0);
    EXPECT_EQ(labels.instance[i], 1);
    EXPECT_EQ(labels.class_id[i], 0);
    EXPECT_EQ(labels.origin[i], 0);
  }
  EXPECT_TRUE(verify_hashes(output()).empty());
}

TEST_F(SimulatePlane, WritesMasksBoxesNormalsAndOpticalFlow) {
  SimulationConfig labelled = config(
      "frames: {rate_hz: 20}\ngroundtruth: {masks_rate_hz: 8, normals_rate_hz: 4, "
      "optical_flow_rate_hz: 20}\n");
  labelled.scene.meshes[0].class_name = "wall";
  const SimulationReport report = simulate(labelled, output());
  // Frames at 0, 0.05 ... 0.25 s; at 8 Hz also 0.125 s.
  EXPECT_EQ(report.cameras[0].record.counts->masks, 7);
  EXPECT_EQ(report.cameras[0].record.counts->normal_maps, 6);
  EXPECT_EQ(report.cameras[0].record.counts->optical_flows, 5);
  const LabelRecord record = read_label_record(output() / "labels.yaml");
  ASSERT_EQ(record.classes.size(), 1U);
  EXPECT_EQ(record.classes[0].name, "wall");
  ASSERT_EQ(record.instances.size(), 1U);
  EXPECT_EQ(record.instances[0].class_id, 1);
  const std::vector<StampedFile> masks = read_file_list(output() / "masks.txt");
  ASSERT_EQ(masks.size(), 7U);
  EXPECT_EQ(masks[3].t_s, 0.125);
  EXPECT_EQ(read_mask(masks[3].file).instances, ImageU16(61, 46, 1));
  EXPECT_EQ(read_mask(masks[3].file).classes, ImageU8(61, 46, 1));
  const std::vector<InstanceBox> boxes = read_boxes(output() / "boxes.txt");
  ASSERT_EQ(boxes.size(), 7U);
  EXPECT_EQ(boxes[3], (InstanceBox{0.125, 1, 1, 0, 0, 60, 45, 1}));
  EXPECT_EQ(read_normals(output() / "normals" / "normals_00000000.exr").z, ImageF(61, 46, -1));
  const auto flows = read_optical_flow_list(output() / "optical_flow.txt");
  ASSERT_EQ(flows.size(), 5U);
  const Eigen::Vector2d motion = -100 / plane_.distance_m * plane_.velocity * 0.05;
  const OpticalFlowPair flow = read_optical_flow(flows[2].forward);
  EXPECT_NEAR(flow.forward.u(30, 20), motion.x(), 1.0 / 256 + 1e-6);
  EXPECT_NEAR(flow.backward.v(30, 20), -motion.y(), 1.0 / 256 + 1e-6);
  EXPECT_TRUE(verify_hashes(output()).empty());
}

TEST_F(SimulatePlane, ThereAreNoLabelsUnlessTheyAreAskedFor) {
  simulate(config(), output());
  for (const char* name :
       {"labels.yaml", "masks.txt", "boxes.txt", "normals.txt", "optical_flow.txt"})
    EXPECT_FALSE(fs::exists(output() / name)) << name;
}

TEST_F(SimulatePlane, ExposureAveragesLinearRadiance) {
  simulate(config("frames: {rate_hz: 10, exposure_s: 0.05}\n"), output());
  const ImageF frame = Dataset::open(output()).load_frame(1);
  for (int y = 0; y < 46; y += 5)
    for (int x = 0; x < 61; x += 5) {
      double mean = 0;
      constexpr int kParts = 2000;
      for (int k = 0; k < kParts; ++k) {
        const Eigen::Vector2d texel = plane_.texel(x, y, 0.075 + 0.05 * (k + 0.5) / kParts);
        mean += sample(plane_.texture, texel.x(), texel.y()) / kParts;
      }
      EXPECT_NEAR(frame(x, y), mean, 0.01 * mean);
    }
}

TEST_F(SimulatePlane, TheRadianceMayShowTheInstantBesideAPictureOfTheExposure) {
  simulate(config("frames: {rate_hz: 10}\n"), output("sharp"));
  simulate(config("frames: {rate_hz: 10, exposure_s: 0.05}\n"), output("exposed"));
  simulate(config("frames: {rate_hz: 10, exposure_s: 0.05, radiance: instant}\n"), output("both"));
  const auto bytes = [&](const std::string& dataset, const std::string& type) {
    return testing::read_file(output(dataset) / ("images/frame_00000001." + type));
  };
  EXPECT_EQ(bytes("both", "exr"), bytes("sharp", "exr"));
  EXPECT_EQ(bytes("both", "png"), bytes("exposed", "png"));
  EXPECT_NE(bytes("both", "png"), bytes("sharp", "png"));
}

TEST_F(SimulatePlane, BytesDoNotDependOnTheThreads) {
  std::map<std::string, std::string> first;
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    simulate(config("imu: {rate_hz: 200}\ngroundtruth: {masks_rate_hz: 10, normals_rate_hz: 10, "
                    "optical_flow_rate_hz: 10, event_labels: true}\n"),
             output());
    const auto files = contents(output());
    if (first.empty()) first = files;
    ASSERT_EQ(files.size(), first.size());
    for (const auto& [name, bytes] : files) EXPECT_TRUE(bytes == first[name]) << name;
  }
}

TEST_F(SimulatePlane, CutsThePieceThatIsAskedFor) {
  simulate(config("start_s: 0.05\nduration_s: 0.1\nframes: {rate_hz: 0}\nimu: {rate_hz: 0}\n"),
           output());
  const Dataset dataset = Dataset::open(output());
  EXPECT_EQ(dataset.groundtruth().start_s(), 0);
  EXPECT_NEAR(dataset.groundtruth().end_s(), 0.1, 1e-12);
  EXPECT_TRUE(dataset.frames().empty());
  EXPECT_EQ(dataset.depth_maps().size(), 2U);
  EXPECT_FALSE(fs::exists(output() / "imu.txt"));
}

TEST_F(SimulatePlane, LeavesAForeignFolderAlone) {
  fs::create_directories(output());
  std::ofstream(output() / "thesis.txt") << "mine";
  EXPECT_THROW(simulate(config(), output()), InputError);
  EXPECT_TRUE(fs::exists(output() / "thesis.txt"));
}

TEST_F(SimulatePlane, RefusesWhatCannotBeSimulated) {
  for (const char* bad :
       {"start_s: 0.3\n", "start_s: 0.2\nduration_s: 0.1\n", "events: {samples_per_pixel: 3}\n",
        "events: {contrast_on: 0}\n", "events: {preset: perfect}\n",
        "events: {timestamp_unit: ms}\n", "frames: {rate_hz: -1}\n",
        "groundtruth: {pose_rate_hz: 0}\n", "seeds: 3\n", "duration_s: 0\n"})
    EXPECT_THROW(simulate(config(bad), output()), InputError) << bad;
  EXPECT_FALSE(fs::exists(output()));
}

TEST_F(SimulatePlane, ConfigurationPrintsAndReadsBackTheSame) {
  const std::string text =
      config::print(config("duration_s: 0.1\nevents: {samples_per_pixel: 4}\n"));
  const auto again = config::read<SimulationConfig>(config::parse(text, "printed"));
  EXPECT_EQ(config::print(again), text);
  EXPECT_EQ(again.events.samples_per_pixel, 4);
  EXPECT_EQ(again.camera.cy, 22.5);
}

TEST_F(SimulatePlane, MovingPlaneBeforeACameraAtRest) {
  // What the camera sees is the same when the plane makes the opposite motion instead.
  SimulationConfig moving = config(
      "events: {timestamp_unit: ns}\nstart_s: 0.01\n"
      "frames: {exposure_s: 0.01}\n");
  const Eigen::Vector2d way = plane_.duration_s * plane_.velocity;
  const std::vector<double> rest{plane_.start.x(), plane_.start.y(), 0, 0, 0, 0, 1};
  moving.trajectory.waypoints = {rest, rest};
  moving.trajectory.waypoints[0].insert(moving.trajectory.waypoints[0].begin(), 5);
  moving.trajectory.waypoints[1].insert(moving.trajectory.waypoints[1].begin(), 5.26);
  MotionOptions slide;
  slide.source = MotionSource::kSlider;
  slide.duration_s = 0.25;
  slide.slider.direction = {-way.x(), -way.y(), 0};
  slide.slider.distance_m = way.norm();
  moving.scene.meshes[0].trajectory = slide;
  simulate(moving, output());
  const Dataset dataset = Dataset::open(output());
  const auto match =
      testing::match_exact(plane_.events(0.15, 0.15, 1e-3), dataset.load_events(), 61, 46);
  EXPECT_EQ(match.found, match.expected);
  EXPECT_EQ(match.wrong_pixels, 0U);
  EXPECT_LE(match.p99_us, 1);

  const std::vector<ObjectPose> poses = dataset.load_objects();
  ASSERT_EQ(poses.size(), dataset.groundtruth().size());
  EXPECT_EQ(poses.front().world_from_object.translation().norm(), 0);
  EXPECT_EQ(poses.back().t_s, 0.25);
  EXPECT_LT((poses.back().world_from_object.translation().head<2>() + way).norm(), 1e-9);

  simulate(config("frames: {exposure_s: 0.01}\n"), output("opposite"));
  const Dataset opposite = Dataset::open(output("opposite"));
  EXPECT_TRUE(opposite.load_objects().empty());
  const ImageF a = dataset.load_frame(2);
  const ImageF b = opposite.load_frame(2);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a.pixels()[i], b.pixels()[i], 1e-5);

  set_thread_count(2);
  simulate(moving, output("again"));
  auto files = contents(output());
  for (const auto& [name, bytes] : contents(output("again")))
    EXPECT_TRUE(files[name] == bytes || name == "dataset.yaml") << name;
}

}  // namespace
}  // namespace saccade
