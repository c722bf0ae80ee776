#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/io/events/event_formats.h"
#include "core/io/events/numpy/numpy_events.h"
#include "core/io/files/zip_archive.h"
#include "core/io/tables/npy_header.h"
#include "tests/support/command.h"
#include "tests/support/damage.h"
#include "tests/support/error_of.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;

/// A file of the format with any header.
std::string npy(const std::string& dictionary, const std::string& data) {
  std::string header = dictionary + "\n";
  return std::string(kNpyMagic) + std::string("\x01\x00", 2) + static_cast<char>(header.size()) +
         std::string(1, '\0') + header + data;
}

template <class... Numbers>
std::string bytes_of(Numbers... numbers) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&numbers), sizeof numbers), ...);
  return bytes;
}

class Numpy : public ::testing::Test {
 protected:
  [[nodiscard]] Events read(const std::string& bytes) const {
    return read_events(folder_.write("e.npy", bytes), {});
  }
  [[nodiscard]] std::string error(const std::string& bytes) const {
    return error_of([&] { return read(bytes); });
  }
  [[nodiscard]] fs::path archive(
      const std::vector<std::pair<std::string, std::string>>& members) const {
    std::vector<std::pair<std::string, fs::path>> files;
    for (const auto& [name, bytes] : members)
      files.emplace_back(name, folder_.write("member_" + std::to_string(files.size()), bytes));
    write_zip(folder_.path() / "e.npz", files);
    return folder_.path() / "e.npz";
  }

  testing::TemporaryFolder folder_;
};

const std::string kFields =
    "{'descr': [('t', '<i8'), ('x', '<i2'), ('y', '<i2'), ('p', '|u1'), ('', '|V3')], "
    "'fortran_order': False, 'shape': (2,), }";

std::string row(std::int64_t t, std::int16_t x, std::int16_t y, std::uint8_t p) {
  return bytes_of(t, x, y, p) + "abc";
}

