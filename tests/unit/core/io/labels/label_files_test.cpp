#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/io/labels/box_file.h"
#include "core/io/labels/label_images.h"
#include "core/io/labels/label_record.h"
#include "core/io/labels/optical_flow_file.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

class LabelFiles : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path write(const std::string& name,
                                            const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
    return folder_.path() / name;
  }
  TemporaryFolder folder_;
};

TEST_F(LabelFiles, TheRecordComesBack) {
  const std::filesystem::path file = folder_.path() / "labels.yaml";
  const LabelRecord written{{{1, "chair"}, {2, "a table: round"}},
                            {{1, "room", 0, 0, "room.obj"}, {2, "duck/leg #1", 2, 3, "a!/b.obj"}}};
  write_label_record(file, written);
  const LabelRecord read = read_label_record(file);
  ASSERT_EQ(read.classes.size(), 2U);
  EXPECT_EQ(read.classes[1].name, "a table: round");
  ASSERT_EQ(read.instances.size(), 2U);
  EXPECT_EQ(read.instances[1].name, "duck/leg #1");
  EXPECT_EQ(read.instances[1].class_id, 2);
  EXPECT_EQ(read.instances[1].object, 3);
  EXPECT_EQ(read.instances[1].file, "a!/b.obj");
}

TEST_F(LabelFiles, MalformedRecordsAreErrorsWithTheirPlace) {
  const auto error = [&](const std::string& text) {
    return error_of([&] { return read_label_record(write("labels.yaml", text)); });
  };
  EXPECT_THAT(error("classes: [{id: 2, name: a}]\n"), HasSubstr("must have the ids 1, 2, 3"));
  EXPECT_THAT(error("instances: [{id: 1, class: 1}]\n"), HasSubstr("a class that is not listed"));
  EXPECT_THAT(error("instances: [{id: 1, clas: 0}]\n"), HasSubstr("did you mean 'class'?"));
  EXPECT_THAT(error("instances: [{id: 70000}]\n"), HasSubstr("labels.yaml:1"));
}

TEST_F(LabelFiles, BoxesComeBack) {
  const std::filesystem::path file = folder_.path() / "boxes.txt";
  const std::vector<InstanceBox> written{{0, 1, 0, 0, 0, 239, 179, 0.75},
                                         {0, 65535, 255, 3, 4, 3, 4, 1},
                                         {0.041666667, 1, 0, 1, 2, 3, 4, 0.5}};
  write_boxes(file, written);
  EXPECT_EQ(read_boxes(file), written);
}

TEST_F(LabelFiles, MalformedBoxesAreErrorsWithTheirPlace) {
  const auto error = [&](const std::string& text) {
    return error_of([&] { return read_boxes(write("boxes.txt", text)); });
  };
  EXPECT_THAT(error("0 1 0 0 0 5 5\n"), HasSubstr("boxes.txt:1"));
  EXPECT_THAT(error("# t\n0 0 0 0 0 5 5 1\n"), HasSubstr("boxes.txt:2: instance is 0"));
  EXPECT_THAT(error("0 1 256 0 0 5 5 1\n"), HasSubstr("class is 256"));
  EXPECT_THAT(error("0 1 0 6 0 5 5 1\n"), HasSubstr("x1 is 5, must be within [6, 65534]"));
  EXPECT_THAT(error("0 1 0 0 0 5 5 0\n"), HasSubstr("must be above 0"));
  EXPECT_THAT(error("0 2 0 0 0 5 5 1\n0 1 0 0 0 5 5 1\n"), HasSubstr("in order of time"));
}

