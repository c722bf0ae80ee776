#include "core/io/tables/h5_chunks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <span>
#include <vector>

#include "core/io/files/zlib_stream.h"
#include "tests/support/command.h"

namespace saccade {
namespace {

using testing::TemporaryFolder;

std::vector<std::byte> counted_bytes(std::size_t count) {
  std::vector<std::byte> bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>(i * 37 % 251);
  return bytes;
}

TEST(ShuffledBytes, AreThoseOfTheFilter) {
  for (const std::size_t width : {1U, 2U, 4U, 8U})
    for (const std::size_t count : {0U, 1U, 7U, 511U, 512U, 513U, 5000U}) {
      const std::vector<std::byte> values = counted_bytes(count * width);
      std::vector<std::byte> shuffled(values.size()), again(values.size());
      shuffle_bytes(values, width, shuffled);
      for (std::size_t i = 0; i < values.size(); ++i)
        ASSERT_EQ(shuffled[i % width * count + i / width], values[i]) << width << " " << i;
      unshuffle_bytes(shuffled, width, again);
      ASSERT_EQ(again, values) << width << " " << count;
    }
}

/// A file with one dataset of `count` 32-bit numbers that the library writes.
class H5ChunksOfTheLibrary : public ::testing::Test {
 protected:
  static constexpr hsize_t kCount = 2500;
  static constexpr hsize_t kChunk = 1000;

  void write(bool with_shuffle, bool with_deflate, hid_t type = H5T_STD_I32LE,
             bool with_checksum = false) {
    dataset_.close();  // and the file, before another takes its name
    file_.close();
    file_ = {H5Fcreate((folder_.path() / "a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
             H5Fclose};
    const hsize_t count = kCount, chunk = kChunk;
    const H5Handle space = {H5Screate_simple(1, &count, nullptr), H5Sclose};
    const H5Handle layout = {H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
    H5Pset_chunk(layout, 1, &chunk);
    if (with_shuffle) H5Pset_shuffle(layout);
    if (with_deflate) H5Pset_deflate(layout, 4);
    if (with_checksum) H5Pset_fletcher32(layout);
    dataset_ = {H5Dcreate2(file_, "v", type, space, H5P_DEFAULT, layout, H5P_DEFAULT), H5Dclose};
    std::iota(values_.begin(), values_.end(), -100);
    H5Dwrite(dataset_, H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, values_.data());
    H5Fflush(file_, H5F_SCOPE_LOCAL);
  }

  const H5Lock lock_;
  TemporaryFolder folder_;
  H5Handle file_, dataset_;
  std::vector<std::int32_t> values_ = std::vector<std::int32_t>(kCount);
};

TEST_F(H5ChunksOfTheLibrary, HoldWhatItWrote) {
  for (const bool with_shuffle : {false, true})
    for (const bool with_deflate : {false, true}) {
      write(with_shuffle, with_deflate);
      const auto chunks = H5Chunks::of(dataset_);
      ASSERT_TRUE(chunks);
      EXPECT_EQ(chunks->values(), kChunk);
      EXPECT_TRUE(chunks->is_signed());
      std::vector<std::int32_t> found(kChunk);
      for (std::size_t c = 0; c < 3; ++c) {
        H5Chunks::Packed packed;
        ASSERT_TRUE(chunks->read(c, packed));
        ASSERT_TRUE(chunks->unpack(packed, std::as_writable_bytes(std::span(found))));
        const std::size_t count = std::min<std::size_t>(kChunk, kCount - c * kChunk);
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(found[i], values_[c * kChunk + i]);
      }
    }
}

TEST_F(H5ChunksOfTheLibrary, OtherTypesAndFiltersAreLeftToTheLibrary) {
  write(true, true, H5T_IEEE_F32LE);
  EXPECT_FALSE(H5Chunks::of(dataset_));
  write(true, true, H5T_STD_I32BE);
  EXPECT_FALSE(H5Chunks::of(dataset_));
  write(true, true, H5T_STD_I32LE, true);
  EXPECT_FALSE(H5Chunks::of(dataset_));
}

TEST_F(H5ChunksOfTheLibrary, DamageIsFound) {
  write(true, true);
  const auto chunks = H5Chunks::of(dataset_);
  H5Chunks::Packed packed;
  ASSERT_TRUE(chunks->read(0, packed));
  EXPECT_FALSE(chunks->read(3, packed)) << "there are only three";
  ASSERT_TRUE(chunks->read(0, packed));
  std::vector<std::byte> memory(kChunk * 4);
  H5Chunks::Packed shorter = packed;
  shorter.bytes.resize(shorter.bytes.size() / 2);
  EXPECT_FALSE(chunks->unpack(shorter, memory));
  H5Chunks::Packed other = packed;
  other.bytes[other.bytes.size() / 2] ^= std::byte{0x55};
  EXPECT_FALSE(chunks->unpack(other, memory));
  H5Chunks::Packed longer;
  longer.bytes = pack_zlib_fast(counted_bytes(memory.size() + 1));
  EXPECT_FALSE(chunks->unpack(longer, memory));
}

}  // namespace
}  // namespace saccade