TEST_F(Numpy, StructuresAreReadByTheNamesOfTheirFields) {
  EXPECT_EQ(read(npy(kFields, row(5, 10, 20, 1) + row(6, 11, 21, 0))),
            (Events{{5'000, 10, 20, 1}, {6'000, 11, 21, -1}}));
  EXPECT_EQ(read(npy("{'shape': (1,), 'fortran_order': False, 'descr': [('polarity', '|b1'), "
                     "('y', '<u4'), ('x', '<f4'), ('timestamp', '<f8')]}",
                     bytes_of(std::uint8_t{1}, std::uint32_t{7}, 8.0F, 1.5))),
            (Events{{1'500'000'000, 8, 7, 1}}));
}

TEST_F(Numpy, RowsOfFourColumnsAreReadInTheirOrder) {
  EXPECT_EQ(read(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 4)}",
                     bytes_of(0.25, 3.0, 4.0, 1.0, 0.5, 5.0, 6.0, -1.0))),
            (Events{{250'000'000, 3, 4, 1}, {500'000'000, 5, 6, -1}}));
  EXPECT_EQ(read(npy("{'descr': '<u4', 'fortran_order': False, 'shape': (1L, 4L), }",
                     bytes_of(9U, 3U, 4U, 0U))),
            (Events{{9'000, 3, 4, -1}}));
}

TEST_F(Numpy, ArchivesHoldFourArraysOrOneStructure) {
  const auto column = [](const std::string& type, const std::string& data) {
    return npy("{'descr': '" + type + "', 'fortran_order': False, 'shape': (2,), }", data);
  };
  const Events expected{{5'000, 10, 20, 1}, {6'000, 11, 21, -1}};
  EXPECT_EQ(
      read_events(archive({{"x.npy", column("<u2", bytes_of(std::uint16_t{10}, std::uint16_t{11}))},
                           {"y.npy", column("|u1", bytes_of(std::uint8_t{20}, std::uint8_t{21}))},
                           {"other.npy", "nothing"},
                           {"p.npy", column("|b1", bytes_of(std::uint8_t{1}, std::uint8_t{0}))},
                           {"t.npy", column("<u8", bytes_of(std::uint64_t{5}, std::uint64_t{6}))}}),
                  {}),
      expected);
  EXPECT_EQ(read_events(
                archive({{"events.npy", npy(kFields, row(5, 10, 20, 1) + row(6, 11, 21, 0))}}), {}),
            expected);
  EXPECT_THAT(error_of([&] {
                return read_events(archive({{"x.npy", column("<u2", bytes_of(1))},
                                            {"y.npy", column("<u2", bytes_of(1))}}),
                                   {});
              }),
              HasSubstr("e.npz: holds no events: it must be an array with the fields t, x, y"));
}

TEST_F(Numpy, NamesTheIndexOfWhatIsWrong) {
  EXPECT_THAT(error(npy(kFields, row(5, 10, 20, 1) + row(4, 11, 21, 0))),
              HasSubstr("e.npy:[1]: time goes back: 4 after 5"));
  EXPECT_THAT(error(npy(kFields, row(5, 10, 20, 1) + row(6, -11, 21, 0))),
              HasSubstr("e.npy:[1]: pixel (-11, 21) lies outside"));
  EXPECT_THAT(error(npy(kFields, row(5, 10, 20, 2) + row(6, 11, 21, 0))),
              HasSubstr("e.npy:[0]: polarity 2 must be 0 or 1"));
  EXPECT_THAT(error(npy(kFields, row(5, 10, 20, 1))), HasSubstr("ends within row 1 of the 2"));
  EXPECT_THAT(error(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 4)}",
                        bytes_of(std::nan(""), 3.0, 4.0, 1.0))),
              HasSubstr("e.npy:[0]: time goes back"));
  EXPECT_THAT(error(npy("{'descr': '<f8', 'fortran_order': True, 'shape': (1, 4)}", "")),
              HasSubstr("holds no events"));
  EXPECT_THAT(error(npy("{'descr': '>f8', 'fortran_order': False, 'shape': (1, 4)}", "")),
              HasSubstr("'>f8' are big-endian"));
  EXPECT_THAT(error(npy("{'descr': '|O', 'fortran_order': False, 'shape': (1, 4)}", "")),
              HasSubstr("'|O' is no type of numbers"));
}

TEST_F(Numpy, ClaimedSizesAreNotAllocated) {
  EXPECT_THAT(
      error(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999, 4)}", "abc")),
      HasSubstr("ends within row 0 of the 99999999999999"));
}

TEST_F(Numpy, TextAndRawBytesAreNoNumbers) {
  for (const char* type : {"|V3", "<U1", "|V8"})
    EXPECT_THAT(
        error(npy(std::string("{'descr': '") + type + "', 'fortran_order': False, 'shape': (2, 4)}",
                  std::string(256, 'a'))),
        HasSubstr("holds text or raw bytes"));
  // A column that has no bytes is missing, not read from what lies behind it.
  EXPECT_THAT(error(npy("{'descr': [('t', '<i8'), ('x', '<u2'), ('y', '<u2'), ('p', '<U0')], "
                        "'fortran_order': False, 'shape': (1,)}",
                        std::string(12, 'a'))),
              HasSubstr("p"));
}

TEST_F(Numpy, ClaimedRowsAreNotAllocated) {
  std::string fields = "[('t', '<i8'), ('x', '<u2'), ('y', '<u2'), ('p', '|b1')";
  for (const char* name : {"a", "b", "c", "d", "e"})
    fields += std::string(", ('") + name + "', '<U65536')";
  EXPECT_THAT(
      error(npy("{'descr': " + fields + "], 'fortran_order': False, 'shape': (9,)}", "abc")),
      HasSubstr("for a row"));
}

TEST_F(Numpy, DamagedFilesAreReportedOrRead) {
  const std::string file = npy(kFields, row(5, 10, 20, 1) + row(6, 11, 21, 0));
  testing::expect_damage_is_reported(file, file.size(), [&](const std::string& bytes) {
    // No byte at all, and a few that are characters, are text.
    return read(bytes.size() < kNpyMagic.size() ? std::string(1, '\0') : bytes);
  });
}

TEST_F(Numpy, DamagedArchivesAreReportedOrRead) {
  const fs::path path = folder_.path() / "w.npz";
  const auto writer = make_npz_writer(path, TimestampUnit::kMicroseconds, testing::kSensor);
  writer->append(testing::random_events(5));
  writer->close();
  const std::string file = testing::read_file(path);
  testing::expect_damage_is_reported(file, file.size(), [&](const std::string& bytes) {
    return read(bytes.size() < kNpyMagic.size() ? std::string(1, '\0') : bytes);
  });
}

TEST(EventsZip, EventsOfATextAreReadInTheirArchive) {
  const testing::TemporaryFolder folder;
  const fs::path file = folder.path() / "shapes.zip";
  write_zip(file, {{"shapes/calib.txt", folder.write("calib.txt", "1 1 1 1 0 0 0 0 0\n")},
                   {"shapes/events.txt", folder.write("e.txt", "0.5 1 2 1\n0.6 3 4 0\n")}});
  EXPECT_EQ(recognise_event_format(file).name, "zipped text");
  EXPECT_EQ(read_events(file, {}), (Events{{500'000'000, 1, 2, 1}, {600'000'000, 3, 4, -1}}));
  EXPECT_THAT(error_of([&] {
                return read_events(file, {2, 5});
              }),
              HasSubstr("shapes.zip!/shapes/events.txt:2: x = 3 lies outside the sensor"));
  write_zip(file, {{"readme.txt", folder.path() / "e.txt"}});
  EXPECT_THAT(error_of([&] { return read_events(file, {}); }), HasSubstr("in none of the formats"));
}

TEST_F(Numpy, AHeaderWithoutContentIsRefused) {
  const std::string rest(200, ' ');
  EXPECT_THAT(error(std::string("\x93NUMPY\x01\0\0\0", 10) + rest),
              HasSubstr("claims to be empty"));
  EXPECT_THAT(error(std::string("\x93NUMPY\x01\0\x01\0", 10) + rest),
              HasSubstr("claims to be empty"));
}

}  // namespace
}  // namespace saccade
