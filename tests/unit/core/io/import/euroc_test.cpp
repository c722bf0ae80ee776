#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "core/io/dataset/dataset.h"
#include "core/io/images/image_file.h"
#include "core/io/import/public_sequence.h"
#include "core/process/progress.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;

const Rigid3 kBodyFromCamera(so3_exp({0, 0, 1.5707963267948966}), {0.1, 0.2, 0.3});

Rigid3 body_at(double t_s) { return {so3_exp({0, 0.3 * t_s, 0}), {t_s, 2, 3}}; }

void write_euroc(const testing::TemporaryFolder& folder) {
  folder.write("s/mav0/cam0/sensor.yaml",
               "sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n"
               "  data: [0, -1, 0, 0.1, 1, 0, 0, 0.2, 0, 0, 1, 0.3, 0, 0, 0, 1]\n"
               "rate_hz: 20\nresolution: [8, 6]\ncamera_model: pinhole\n"
               "intrinsics: [10, 11, 3.5, 2.5]\ndistortion_model: radial-tangential\n"
               "distortion_coefficients: [-0.2, 0.05, 0.001, 0.002]\n");
  std::string frames = "#timestamp [ns],filename\n";
  for (int i = 0; i < 3; ++i) {
    const std::string name = fmt::format("{}.png", 1'000'000'000 + 50'000'000 * i);
    frames += fmt::format("{},{}\r\n", 1'000'000'000 + 50'000'000 * i, name);
    folder.write("s/mav0/cam0/data/" + name,
                 encode_png(ImageU8(8, 6, static_cast<std::uint8_t>(50 * i))));
  }
  folder.write("s/mav0/cam0/data.csv", frames);
  std::string imu = "#timestamp [ns],w_RS_S_x [rad s^-1],...\n";
  std::string truth =
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z [], v_RS_R_x [m s^-1]\n";
  for (int i = 0; i < 30; ++i) {
    const std::int64_t t_ns = 990'000'000 + 5'000'000 * i;
    imu += fmt::format("{},0.1,0.2,0.3,1,2,9.8\n", t_ns);
    const Rigid3 body = body_at(1e-9 * static_cast<double>(t_ns));
    const Eigen::Vector3d& t = body.translation();
    const Eigen::Quaterniond& q = body.rotation();
    truth += fmt::format("{},{},{},{},{},{},{},{},0\n", t_ns, t.x(), t.y(), t.z(), q.w(), q.x(),
                         q.y(), q.z());
  }
  folder.write("s/mav0/imu0/data.csv", imu);
  folder.write("s/mav0/state_groundtruth_estimate0/data.csv", truth);
}

TEST(EurocImport, BecomesADatasetWithThePosesOfItsCamera) {
  set_progress_quiet(true);
  const testing::TemporaryFolder folder;
  write_euroc(folder);
  const auto sequence = open_public_sequence(folder.path() / "s");
  ASSERT_TRUE(sequence);
  EXPECT_EQ(sequence->layout, "EuRoC");
  const ImportCounts counts = write_as_dataset(*sequence, folder.path() / "out");
  EXPECT_EQ(counts.events, 0U);
  EXPECT_EQ(counts.frames, 3U);
  const Dataset dataset = Dataset::open(folder.path() / "out");
  EXPECT_EQ(dataset.camera().distortion[3], 0.002);
  ASSERT_EQ(dataset.frames().size(), 3U);
  EXPECT_NEAR(dataset.frames()[1].t_s, 1.05, 1e-9);
  EXPECT_EQ(read_image_grey(dataset.frames()[2].file)(0, 0), 100);
  EXPECT_GT(dataset.groundtruth().size(), 20U);
  for (const StampedPose& pose : dataset.groundtruth().poses())
    EXPECT_LT((pose.world_from_camera.inverse() * body_at(pose.t_s) * kBodyFromCamera).log().norm(),
              1e-8);
  const auto imu = dataset.load_imu();
  ASSERT_EQ(imu.size(), 30U);
  EXPECT_EQ(imu[0].angular_velocity, Eigen::Vector3d(0.1, 0.2, 0.3));
  const auto chain = read_camera_chain(folder.path() / "out/camera.yaml");
  EXPECT_LT((*chain[0].camera_from_imu * kBodyFromCamera).log().norm(), 1e-9);
}

TEST(EurocImport, NamesTheLineOfWhatIsWrong) {
  const testing::TemporaryFolder folder;
  write_euroc(folder);
  folder.write("s/mav0/imu0/data.csv", "#t\n5,0,0,0,0,0,0\n5,0,0,0,0,0,0\n");
  EXPECT_THAT(error_of([&] { return open_public_sequence(folder.path() / "s"); }),
              HasSubstr("data.csv:3: times must increase"));
  folder.write("s/mav0/cam0/sensor.yaml", "T_BS: {data: [1, 2]}\n");
  EXPECT_THAT(error_of([&] { return open_public_sequence(folder.path() / "s"); }),
              HasSubstr("sensor.yaml"));
}

}  // namespace
}  // namespace saccade
