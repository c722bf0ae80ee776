#include "core/io/dataset/dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "core/io/dataset/dataset_writer.h"
#include "core/io/events/events_h5.h"
#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "core/srgb.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/shared_data.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using testing::random_events;
using testing::TemporaryFolder;

const PinholeCamera kCamera{240, 180, 200, 201, 119.5, 89.5, {0.01, -0.02, 1e-4, 2e-4, 0.003}};

/// Writes a complete small dataset and returns the record.
DatasetRecord write_dataset(const fs::path& folder, const DatasetWriterOptions& options = {}) {
  DatasetWriter writer(folder, kCamera, options);
  const Events events = random_events(5000);
  writer.write_events(std::span(events).first(2000));
  writer.write_events(std::span(events).subspan(2000));
  writer.write_frame(1, 0.5, ImageF(240, 180, 0.25F));
  writer.write_frame(0, 0, ImageF(240, 180, 1.5F));
  ImageF depth(240, 180, 2.0F);
  depth(0, 0) = 0;
  writer.write_depth(0, 0, depth);
  writer.write_depth(1, 0.5, ImageF(240, 180, 4.0F));
  writer.write_flow(0, 0, {ImageF(240, 180, 3.0F), ImageF(240, 180, -1.0F)});
  const std::vector<StampedPose> poses{{0, {}}, {0.5, {so3_exp({0.1, 0, 0}), {1, 2, 3}}}};
  writer.write_groundtruth(poses);
  writer.write_imu(std::vector<ImuSample>{{0, {0, 0, 9.81}, {0, 0, 0}}});
  DatasetRecord record;
  record.name = "walls";
  record.seed = 7;
  record.duration_s = 0.5;
  record.contrast_on = 0.15;
  record.contrast_off = 0.2;
  record.log_eps = 0.002;
  record.rays = 10'000;
  record.config_yaml = "scene:\n  background: 0.5\nseed: 7\n";
  return writer.finish(record);
}

class DatasetFolder : public ::testing::Test {
 protected:
  /// A plain recording of 8 x 6 px with two frames of which the second file is absent.
  fs::path plain() {
    folder_.write("plain/events.txt", "0.25 1 2 1\n0.5 7 5 0\n");
    folder_.write("plain/calib.txt", "100 100 4 3 0 0 0 0 0\n");
    folder_.write("plain/images.txt", "0 images/a.png\n1 images/b.png\n");
    folder_.write("plain/groundtruth.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
    write_png(folder_.path() / "plain/images/a.png", ImageU8(8, 6, 128));
    return folder_.path() / "plain";
  }

  TemporaryFolder folder_;
  const fs::path written_ = folder_.path() / "dataset";
};

TEST_F(DatasetFolder, WhatIsWrittenIsRead) {
  write_dataset(written_);
  const Dataset dataset = Dataset::open(written_);
  EXPECT_EQ(dataset.camera(), kCamera);
  EXPECT_EQ(dataset.facts().name, "walls");
  EXPECT_EQ(dataset.facts().contrast_on, 0.15);
  EXPECT_EQ(dataset.facts().contrast_off, 0.2);
  EXPECT_EQ(dataset.facts().log_eps, 0.002);
  EXPECT_EQ(dataset.groundtruth().size(), 2U);
  ASSERT_EQ(dataset.frames().size(), 2U);
  EXPECT_EQ(dataset.frames()[1].t_s, 0.5);
  EXPECT_EQ(dataset.load_frame(0)(5, 5), 1.5F);  // from the EXR: a PNG would end at 1
  EXPECT_EQ(read_image_grey(dataset.frames()[1].file)(0, 0), srgb8_from_linear(0.25F));
  EXPECT_EQ(dataset.load_depth(1)(9, 9), 4);
  EXPECT_EQ(dataset.load_flow(0).v(3, 3), -1);
  EXPECT_TRUE(dataset.has_imu());
  EXPECT_EQ(dataset.load_imu()[0].specific_force.z(), 9.81);
  EXPECT_EQ(dataset.load_events().size(), 5000U);
}

TEST_F(DatasetFolder, MeanDepthIsOverValidPixelsOfAllMaps) {
  const DatasetRecord record = write_dataset(written_);
  const double pixels = 240 * 180;
  const double expected = (2 * (pixels - 1) + 4 * pixels) / (2 * pixels - 1);
  EXPECT_NEAR(*record.mean_scene_depth_m, expected, 1e-12);
  EXPECT_NEAR(*Dataset::open(written_).facts().mean_depth_m, expected, 1e-12);
}

TEST_F(DatasetFolder, RecordSurvivesTheRoundTrip) {
  const DatasetRecord record = write_dataset(written_);
  const DatasetRecord read = *Dataset::open(written_).record();
  EXPECT_EQ(read.seed, 7U);
  EXPECT_EQ(read.counts->events_on + read.counts->events_off, 5000);
  EXPECT_EQ(read.counts->frames, 2);
  EXPECT_EQ(read.counts->depth_maps, 2);
  EXPECT_EQ(read.counts->imu_samples, 1);
  EXPECT_EQ(read.rays_per_event, 2);
  EXPECT_EQ(read.duration_s, 0.5);
  EXPECT_EQ(read.sha256, record.sha256);
  EXPECT_THAT(read.tool_version, HasSubstr("saccade "));
  EXPECT_THAT(read.config_yaml, HasSubstr("background: 0.5"));
  EXPECT_TRUE(read.sha256.contains("images/frame_00000001.exr"));
}

TEST_F(DatasetFolder, TextEventsBesideHdf5AreTheSame) {
  write_dataset(written_, {.timestamp_unit = TimestampUnit::kNanoseconds, .events_text = true});
  const Events h5 = read_events(written_ / "events.h5", {});
  EXPECT_EQ(read_events(written_ / "events.txt", {}), h5);
}

/// Labels that tell every event by its index.
EventLabels numbered_labels(std::size_t count) {
  EventLabels labels;
  labels.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    labels.depth[i] = 0.5F * static_cast<float>(i);
    labels.flow_x[i] = -static_cast<float>(i);
    labels.flow_y[i] = 3;
    labels.object[i] = static_cast<std::int32_t>(i % 7) - 1;
    labels.instance[i] = static_cast<std::uint16_t>(i % 65536);
    labels.class_id[i] = static_cast<std::uint8_t>(i % 5);
    labels.origin[i] = static_cast<std::uint8_t>(i % 4);
  }
  return labels;
}

