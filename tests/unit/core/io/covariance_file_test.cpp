#include "core/io/covariance_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

TEST(CovarianceFile, ComesBackExactly) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "covariance.txt";
  std::vector<StampedCovariance> written(2);
  for (std::size_t i = 0; i < 2; ++i) {
    written[i].t_s = 0.25 + 0.5 * static_cast<double>(i);
    for (int row = 0; row < 6; ++row)
      for (int column = 0; column < 6; ++column)
        written[i].covariance(row, column) = 1e-7 / (1.3 + row + column + static_cast<double>(i));
  }
  write_covariances(file, written);
  const auto read = read_covariances(file);
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].t_s, written[i].t_s);
    EXPECT_EQ(read[i].covariance, written[i].covariance);
  }
}

TEST(CovarianceFile, MalformedLinesAreNamed) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "covariance.txt";
  std::ofstream(file) << "0 1 2 3\n";
  EXPECT_THAT(error_of([&] { return read_covariances(file); }), HasSubstr("covariance.txt:1"));
  const std::vector<StampedCovariance> twice(2);
  write_covariances(file, twice);
  EXPECT_THAT(error_of([&] { return read_covariances(file); }), HasSubstr("covariance.txt:3"));
}

}  // namespace
}  // namespace saccade
