#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/io/events/event_file.h"
#include "core/io/files/sha256.h"
#include "core/io/files/zlib_stream.h"
#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "core/io/tables/h5_chunks.h"
#include "core/io/tables/h5_column.h"
#include "core/process/parallel.h"
#include "core/random.h"
#include "core/srgb.h"
#include "tests/support/command.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

constexpr std::size_t kEvents = 4'000'000;
constexpr SensorSize kSize{240, 180};

/// Pixels in clusters that wander, as edges give them: white noise would compress worse.
const Events& events() {
  static const Events instance = [] {
    Events result = testing::random_events(kEvents, 0, 300);
    const Random random(2);
    for (std::uint64_t i = 0; i < result.size(); ++i) {
      const auto wander = static_cast<std::uint64_t>(i / 5000 % 100);
      result[i].x = static_cast<std::uint16_t>(wander + 20 * random.below(7, 0, i));
      result[i].y = static_cast<std::uint16_t>(random.below(180, 1, i));
    }
    sort_ties(result);
    return result;
  }();
  return instance;
}

void write(const std::filesystem::path& file) {
  const std::unique_ptr<EventWriter> writer = make_event_writer(file, TimestampUnit::kMicroseconds);
  writer->append(events());
  writer->close();
}

void report(benchmark::State& state) {
  state.counters["events/s"] = benchmark::Counter(static_cast<double>(kEvents),
                                                  benchmark::Counter::kIsIterationInvariantRate);
}

void write_events(benchmark::State& state, const char* name) {
  const testing::TemporaryFolder folder;
  set_thread_count(static_cast<int>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) write(folder.path() / name);
  report(state);
  state.counters["bytes/event"] =
      static_cast<double>(std::filesystem::file_size(folder.path() / name)) / kEvents;
  set_thread_count(0);
}

void read_all_events(benchmark::State& state, const char* name) {
  const testing::TemporaryFolder folder;
  write(folder.path() / name);
  set_thread_count(static_cast<int>(state.range(0)));
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(read_events(folder.path() / name, kSize));
  report(state);
  set_thread_count(0);
}

/// Block by block, as commands read that need no more.
void stream_events(benchmark::State& state, const char* name) {
  const testing::TemporaryFolder folder;
  write(folder.path() / name);
  set_thread_count(static_cast<int>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) {
    EventStream stream(folder.path() / name, kSize);
    while (!stream.next().empty()) {
    }
  }
  report(state);
  set_thread_count(0);
}

/// Chunks of times, which are the widest column.
std::vector<std::int64_t> chunk_of_times() {
  std::vector<std::int64_t> times;
  for (std::size_t i = 0; i < kH5ChunkValues; ++i) times.push_back(events()[i].t_ns);
  return times;
}

void pack_chunk(benchmark::State& state) {
  const std::vector<std::int64_t> times = chunk_of_times();
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(pack_h5_chunk(times));
  state.SetItemsProcessed(static_cast<std::int64_t>(times.size()) * state.iterations());
}

void unpack_chunk(benchmark::State& state) {
  const H5Chunk packed = pack_h5_chunk(chunk_of_times());
  std::vector<std::byte> shuffled(kH5ChunkValues * sizeof(std::int64_t)), values(shuffled.size());
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(unpack_zlib_exactly(packed, shuffled));
    unshuffle_bytes(shuffled, sizeof(std::int64_t), values);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(kH5ChunkValues) * state.iterations());
}

/// 10 ms from the middle of the file.
void read_window(benchmark::State& state) {
  const testing::TemporaryFolder folder;
  write(folder.path() / "events.h5");
  const TimeNs middle = events()[kEvents / 2].t_ns;
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(
        read_events(folder.path() / "events.h5", kSize, {middle, middle + 10'000'000}));
}

void write_frame(benchmark::State& state) {
  const testing::TemporaryFolder folder;
  ImageF image(240, 180);
  for (std::size_t i = 0; i < image.size(); ++i)
    image.pixels()[i] = static_cast<float>(Random(1).uniform(0, i));
  for ([[maybe_unused]] auto _ : state) {
    write_exr(folder.path() / "f.exr", image, "Y");
    write_png(folder.path() / "f.png", srgb8_from_linear(image));
  }
}

void hash(benchmark::State& state) {
  const std::vector<std::byte> bytes(std::size_t{1} << 22);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(sha256(bytes));
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes.size()) * state.iterations());
}

BENCHMARK_CAPTURE(write_events, text, "events.txt")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(read_all_events, text, "events.txt")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(write_events, h5, "events.h5")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(read_all_events, h5, "events.h5")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(write_events, evt3, "events.raw")->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_all_events, evt3, "events.raw")->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_events, aedat4, "events.aedat4")->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_all_events, aedat4, "events.aedat4")->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_events, npz, "events.npz")->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_all_events, npz, "events.npz")->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(stream_events, h5, "events.h5")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(stream_events, text, "events.txt")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(pack_chunk)->Unit(benchmark::kMicrosecond);
BENCHMARK(unpack_chunk)->Unit(benchmark::kMicrosecond);
BENCHMARK(read_window)->Unit(benchmark::kMillisecond);
BENCHMARK(write_frame)->Unit(benchmark::kMillisecond);
BENCHMARK(hash);

}  // namespace
}  // namespace saccade
