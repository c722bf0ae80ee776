// What fuzzing needs no instrumented build for: every target accepts its own valid inputs, and answers those
// that once broke it, and simple damage, with a result or an InputError within the limits of a fuzzer.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <set>

#include "core/random.h"
#include "tests/fuzz/fuzz_target.h"

namespace saccade::fuzz {
namespace {

class Replay : public ::testing::TestWithParam<std::string> {
 protected:
  Feeder feeder_{find_target(GetParam())};
};

TEST_P(Replay, ValidInputsAreAccepted) {
  for (const std::string& seed : feeder_.seeds())
    EXPECT_TRUE(feeder_.accepts(seed)) << feeder_.refusal();
}

TEST_P(Replay, WhatOnceBrokeItIsAnswered) {
  const std::filesystem::path folder = std::filesystem::path("tests/fuzz/reproducers") / GetParam();
  if (!std::filesystem::exists(folder)) return;  // nothing has broken it
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.insert(entry.path());
  for (const std::filesystem::path& file : files) {
    SCOPED_TRACE(file.string());
    EXPECT_NO_THROW(static_cast<void>(feeder_.accepts(read_bytes(file))));
  }
}

/// One change of each kind, at a place of its own for every `index`.
std::string damaged(const std::string& input, std::uint64_t index) {
  const Random random(index);
  std::string bytes = input;
  if (bytes.empty()) return bytes;
  const std::size_t at = random.below(bytes.size(), 0, 0);
  switch (random.below(5, 1, 0)) {
    case 0:
      bytes.resize(at);
      break;
    case 1:
      bytes[at] = static_cast<char>(random.below(256, 2, 0));
      break;
    case 2:  // numbers that are larger than anything
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                  std::min<std::size_t>(4, bytes.size() - at), '\xFF');
      break;
    case 3:
      bytes.erase(at, random.below(16, 2, 0) + 1);
      break;
    default:
      bytes.insert(at, bytes.substr(random.below(bytes.size(), 2, 0), 64));
  }
  return bytes;
}

TEST_P(Replay, SimpleDamageIsAnswered) {
  constexpr std::uint64_t kInputs = 60;
  const std::vector<std::string> seeds = feeder_.seeds();
  for (std::uint64_t i = 0; i < kInputs; ++i) {
    std::string input = damaged(seeds[i % seeds.size()], i);
    EXPECT_NO_THROW(static_cast<void>(feeder_.accepts(input))) << "input " << i;
  }
}

std::vector<std::string> names() {
  std::vector<std::string> list;
  for (const Target& target : targets()) list.push_back(target.name);
  return list;
}

INSTANTIATE_TEST_SUITE_P(Targets, Replay, ::testing::ValuesIn(names()), [](const auto& name) {
  std::string text = name.param;
  std::ranges::replace(text, '-', '_');
  return text;
});

}  // namespace
}  // namespace saccade::fuzz
