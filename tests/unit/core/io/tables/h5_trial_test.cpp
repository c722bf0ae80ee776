#include "core/io/tables/h5_trial.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/io/tables/h5_file.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/h5_content.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using testing::H5Content;
using testing::TemporaryFolder;

/// "no error" where it passes.
std::string problem_of(const fs::path& file) {
  return error_of([&] {
    try_h5_file(file);
    return 0;
  });
}

/// A dataset in chunks of `chunk` values.
void write_chunked(const fs::path& file, hsize_t chunk) {
  const H5Content content(file);
  const hsize_t length = 4 * chunk;
  const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(layout, 1, &chunk);
  const hid_t space = H5Screate_simple(1, &length, nullptr);
  const hid_t set = H5Dcreate2(content.id(), "values", H5T_NATIVE_UINT16, space, H5P_DEFAULT,
                               layout, H5P_DEFAULT);
  const std::vector<std::uint16_t> values(length, 7);
  H5Dwrite(set, H5T_NATIVE_UINT16, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(set);
  H5Sclose(space);
  H5Pclose(layout);
}

TEST(H5Trial, SoundFilesPass) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a.h5";
  {
    const std::vector<double> numbers(1 << 18, 3.0);  // more than is read whole
    H5Content content(file);
    content.column<double>("poses/t", {1, 2, 3}).text("camera/model", "pinhole");
    content.array<double>("depth", {4, 256, 256}, numbers);
  }
  EXPECT_EQ(problem_of(file), "no error");
  write_chunked(folder.path() / "b.h5", 12345);
  EXPECT_EQ(problem_of(folder.path() / "b.h5"), "no error");
}

TEST(H5Trial, WhatHdf5RefusesIsLeftToTheReader) {
  const TemporaryFolder folder;
  EXPECT_EQ(problem_of(folder.write("text.h5", "no such thing")), "no error");
  EXPECT_EQ(problem_of(folder.path() / "nothing"), "no error");
}

/// HDF5 1.10 divides by the lengths of chunks without looking where the layout is said to be of version 2.
TEST(H5Trial, AFileThatEndsTheProcessIsAnError) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a.h5";
  write_chunked(file, 0x2345);
  std::string bytes = testing::read_file(file);
  // Version 3, chunked, two dimensions: that of the values and their bytes.
  const std::size_t layout = bytes.find("\x03\x02\x02");
  ASSERT_NE(layout, std::string::npos);
  bytes.replace(layout, 2, "\x02\x03");
  folder.write("a.h5", bytes);
  EXPECT_THAT(problem_of(file),
              ::testing::StartsWith(file.string() +
                                    ": is damaged in a way that HDF5 does not survive: it "));
  EXPECT_THAT(error_of([&] { return H5File(file).shape("values").size(); }),
              ::testing::HasSubstr("does not survive"));
  const std::string again = problem_of(file);
  EXPECT_THAT(again, ::testing::HasSubstr("does not survive")) << "it was remembered as sound";
  // Repaired, it is another version.
  write_chunked(file, 1234);
  EXPECT_EQ(H5File(file).shape("values"), std::vector<std::uint64_t>{4 * 1234});
}

}  // namespace
}  // namespace saccade
