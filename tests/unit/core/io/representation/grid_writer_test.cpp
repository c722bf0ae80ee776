#include "core/io/representation/grid_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <cstring>

#include "core/io/images/image_file.h"
#include "core/io/tables/h5_handle.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

const GridShape kShape{"event_frame", 2, 2, 3, 4};

EventGrid numbered(float first) {
  EventGrid grid(kShape.size());
  for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = first + static_cast<float>(i);
  return grid;
}

void write_two(GridWriter& writer) {
  writer.append(numbered(0), {0, 50'000'000, 0, 10});
  writer.append(numbered(240), {50'000'000, 100'000'000, 10, 13});
  writer.close();
}

TEST(GridWriter, Hdf5HoldsTheArrayAndItsWindows) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "grids.h5";
  write_two(*make_grid_writer(file, kShape, 1));
  const H5Lock lock;
  const H5Handle h5 = {H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  ASSERT_TRUE(h5.valid());
  const auto read = [&](const char* name, hid_t type, void* values) {
    const H5Handle dataset = {H5Dopen2(h5, name, H5P_DEFAULT), H5Dclose};
    EXPECT_GE(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), 0) << name;
  };
  std::array<float, 48> values{};
  read("event_frame", H5T_NATIVE_FLOAT, values.data());
  EXPECT_EQ(values[23], 23);
  EXPECT_EQ(values[24], 240);
  std::array<double, 2> to{};
  read("to", H5T_NATIVE_DOUBLE, to.data());
  EXPECT_EQ(to[1], 0.1);
  std::array<std::uint64_t, 2> events{};
  read("events", H5T_NATIVE_UINT64, events.data());
  EXPECT_EQ(events[1], 3U);
  const H5Handle dataset = {H5Dopen2(h5, "event_frame", H5P_DEFAULT), H5Dclose};
  const H5Handle space = {H5Dget_space(dataset), H5Sclose};
  std::array<hsize_t, 4> size{};
  H5Sget_simple_extent_dims(space, size.data(), nullptr);
  EXPECT_EQ(size, (std::array<hsize_t, 4>{2, 2, 3, 4}));
}

TEST(GridWriter, NpyIsAHeaderOfAMultipleOf64BytesAndTheValues) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "grids.npy";
  write_two(*make_grid_writer(file, kShape, 1));
  const std::string bytes = testing::read_file(file);
  const std::size_t start = bytes.size() - 48 * sizeof(float);
  EXPECT_EQ(start % 64, 0U);
  EXPECT_EQ(bytes.substr(1, 5), "NUMPY");
  EXPECT_EQ(static_cast<std::size_t>(static_cast<unsigned char>(bytes[8])) + 10, start);
  EXPECT_THAT(bytes.substr(10, start - 10),
              HasSubstr("'descr': '<f4', 'fortran_order': False, 'shape': (2, 2, 3, 4)"));
  float value = 0;
  std::memcpy(&value, bytes.data() + start + 24 * sizeof(float), sizeof(value));
  EXPECT_EQ(value, 240);
  EXPECT_EQ(testing::read_file(file.string() + ".windows.txt"),
            "# from to events\n0.000000000 0.050000000 10\n0.050000000 0.100000000 3\n");
}

TEST(GridWriter, PicturesShowOneChannelInGreyAndTwoInRedAndBlue) {
  const TemporaryFolder folder;
  write_two(*make_grid_writer(folder.path() / "frames", kShape, 1));
  const ImageRgb8 image = read_image_rgb(folder.path() / "frames" / "frame_00000001.png");
  EXPECT_EQ(image(2, 1), (Rgb8{246, 0, 255}));  // 258 saturates
  const GridShape one{"event_frame", 1, 1, 3, 4};
  const auto writer = make_grid_writer(folder.path() / "grey", one, 10);
  EventGrid grid(12);
  grid[5] = 1.26F;
  writer->append(grid, {});
  writer->close();
  EXPECT_EQ(read_image_grey(folder.path() / "grey" / "frame_00000000.png")(1, 1), 13);
}

TEST(GridWriter, OtherOutputsAreErrors) {
  EXPECT_THAT(error_of([] { return make_grid_writer("grids.txt", kShape, 1); }),
              HasSubstr("valid endings of grids: .h5, .hdf5, .npy"));
  EXPECT_THAT(error_of([] {
                return make_grid_writer("grids", {"voxel_grid", 1, 5, 3, 4}, 1);
              }),
              HasSubstr("grids of 5 channels are no pictures"));
}

}  // namespace
}  // namespace saccade