TEST_F(DatasetFolder, LabelsBelongToTheEvents) {
  const std::size_t count = 200'000;  // several chunks
  {
    DatasetWriter writer(written_, kCamera);
    writer.write_events(random_events(count));
    LabelsH5Writer labels(written_ / "labels.h5");
    labels.append(numbered_labels(count));
    labels.close();
    (void)writer.finish({});
  }
  const Dataset dataset = Dataset::open(written_);
  ASSERT_TRUE(dataset.has_labels());
  const EventLabels expected = numbered_labels(count);
  const EventLabels all = dataset.load_labels();
  EXPECT_EQ(all.depth, expected.depth);
  EXPECT_EQ(all.flow_x, expected.flow_x);
  EXPECT_EQ(all.flow_y, expected.flow_y);
  EXPECT_EQ(all.object, expected.object);
  EXPECT_EQ(all.origin, expected.origin);
  EXPECT_EQ(all.instance, expected.instance);
  EXPECT_EQ(all.class_id, expected.class_id);
  const double middle_s = seconds_from_ns(dataset.load_events()[count / 2].t_ns);
  const std::size_t before = dataset.load_events(0, middle_s).size();
  const EventLabels late = dataset.load_labels(middle_s);
  ASSERT_EQ(late.size(), count - before);
  EXPECT_EQ(late.depth.front(), expected.depth[before]);
}

TEST_F(DatasetFolder, LabelsOfEarlierVersionsHaveObjectsForInstances) {
  {
    DatasetWriter writer(written_, kCamera);
    writer.write_events(random_events(10));
    const EventLabels labels = numbered_labels(10);
    const std::vector<H5Source> columns{
        h5_source("depth", labels.depth), h5_source("flow_x", labels.flow_x),
        h5_source("flow_y", labels.flow_y), h5_source("object", labels.object),
        h5_source("origin", labels.origin)};
    H5TableWriter table(written_ / "labels.h5", "labels", columns);
    table.append(columns);
    table.close();
    (void)writer.finish({});
  }
  const EventLabels labels = Dataset::open(written_).load_labels();
  EXPECT_EQ(labels.instance, (std::vector<std::uint16_t>{0, 1, 2, 3, 4, 5, 6, 0, 1, 2}));
  EXPECT_EQ(labels.class_id, std::vector<std::uint8_t>(10));
}

