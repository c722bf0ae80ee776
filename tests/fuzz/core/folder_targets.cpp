// Folders and recordings that are read as a whole: datasets, and the layouts of others.

#include "tests/fuzz/core/core_targets.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/io/dataset/dataset.h"
#include "core/io/dataset/dataset_writer.h"
#include "core/io/images/png_file.h"
#include "core/io/import/public_sequence.h"
#include "core/io/import/ros_recording.h"
#include "tests/unit/core/io/events/random_events.h"
#include "tests/unit/core/io/ros/bag_bytes.h"

namespace saccade::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr PinholeCamera kCamera{12, 8, 20, 20, 5.5, 3.5, {}};

void write_dataset(const fs::path& folder) {
  DatasetWriter writer(folder, kCamera);
  writer.write_events(std::vector<Event>{{1000, 1, 2, 1}, {2000, 3, 4, -1}});
  writer.write_frame(0, 0, ImageF(kCamera.width, kCamera.height, 0.5F));
  writer.write_depth(0, 0, ImageF(kCamera.width, kCamera.height, 2));
  writer.write_groundtruth(std::vector<StampedPose>{{0, Rigid3()}, {0.5, Rigid3()}});
  writer.write_imu(std::vector<ImuSample>(1));
  static_cast<void>(writer.finish({}));
}

void decode_dataset(const fs::path& folder, const std::string& /*file*/) {
  const Dataset dataset = Dataset::open(folder);
  static_cast<void>(dataset.load_events());
  for (std::size_t i = 0; i < dataset.frames().size() && i < 2; ++i)
    static_cast<void>(dataset.load_frame(i));
  for (std::size_t i = 0; i < dataset.depth_maps().size() && i < 2; ++i)
    static_cast<void>(dataset.load_depth(i));
  if (dataset.has_imu()) static_cast<void>(dataset.load_imu());
  static_cast<void>(dataset.camera_from_imu());
}

void write_euroc(const fs::path& folder) {
  fs::create_directories(folder / "mav0/cam0/data");
  fs::create_directories(folder / "mav0/imu0");
  fs::create_directories(folder / "mav0/state_groundtruth_estimate0");
  write_bytes(
      folder / "mav0/cam0/sensor.yaml",
      "sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [0, -1, 0, 0.1, 1, 0, 0, 0.2, 0, "
      "0, 1, 0.3, 0, 0, 0, 1]\nrate_hz: 20\nresolution: [8, 6]\ncamera_model: pinhole\n"
      "intrinsics: [10, 11, 3.5, 2.5]\ndistortion_model: radial-tangential\n"
      "distortion_coefficients: [-0.2, 0.05, 0.001, 0.002]\n");
  write_bytes(folder / "mav0/cam0/data/1.png", encode_png(ImageU8(8, 6, 50)));
  write_bytes(folder / "mav0/cam0/data.csv", "#timestamp [ns],filename\n1000000000,1.png\n");
  std::string imu = "#timestamp [ns],w_RS_S_x [rad s^-1],...\n";
  std::string truth =
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z []\n";
  for (int i = 0; i < 5; ++i) {
    imu += fmt::format("{},0.1,0.2,0.3,1,2,9.8\n", 990'000'000 + 5'000'000 * i);
    truth += fmt::format("{},{},2,3,1,0,0,0\n", 990'000'000 + 5'000'000 * i, i);
  }
  write_bytes(folder / "mav0/imu0/data.csv", imu);
  write_bytes(folder / "mav0/state_groundtruth_estimate0/data.csv", truth);
}

void decode_sequence(const fs::path& folder, const std::string& /*file*/) {
  const auto sequence = open_public_sequence(folder);
  if (!sequence) throw InputError(folder.string(), "has no known layout");
  if (!sequence->frame_times_s.empty()) static_cast<void>(sequence->load_frame(0));
}

std::string stamp(std::uint32_t ns) {
  return testing::bytes_of(std::uint32_t{0}, std::uint32_t{0}, ns) + testing::sized("frame");
}

std::string numbers(std::initializer_list<double> values) {
  std::string bytes;
  for (const double value : values) bytes += testing::bytes_of(value);
  return bytes;
}

void write_recording(const fs::path& folder) {
  using namespace testing;
  std::string picture = stamp(5000) + bytes_of(std::uint32_t{4}, std::uint32_t{6}) +
                        sized("mono8") + bytes_of(std::uint8_t{0}, std::uint32_t{6}) +
                        sized(std::string(24, 'x'));
  std::string info = stamp(0) + bytes_of(std::uint32_t{180}, std::uint32_t{240}) +
                     sized("plumb_bob") + bytes_of(std::uint32_t{5}) +
                     numbers({-0.3, 0.1, 0, 0, 0.01}) +
                     numbers({200, 0, 119.5, 0, 201, 89.5, 0, 0, 1});
  const Events events = random_events(10, 1'000'000);
  write_bytes(
      folder / "r.bag",
      kBagHead +
          bag_chunk("none", bag_connection(0, "/dvs/events", "dvs_msgs/EventArray") +
                                bag_connection(1, "/pose", "geometry_msgs/PoseStamped") +
                                bag_connection(2, "/dvs/image", "sensor_msgs/Image") +
                                bag_connection(3, "/dvs/info", "sensor_msgs/CameraInfo") +
                                bag_message(0, event_array(events)) +
                                bag_message(1, stamp(1000) + numbers({1, 2, 3, 0, 0, 0, 1})) +
                                bag_message(3, info) + bag_message(2, picture)));
}

void decode_recording(const fs::path& folder, const std::string& file) {
  if (!is_ros_recording(folder / file)) throw InputError(file, "is no recording");
  static_cast<void>(write_ros_recording(folder / file, folder / "out"));
}

}  // namespace

std::vector<Target> folder_targets() {
  return {
      {"dataset",
       {"dataset.yaml", "calib.txt", "camera.yaml", "groundtruth.txt", "images.txt", "depth.txt",
        "imu.txt", "images/frame_00000000.exr", "depth/depth_00000000.exr"},
       decode_dataset,
       write_dataset,
       {"../../", "width: 100000", "1e308", "nan", "mean_scene_depth_m: ", "T_cam_imu"}},
      {"euroc",
       {"mav0/cam0/sensor.yaml", "mav0/cam0/data.csv", "mav0/imu0/data.csv",
        "mav0/state_groundtruth_estimate0/data.csv", "mav0/cam0/data/1.png"},
       decode_sequence,
       write_euroc,
       {"../", "nan", "1e308", "equidistant", "resolution: [100000, 100000]"}},
      {"ros-recording",
       {"r.bag"},
       decode_recording,
       write_recording,
       {"bayer_rggb8", "32FC1", "16UC1", "bgr8", "equidistant", "sensor_msgs/CompressedImage",
        "tf2_msgs/TFMessage", "nav_msgs/Odometry"}},
  };
}

}  // namespace saccade::fuzz
