#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace saccade {

/// What a compressed block is refused for; who reads the file adds where it stands.
struct CompressionError {
  std::string problem;
};

/// Unpacks frames of LZ4 and Zstandard, and streams of bzip2. The memory grows with what is really unpacked, whatever
/// size a frame claims, and ends at kMostUnpackedBytes.
class Unpacker {
 public:
  enum class Method { kNone, kLz4, kZstd, kBzip2 };

  explicit Unpacker(Method method);
  ~Unpacker();
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;

  /// Valid until the next call.
  /// Without compression: the same bytes.
  [[nodiscard]] std::span<const std::byte> unpack(std::span<const std::byte> packed);

  static constexpr std::size_t kMostUnpackedBytes = std::size_t{1} << 28U;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A zlib stream (RFC 1950) with the default level, for browsers.
[[nodiscard]] std::vector<std::byte> pack_zlib(std::span<const std::byte> bytes);

/// A frame of LZ4 with the default level.
[[nodiscard]] std::vector<std::byte> pack_lz4(std::span<const std::byte> bytes);

}  // namespace saccade