TEST_F(DatasetFolder, LabelsOfOtherEventsAreAnError) {
  write_dataset(written_);
  const auto load = [&] { return Dataset::open(written_).load_labels(); };
  EXPECT_THAT(error_of(load), HasSubstr("labels.h5: no such file"));
  LabelsH5Writer labels(written_ / "labels.h5");
  labels.append(numbered_labels(10));
  labels.close();
  EXPECT_THAT(error_of(load), HasSubstr("/labels/depth: has 10 entries for 5000 events"));
  std::ofstream(written_ / "labels.h5") << "text";
  EXPECT_THAT(error_of(load), HasSubstr("labels.h5: is no HDF5 file"));
}

TEST_F(DatasetFolder, HashesFindWhatChanged) {
  write_dataset(written_);
  EXPECT_TRUE(verify_hashes(written_).empty());
  std::ofstream(written_ / "calib.txt", std::ios::app) << "\n";
  std::ofstream(written_ / "new.txt") << "x";
  fs::remove(written_ / "depth.txt");
  EXPECT_THAT(verify_hashes(written_), ElementsAre("calib.txt: changed", "depth.txt: missing",
                                                   "new.txt: not listed in dataset.yaml"));
  EXPECT_THAT(error_of([&] { return verify_hashes(plain()); }), HasSubstr("dataset.yaml"));
}

TEST_F(DatasetFolder, TakesUpImagesThatAreComplete) {
  const DatasetRecord record = write_dataset(written_);
  write_exr(written_ / "depth/depth_00000002.exr", ImageF(2, 2, 1.0F), "Z");
  std::ofstream(written_ / "images/frame_00000001.png") << "damaged";
  DatasetWriter writer(written_, kCamera);
  EXPECT_TRUE(writer.take_up_frame(0, 0));
  EXPECT_FALSE(writer.take_up_frame(1, 0.5));
  EXPECT_TRUE(writer.take_up_depth(0, 0));
  EXPECT_TRUE(writer.take_up_depth(1, 0.5));
  EXPECT_FALSE(writer.take_up_depth(2, 1));  // of another size
  EXPECT_TRUE(writer.take_up_flow(0, 0));
  EXPECT_FALSE(writer.take_up_flow(1, 0.5));
  const DatasetRecord again = writer.finish({});
  EXPECT_EQ(again.mean_scene_depth_m, record.mean_scene_depth_m);
  EXPECT_EQ(again.counts->depth_maps, 2);
  EXPECT_EQ(again.counts->frames, 1);
}

TEST_F(DatasetFolder, HashesReachIntoTheFoldersOfARig) {
  write_dataset(written_ / "cam1");
  write_dataset(written_);
  EXPECT_TRUE(verify_hashes(written_).empty());
  EXPECT_TRUE(verify_hashes(written_ / "cam1").empty());
  std::ofstream(written_ / "cam1/dataset.yaml", std::ios::app) << "\n";
  fs::remove(written_ / "cam1/events.h5");
  EXPECT_THAT(verify_hashes(written_),
              ElementsAre("cam1/dataset.yaml: changed", "cam1/events.h5: missing"));
}

TEST_F(DatasetFolder, PlainRecording) {
  const Dataset dataset = Dataset::open(plain());
  EXPECT_EQ(dataset.camera().width, 8);
  EXPECT_EQ(dataset.camera().height, 6);
  EXPECT_EQ(dataset.facts().name, "plain");
  EXPECT_FALSE(dataset.facts().mean_depth_m);
  EXPECT_FALSE(dataset.record());
  EXPECT_EQ(dataset.load_events(0.3, 0.6), (Events{{500'000'000, 7, 5, -1}}));
  EXPECT_EQ(dataset.load_events(0.25, 0.5).size(), 1U);
  EXPECT_NEAR(dataset.load_frame(0)(0, 0), linear_from_srgb(128 / 255.0), 1e-6);
  EXPECT_THAT(error_of([&] { return dataset.load_frame(1); }),
              HasSubstr("images/b.png: no such file"));
}

TEST_F(DatasetFolder, StatedSensorSizeWins) {
  plain();
  folder_.write("plain/dataset.yaml", "format_version: 1\nwidth: 320\nheight: 240\n");
  EXPECT_EQ(Dataset::open(folder_.path() / "plain").camera().width, 320);
  EXPECT_THAT(error_of([&] { return Dataset::open(folder_.path() / "plain").load_frame(0); }),
              HasSubstr("a.png: is 8 x 6 px, the sensor 320 x 240"));
}

