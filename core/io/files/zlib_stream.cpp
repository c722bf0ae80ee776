#include "core/io/files/zlib_stream.h"

#include <libdeflate.h>

#include <memory>

#include "core/check.h"

namespace saccade {
namespace {

struct FreeDeflate {
  void operator()(libdeflate_compressor* one) const { libdeflate_free_compressor(one); }
  void operator()(libdeflate_decompressor* one) const { libdeflate_free_decompressor(one); }
};

/// Filling its tables anew costs more than packing a chunk of zeros: each thread keeps its own.
libdeflate_compressor* compressor_of_thread() {
  constexpr int kFastest = 1;
  thread_local const std::unique_ptr<libdeflate_compressor, FreeDeflate> instance(
      libdeflate_alloc_compressor(kFastest));
  SACCADE_CHECK(instance != nullptr);
  return instance.get();
}

libdeflate_decompressor* decompressor_of_thread() {
  thread_local const std::unique_ptr<libdeflate_decompressor, FreeDeflate> instance(
      libdeflate_alloc_decompressor());
  SACCADE_CHECK(instance != nullptr);
  return instance.get();
}

}  // namespace

std::vector<std::byte> pack_zlib_fast(std::span<const std::byte> bytes) {
  libdeflate_compressor* compressor = compressor_of_thread();
  std::vector<std::byte> packed(libdeflate_zlib_compress_bound(compressor, bytes.size()));
  packed.resize(libdeflate_zlib_compress(compressor, bytes.data(), bytes.size(), packed.data(),
                                         packed.size()));
  SACCADE_CHECK(!packed.empty());
  return packed;
}

bool unpack_zlib_exactly(std::span<const std::byte> packed, std::span<std::byte> bytes) {
  return libdeflate_zlib_decompress(decompressor_of_thread(), packed.data(), packed.size(),
                                    bytes.data(), bytes.size(), nullptr) == LIBDEFLATE_SUCCESS;
}

}  // namespace saccade
