#include "core/io/files/compression.h"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>

#include "core/check.h"

namespace saccade {
namespace {

constexpr std::size_t kFirstUnpackedBytes = std::size_t{1} << 20U;

struct FreeLz4 {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};
struct FreeZstd {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

}  // namespace

struct Unpacker::State {
  Method method;
  std::unique_ptr<LZ4F_dctx, FreeLz4> lz4;
  std::unique_ptr<ZSTD_DCtx, FreeZstd> zstd;
  std::vector<std::byte> bytes;

  /// Makes room behind the first `used` bytes.
  void grow(std::size_t used) {
    if (used < bytes.size()) return;
    if (bytes.size() >= kMostUnpackedBytes)
      throw CompressionError{
          fmt::format("the block unpacks to more than {} MiB", kMostUnpackedBytes >> 20U)};
    bytes.resize(std::max(2 * bytes.size(), kFirstUnpackedBytes));
  }

  std::size_t unpack_lz4(std::span<const std::byte> packed);
  std::size_t unpack_zstd(std::span<const std::byte> packed);
  std::size_t unpack_bzip2(std::span<const std::byte> packed);
};

std::size_t Unpacker::State::unpack_lz4(std::span<const std::byte> packed) {
  LZ4F_resetDecompressionContext(lz4.get());
  std::size_t used = 0;
  while (true) {
    grow(used);
    std::size_t written = bytes.size() - used;
    std::size_t taken = packed.size();
    const std::size_t hint =
        LZ4F_decompress(lz4.get(), bytes.data() + used, &written, packed.data(), &taken, nullptr);
    if (LZ4F_isError(hint) != 0)
      throw CompressionError{
          fmt::format("the block is no LZ4 that can be unpacked ({})", LZ4F_getErrorName(hint))};
    used += written;
    packed = packed.subspan(taken);
    if (hint == 0) return used;
    if (packed.empty() && used < bytes.size())
      throw CompressionError{"the block of LZ4 ends too early"};
  }
}

std::size_t Unpacker::State::unpack_zstd(std::span<const std::byte> packed) {
  ZSTD_DCtx_reset(zstd.get(), ZSTD_reset_session_only);
  ZSTD_inBuffer input{packed.data(), packed.size(), 0};
  std::size_t used = 0;
  while (true) {
    grow(used);
    ZSTD_outBuffer output{bytes.data(), bytes.size(), used};
    const std::size_t hint = ZSTD_decompressStream(zstd.get(), &output, &input);
    if (ZSTD_isError(hint) != 0)
      throw CompressionError{fmt::format("the block is no Zstandard that can be unpacked ({})",
                                         ZSTD_getErrorName(hint))};
    used = output.pos;
    if (hint == 0) return used;
    if (input.pos == input.size && used < bytes.size())
      throw CompressionError{"the block of Zstandard ends too early"};
  }
}

std::size_t Unpacker::State::unpack_bzip2(std::span<const std::byte> packed) {
  struct Stream : bz_stream {
    Stream() : bz_stream{} { SACCADE_CHECK(BZ2_bzDecompressInit(this, 0, 0) == BZ_OK); }
    ~Stream() { BZ2_bzDecompressEnd(this); }
  };
  Stream stream;
  // The library does not write to its input.
  stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(packed.data()));
  stream.avail_in = static_cast<unsigned>(packed.size());
  std::size_t used = 0;
  while (true) {
    grow(used);
    stream.next_out = reinterpret_cast<char*>(bytes.data() + used);
    stream.avail_out = static_cast<unsigned>(bytes.size() - used);
    const int code = BZ2_bzDecompress(&stream);
    used = bytes.size() - stream.avail_out;
    if (code == BZ_STREAM_END) return used;
    if (code != BZ_OK)
      throw CompressionError{fmt::format("the block is no bzip2 that can be unpacked ({})", code)};
    if (stream.avail_in == 0 && stream.avail_out > 0)
      throw CompressionError{"the block of bzip2 ends too early"};
  }
}

Unpacker::Unpacker(Method method) : state_(std::make_unique<State>()) {
  state_->method = method;
  LZ4F_dctx* lz4 = nullptr;
  if (method == Method::kLz4)
    SACCADE_CHECK(LZ4F_isError(LZ4F_createDecompressionContext(&lz4, LZ4F_VERSION)) == 0);
  state_->lz4.reset(lz4);
  if (method == Method::kZstd) state_->zstd.reset(ZSTD_createDCtx());
}

Unpacker::~Unpacker() = default;

std::span<const std::byte> Unpacker::unpack(std::span<const std::byte> packed) {
  if (state_->method == Method::kNone) return packed;
  std::size_t size = 0;
  if (state_->method == Method::kLz4) size = state_->unpack_lz4(packed);
  if (state_->method == Method::kZstd) size = state_->unpack_zstd(packed);
  if (state_->method == Method::kBzip2) size = state_->unpack_bzip2(packed);
  return std::span(state_->bytes).first(size);
}

std::vector<std::byte> pack_zlib(std::span<const std::byte> bytes) {
  uLongf size = compressBound(bytes.size());
  std::vector<std::byte> packed(size);
  const int status =
      compress(reinterpret_cast<Bytef*>(packed.data()), &size,
               reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()));
  SACCADE_CHECK(status == Z_OK);
  packed.resize(size);
  return packed;
}

std::vector<std::byte> pack_lz4(std::span<const std::byte> bytes) {
  std::vector<std::byte> packed(LZ4F_compressFrameBound(bytes.size(), nullptr));
  const std::size_t size =
      LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr);
  SACCADE_CHECK(LZ4F_isError(size) == 0);
  packed.resize(size);
  return packed;
}

}  // namespace saccade
