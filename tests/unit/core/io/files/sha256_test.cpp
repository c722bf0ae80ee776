#include "core/io/files/sha256.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/command.h"

namespace saccade {
namespace {

std::string of(const std::string& text) { return sha256(std::as_bytes(std::span(text))); }

TEST(Sha256, MatchesTheStandardsVectors) {
  EXPECT_EQ(of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(of(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PiecesMakeTheWhole) {
  const std::string text(1000, 'x');
  for (const std::size_t piece : {1U, 63U, 64U, 65U, 200U}) {
    Sha256 hash;
    for (std::size_t i = 0; i < text.size(); i += piece)
      hash.update(std::as_bytes(std::span(text).subspan(i, std::min(piece, text.size() - i))));
    EXPECT_EQ(hash.finish(), of(text)) << piece;
  }
}

TEST(Sha256, OfAFile) {
  const testing::TemporaryFolder folder;
  const std::string text(600'000, 'y');
  EXPECT_EQ(sha256_of_file(folder.write("f", text)), of(text));
}

}  // namespace
}  // namespace saccade
