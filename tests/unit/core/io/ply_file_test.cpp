#include "core/io/ply_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

class PlyFile : public ::testing::Test {
 protected:
  std::string error(const std::string& text) {
    return error_of([&] { return read_ply(folder_.write("c.ply", text)); });
  }

  TemporaryFolder folder_;
};

TEST_F(PlyFile, RoundTripWithAllAttributes) {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}, {-0.1F, 1e-20F, 1e20F}};
  cloud.normals = {{0, 0, 1}, {1, 0, 0}};
  cloud.colours = {{255, 0, 7}, {1, 2, 3}};
  cloud.scalars = {{"sigma", {0.5F, 0.25F}}, {"age", {1, 2}}};
  write_ply(folder_.path() / "c.ply", cloud);
  const PointCloud read = read_ply(folder_.path() / "c.ply");
  EXPECT_EQ(read.positions, cloud.positions);
  EXPECT_EQ(read.normals, cloud.normals);
  EXPECT_EQ(read.colours, cloud.colours);
  ASSERT_EQ(read.scalars.size(), 2U);
  EXPECT_EQ(read.scalars[1].name, "age");
  EXPECT_EQ(read.scalars[0].values, cloud.scalars[0].values);
}

TEST_F(PlyFile, PositionsAlone) {
  PointCloud cloud;
  write_ply(folder_.path() / "c.ply", cloud);
  EXPECT_TRUE(read_ply(folder_.path() / "c.ply").positions.empty());
  cloud.positions = {{1, 2, 3}};
  write_ply(folder_.path() / "c.ply", cloud);
  EXPECT_TRUE(read_ply(folder_.path() / "c.ply").colours.empty());
}

TEST_F(PlyFile, ReadsAsciiWithFurtherElements) {
  const PointCloud cloud = read_ply(folder_.write(
      "c.ply",
      "ply\r\nformat ascii 1.0\ncomment by hand\nelement vertex 2\nproperty double x\n"
      "property double y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "1 2 3 10 20 30\n4 5 6 40 50 60\n3 0 1 0\n"));
  EXPECT_EQ(cloud.positions[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(cloud.colours[0], (Rgb8{10, 20, 30}));
}

TEST_F(PlyFile, ErrorsNameTheLine) {
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex 100\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  EXPECT_THAT(error("obj\n"), HasSubstr("c.ply:1: a PLY file starts"));
  EXPECT_THAT(error(head), HasSubstr("the header has no end_header"));
  EXPECT_THAT(error(head + "property float x\nend_header\n"), HasSubstr("need properties x, y"));
  EXPECT_THAT(error(head + xyz + "end_header\n0123"), HasSubstr("c.ply: is truncated"));
  EXPECT_THAT(error("ply\nformat binary_big_endian 1.0\n"), HasSubstr("c.ply:2: format"));
  EXPECT_THAT(error(head + "property quad x\n"), HasSubstr("c.ply:4: 'quad' is no PLY type"));
  EXPECT_THAT(error("ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "end_header\n1 2\n"),
              HasSubstr("c.ply:8: z: expected a number"));
  EXPECT_THAT(error("ply\nformat ascii 1.0\nelement vertex 2\n" + xyz + "end_header\n1 2 3\n"),
              HasSubstr("is truncated"));
  EXPECT_THAT(error(""), HasSubstr("c.ply"));
  EXPECT_THAT(error(head + xyz + "property float x\n"),
              HasSubstr("c.ply:7: property 'x' is stated"));
}

TEST_F(PlyFile, ColoursOfOtherTypesStayWithinAByte) {
  const auto cloud = read_ply(folder_.write(
      "c.ply",
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
      "float z\nproperty float red\nproperty double green\nproperty int blue\nend_header\n1 2 3 "
      "-2.5 1e300 7\n"));
  EXPECT_THAT(cloud.colours.at(0), ::testing::ElementsAre(0, 255, 7));
}

TEST_F(PlyFile, ACountThatTheFileCannotHoldTakesNoMemory) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  std::string many;
  for (int i = 0; i < 900; ++i) many += "property double p" + std::to_string(i) + "\n";
  for (const char* format : {"ascii", "binary_little_endian"})
    for (const char* count : {"100000", "4294967296", "18446744073709551615"})
      EXPECT_THAT(error(std::string("ply\nformat ") + format + " 1.0\nelement vertex " + count +
                        "\n" + xyz + many + "end_header\n" + std::string(200'000, '1')),
                  HasSubstr("is truncated"))
          << format << " " << count;
}

}  // namespace
}  // namespace saccade
