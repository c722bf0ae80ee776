#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/io/dataset/dataset.h"
#include "core/io/events/aedat/aedat4.h"
#include "core/io/images/image_file.h"
#include "core/io/import/public_sequence.h"
#include "core/io/imu_file.h"
#include "core/process/progress.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/shared_data.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;

class Aedat4Import : public ::testing::Test {
 protected:
  Aedat4Import() { set_progress_quiet(true); }
  [[nodiscard]] fs::path out() const { return folder_.path() / "data"; }
  testing::TemporaryFolder folder_;
};

TEST_F(Aedat4Import, ARealRecordingBecomesADatasetWithAllItsStreams) {
  SACCADE_SHARED_DATA_OR_SKIP(file, "formats/evl_sample.aedat4");
  SACCADE_SHARED_DATA_OR_SKIP(reference, "real/evl_davis346");
  const auto sequence = open_public_sequence(file);
  ASSERT_TRUE(sequence);
  const ImportCounts counts = write_as_dataset(*sequence, out());
  EXPECT_EQ(counts.events, 6676U);
  EXPECT_EQ(counts.frames, 4U);
  const Dataset dataset = Dataset::open(out());
  const Dataset expected = Dataset::open(reference);
  EXPECT_EQ(dataset.camera().width, 346);
  // The reference counts from its first event; the recording from 1970.
  const Events events = dataset.load_events();
  const double start_s = seconds_from_ns(events.front().t_ns);
  EXPECT_NEAR(start_s, 1'589'163'147.0, 1);
  EXPECT_EQ(events.size(), expected.load_events().size());
  ASSERT_EQ(dataset.frames().size(), expected.frames().size());
  for (std::size_t i = 0; i < dataset.frames().size(); ++i) {
    EXPECT_NEAR(dataset.frames()[i].t_s - start_s, expected.frames()[i].t_s, 1e-6);
    EXPECT_EQ(read_image_grey(dataset.frames()[i].file),
              read_image_grey(expected.frames()[i].file));
  }
  const std::vector<ImuSample> imu = dataset.load_imu();
  const std::vector<ImuSample> expected_imu = expected.load_imu();
  EXPECT_EQ(imu.size(), counts.imu_samples);
  ASSERT_GE(imu.size(), expected_imu.size());
  std::size_t found = 0;
  for (const ImuSample& sample : expected_imu)
    for (const ImuSample& other : imu)
      if (other.t_ns == sample.t_ns + events.front().t_ns) {
        ++found;
        EXPECT_LT((other.angular_velocity - sample.angular_velocity).norm(), 1e-6);
        // It took g for 9.81 m/s^2, which is 9.80665.
        EXPECT_LT((other.specific_force / 9.80665 - sample.specific_force / 9.81).norm(), 1e-6);
      }
  EXPECT_EQ(found, expected_imu.size());
  EXPECT_EQ(fs::exists(out() / "triggers.txt"), counts.triggers > 0);
}

TEST_F(Aedat4Import, TheCalibrationIsThatOfTheOptionOrBesideTheFile) {
  const fs::path file = folder_.path() / "r.aedat4";
  const auto writer = make_aedat4_writer(file, {}, testing::kSensor);
  writer->append(testing::random_events(100));
  writer->close();
  EXPECT_EQ(open_public_sequence(file)->camera.camera.fx, testing::kSensor.width);
  folder_.write("calib.txt", "200 201 119 90 -0.1 0 0 0 0");
  EXPECT_EQ(open_public_sequence(file)->camera.camera.fy, 201);
  const std::string other =
      "{camera_model: pinhole, intrinsics: [9, 9, 1, 1], distortion_model: "
      "none, resolution: [240, 180]}\n";
  const fs::path chain = folder_.write(
      "chain.yaml",
      "cam0: " + other +
          "cam1: {camera_model: pinhole, intrinsics: [210, 211, 119, 90], distortion_model: "
          "equidistant, distortion_coeffs: [0.01, 0, 0, 0], resolution: [240, 180]}\n");
  const PinholeCamera camera = open_public_sequence(file, chain.string() + "!/cam1")->camera.camera;
  EXPECT_NEAR(camera.fx / camera.fy, 210.0 / 211, 1e-9);
  EXPECT_NE(camera.distortion[0], 0);
  EXPECT_THAT(error_of([&] { return open_public_sequence(file, chain.string() + "!/cam2"); }),
              HasSubstr("cam2 is none of them"));
  folder_.write("calib.txt", "200 201 119");
  EXPECT_THAT(error_of([&] { return open_public_sequence(file); }), HasSubstr("calib.txt:1"));
}

TEST_F(Aedat4Import, DamagedFilesAreReportedOrRead) {
  SACCADE_SHARED_DATA_OR_SKIP(file, "formats/evl_sample.aedat4");
  const std::string bytes = testing::read_file(file);
  // A byte in each packet or so.
  for (std::size_t at = 14; at < bytes.size(); at += bytes.size() / 97) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    const fs::path copy = folder_.write("damaged.aedat4", damaged);
    fs::remove_all(out());
    try {
      const auto sequence = open_public_sequence(copy);
      if (sequence) static_cast<void>(write_as_dataset(*sequence, out()));
    } catch (const InputError& error) {
      EXPECT_THAT(std::string(error.what()), HasSubstr("damaged.aedat4"));
    }
  }
}

}  // namespace
}  // namespace saccade