TEST_F(DatasetFolder, EventOutsideTheSensor) {
  plain();
  folder_.write("plain/events.txt", "0.25 1 2 1\n0.5 8 5 0\n");
  EXPECT_THAT(error_of([&] { return Dataset::open(folder_.path() / "plain").load_events(); }),
              HasSubstr("events.txt:2: x = 8 lies outside the sensor; it must be 0 ... 7"));
}

TEST_F(DatasetFolder, UnknownSensorSizeIsAnError) {
  fs::remove(plain() / "images/a.png");
  EXPECT_THAT(error_of([&] { return Dataset::open(folder_.path() / "plain"); }),
              HasSubstr("the sensor size is unknown"));
}

TEST_F(DatasetFolder, EventsMayStateTheSensor) {
  fs::remove(plain() / "images/a.png");
  fs::remove(folder_.path() / "plain/events.txt");
  const auto writer =
      make_event_writer(folder_.path() / "plain/events.h5", TimestampUnit::kMicroseconds, {8, 6});
  writer->append(Events{{1000, 7, 5, 1}});
  writer->close();
  const Dataset data = Dataset::open(folder_.path() / "plain");
  EXPECT_EQ(data.camera().width, 8);
  EXPECT_EQ(data.camera().height, 6);
}

TEST_F(DatasetFolder, MissingFolderFilesAndCalibration) {
  EXPECT_THAT(error_of([&] { return Dataset::open(folder_.path() / "no"); }),
              HasSubstr("no such dataset folder"));
  EXPECT_THAT(error_of([&] { return Dataset::open(folder_.path()); }), HasSubstr("is no dataset"));
  fs::remove(plain() / "calib.txt");
  EXPECT_THAT(error_of([&] { return Dataset::open(folder_.path() / "plain"); }),
              HasSubstr("neither calib.txt nor camera.yaml"));
  plain();
  fs::remove(folder_.path() / "plain/events.txt");
  EXPECT_THAT(error_of([&] { return Dataset::open(folder_.path() / "plain").load_events(); }),
              HasSubstr("holds no events"));
}

TEST_F(DatasetFolder, RecordErrorsNameTheLine) {
  plain();
  const auto error = [&](const std::string& text) {
    folder_.write("plain/dataset.yaml", text);
    return error_of([&] { return Dataset::open(folder_.path() / "plain"); });
  };
  EXPECT_THAT(error("format_version: 2\nwidth: 8\nheight: 6\n"), HasSubstr("dataset.yaml:1"));
  EXPECT_THAT(error("format_version: 1\nwidth: 0\nheight: 6\n"), HasSubstr("dataset.yaml:2"));
  EXPECT_THAT(error("format_version: 1\nwidth: 8\n"), HasSubstr("height"));
  EXPECT_THAT(error("format_version: 1\nwidth: 8\nheight: 6\ncontrast: 1\n"),
              HasSubstr("dataset.yaml:4"));
}

TEST_F(DatasetFolder, NonFinitePicturesAreErrors) {
  write_dataset(written_);
  ImageF broken(240, 180, 1.0F);
  broken(3, 3) = std::numeric_limits<float>::quiet_NaN();
  write_exr(written_ / "images/frame_00000000.exr", broken, "Y");
  write_exr(written_ / "depth/depth_00000000.exr", broken, "Z");
  const Dataset dataset = Dataset::open(written_);
  EXPECT_THAT(error_of([&] { return dataset.load_frame(0); }), HasSubstr("no number"));
  EXPECT_THAT(error_of([&] { return dataset.load_depth(0); }), HasSubstr("depth_00000000.exr"));
}

TEST_F(DatasetFolder, RealRecording) {
  SACCADE_SHARED_DATA_OR_SKIP(folder, "slider_depth");
  const Dataset dataset = Dataset::open(folder);
  EXPECT_EQ(dataset.camera().width, 240);
  EXPECT_EQ(dataset.camera().height, 180);
  EXPECT_TRUE(dataset.camera().is_distorted());
  EXPECT_EQ(dataset.groundtruth().size(), 339U);
  EXPECT_EQ(dataset.frames().size(), 87U);
  const Events events = dataset.load_events();
  ASSERT_EQ(events.size(), 50'000U);
  EXPECT_EQ(events.front().t_ns, 3'811'000);
  EXPECT_NEAR(seconds_from_ns(events.back().t_ns), 0.1742, 1e-4);
  EXPECT_EQ(dataset.load_frame(1).width(), 240);
}

}  // namespace
}  // namespace saccade