TEST_F(LabelFiles, MasksAndNormalsComeBackWithTheirLists) {
  InstanceMask mask{ImageU16(5, 3), ImageU8(5, 3)};
  mask.instances(4, 2) = 65535;
  mask.instances(1, 0) = 258;
  mask.classes(4, 2) = 255;
  NormalMap normals{ImageF(5, 3, 0.25F), ImageF(5, 3, -0.5F), ImageF(5, 3, -1)};
  LabelImageWriter writer(folder_.path());
  writer.write_mask(1, 0.5, mask);
  writer.write_mask(0, 0.25, mask);
  writer.write_normals(0, 0.25, normals);
  writer.finish();
  const std::vector<StampedFile> list = read_file_list(folder_.path() / "masks.txt");
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[1].t_s, 0.5);
  const InstanceMask read = read_mask(list[1].file);
  EXPECT_EQ(read.instances, mask.instances);
  EXPECT_EQ(read.classes, mask.classes);
  const NormalMap map = read_normals(read_file_list(folder_.path() / "normals.txt")[0].file);
  EXPECT_EQ(map.x, normals.x);
  EXPECT_EQ(map.y, normals.y);
  EXPECT_EQ(map.z, normals.z);
  EXPECT_THAT(error_of([&] { return read_image_u16(folder_.path() / "masks/class_00000000.png"); }),
              HasSubstr("is no picture of one channel of 16 bits"));
  EXPECT_THAT(error_of([&] { return read_mask(folder_.path() / "masks/class_00000000.png"); }),
              HasSubstr("instance_NNNNNNNN.png"));
}

TEST(OpticalFlowFile, CodesAreThoseOfDsec) {
  OpticalFlow flow{ImageF(4, 1), ImageF(4, 1), ImageU8(4, 1, 1), ImageU8(4, 1)};
  flow.u(0, 0) = 1;
  flow.v(0, 0) = -2.5F;
  flow.u(1, 0) = 255.9921875F;  // the largest that fits
  flow.v(1, 0) = -256;
  flow.u(2, 0) = 256;
  flow.is_valid(3, 0) = 0;
  const ImageRgb16 codes = dsec_codes(flow);
  EXPECT_EQ(codes(0, 0), (Rgb16{32768 + 128, 32768 - 320, 1}));
  EXPECT_EQ(codes(1, 0), (Rgb16{65535, 0, 1}));
  EXPECT_EQ(codes(2, 0), (Rgb16{0, 0, 0}));
  EXPECT_EQ(codes(3, 0), (Rgb16{0, 0, 0}));
  const OpticalFlow back = flow_from_dsec_codes(codes);
  EXPECT_EQ(back.u(1, 0), flow.u(1, 0));
  EXPECT_EQ(back.v(0, 0), -2.5F);
  EXPECT_EQ(back.is_valid(2, 0), 0);
}

TEST_F(LabelFiles, OpticalFlowComesBackWithItsList) {
  OpticalFlow flow{ImageF(4, 3, 1.5F), ImageF(4, 3, -3), ImageU8(4, 3, 1), ImageU8(4, 3)};
  flow.covisibility(2, 1) = static_cast<std::uint8_t>(Covisibility::kOccluded);
  OpticalFlow back = flow;
  back.u.fill(-1.5F);
  OpticalFlowWriter writer(folder_.path());
  writer.write(0, 0, 0.05, {flow, back});
  writer.finish();
  const auto list = read_optical_flow_list(folder_.path() / "optical_flow.txt");
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].to_s, 0.05);
  const OpticalFlowPair read = read_optical_flow(list[0].forward);
  EXPECT_EQ(read.forward.u, flow.u);
  EXPECT_EQ(read.forward.v, flow.v);
  EXPECT_EQ(read.forward.covisibility, flow.covisibility);
  EXPECT_EQ(read.backward.u, back.u);
  const auto error = [&](const std::string& text) {
    return error_of([&] { return read_optical_flow_list(write("list.txt", text)); });
  };
  EXPECT_THAT(error("0 0 a.png\n"), HasSubstr("list.txt:1: the interval is empty"));
  EXPECT_THAT(error("0 1 a.png\n0 2 b.png\n"), HasSubstr("list.txt:2: times must increase"));
}

}  // namespace
}  // namespace saccade
