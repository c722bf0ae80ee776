// Runs one target under libFuzzer: $SACCADE_FUZZ_TARGET names it. With $SACCADE_FUZZ_SEEDS, a folder, the
// program writes there the target's valid inputs (seeds/) and its dictionary (words) instead, and ends.

#include <cstdint>
#include <cstdlib>
#include <iostream>

#include "core/error.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

saccade::fuzz::Feeder* feeder = nullptr;

void write_corpus(const saccade::fuzz::Target& target, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "seeds");
  std::size_t index = 0;
  for (const std::string& seed : feeder->seeds())
    saccade::fuzz::write_bytes(folder / "seeds" / ("valid-" + std::to_string(index++)), seed);
  saccade::fuzz::write_bytes(folder / "words", saccade::fuzz::dictionary(target));
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  const char* name = std::getenv("SACCADE_FUZZ_TARGET");
  try {
    const saccade::fuzz::Target& target = saccade::fuzz::find_target(name == nullptr ? "" : name);
    feeder = new saccade::fuzz::Feeder(target);
    if (const char* folder = std::getenv("SACCADE_FUZZ_SEEDS")) {
      write_corpus(target, folder);
      delete feeder;
      std::exit(0);
    }
    std::atexit([] { delete feeder; });
  } catch (const saccade::InputError& error) {
    std::cerr << error.what() << "\n";
    std::exit(2);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static_cast<void>(feeder->accepts({reinterpret_cast<const char*>(bytes), size}));
  return 0;
}
