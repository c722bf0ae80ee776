#include "core/random.h"

#include <cmath>
#include <numbers>

namespace saccade {
namespace {

using Word = std::uint32_t;
using Block = std::array<Word, 4>;

Block philox_round(const Block& c, Word k0, Word k1) {
  const std::uint64_t p0 = std::uint64_t{0xD2511F53} * c[0];
  const std::uint64_t p1 = std::uint64_t{0xCD9E8D57} * c[2];
  return {static_cast<Word>(p1 >> 32) ^ c[1] ^ k0, static_cast<Word>(p1),
          static_cast<Word>(p0 >> 32) ^ c[3] ^ k1, static_cast<Word>(p0)};
}

std::uint64_t join(Word high, Word low) { return (std::uint64_t{high} << 32) | low; }

/// The top 53 bits as a number in [0, 1).
double unit(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

}  // namespace

Block Random::bits(std::uint64_t stream, std::uint64_t index) const {
  constexpr int kRounds = 10;
  Block counter = {static_cast<Word>(index), static_cast<Word>(index >> 32),
                   static_cast<Word>(stream), static_cast<Word>(stream >> 32)};
  Word k0 = static_cast<Word>(seed_);
  Word k1 = static_cast<Word>(seed_ >> 32);
  for (int round = 0; round < kRounds; ++round) {
    counter = philox_round(counter, k0, k1);
    k0 += 0x9E3779B9;
    k1 += 0xBB67AE85;
  }
  return counter;
}

double Random::uniform(std::uint64_t stream, std::uint64_t index) const {
  const Block b = bits(stream, index);
  return unit(join(b[0], b[1]));
}

double Random::normal(std::uint64_t stream, std::uint64_t index) const {
  const Block b = bits(stream, index);
  // 1 - u lies in (0, 1], so the logarithm is finite.
  const double radius = std::sqrt(-2 * std::log(1 - unit(join(b[0], b[1]))));
  return radius * std::cos(2 * std::numbers::pi * unit(join(b[2], b[3])));
}

std::uint64_t Random::below(std::uint64_t bound, std::uint64_t stream, std::uint64_t index) const {
  const Block b = bits(stream, index);
  __extension__ using Wide = unsigned __int128;
  return static_cast<std::uint64_t>((static_cast<Wide>(join(b[0], b[1])) * bound) >> 64);
}

}  // namespace saccade
