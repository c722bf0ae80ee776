#include "eval/gate/paired_benchmark.h"

#include <poll.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "core/check.h"
#include "core/child_process.h"
#include "core/error.h"
#include "core/io/atomic_file.h"
#include "core/io/scratch_folder.h"
#include "eval/evaluate.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kWaitMs = 200;
constexpr std::size_t kShownOfLog = 2000;  // characters

/// What the programs print, gone with the object.
class RaceLog {
 public:
  RaceLog() { clear(); }

  [[nodiscard]] fs::path file() const { return folder_.path() / "race.log"; }
  void clear() const { write_atomically(file(), ""); }
  [[nodiscard]] std::string end() const {
    std::ifstream in(file(), std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(in), {});
    return text.size() > kShownOfLog ? text.substr(text.size() - kShownOfLog) : text;
  }

 private:
  ScratchFolder folder_;
};

/// The folder that the arguments have a run written to; empty where they are none of `run`.
fs::path run_output(const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments.front() != "run") return {};
  for (std::size_t i = 0; i + 1 < arguments.size(); ++i)
    if (arguments[i] == "-o" || arguments[i] == "--output") return arguments[i + 1];
  return {};
}

ChildEnd wait_for(ChildProcess& process, const InterruptGuard& interrupt) {
  for (;;) {
    if (const std::optional<ChildEnd> end = process.poll_end()) return *end;
    if (interrupt.requested()) throw std::runtime_error("interrupted");
    pollfd end{process.descriptor(), POLLIN, 0};
    ::poll(&end, 1, kWaitMs);
  }
}

double time_once(const fs::path& program, const PairedBenchmark& race, const RaceLog& log,
                 const InterruptGuard& interrupt) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), race.arguments.begin(), race.arguments.end());
  log.clear();
  const Clock::time_point start = Clock::now();
  ChildProcess process(program, words, log.file());
  const ChildEnd end = wait_for(process, interrupt);
  const double wall_s = std::chrono::duration<double>(Clock::now() - start).count();
  if (end.exit_code != 0)
    throw std::runtime_error(program.string() + " ended with " + end.text() + ":\n" + log.end());
  const fs::path output = run_output(race.arguments);
  if (output.empty()) return wall_s;
  const fs::path timing = output / "timing.json";
  const std::optional<double> own = speed_value(read_json_metrics(timing), "wall_s");
  if (!own || *own <= 0) throw InputError(timing.string(), "wall_s: must be a time above 0");
  return *own;
}

}  // namespace

std::vector<Repetition> repetition_order(int repeats) {
  SACCADE_CHECK(repeats >= 2);
  std::vector<Repetition> turns{{false, false}, {true, false}};
  for (int i = 0; i < repeats; ++i) {
    const bool second_leads = i % 2 == 1;
    turns.push_back({second_leads, true});
    turns.push_back({!second_leads, true});
  }
  return turns;
}

PairedTimes run_paired_benchmark(const PairedBenchmark& race, const std::function<void(const Repetition&)>& before) {
  const RaceLog log;
  const InterruptGuard interrupt;
  PairedTimes times;
  for (const Repetition& turn : repetition_order(race.repeats)) {
    before(turn);
    const double wall_s = time_once(turn.second ? race.second : race.first, race, log, interrupt);
    if (turn.timed) (turn.second ? times.second_s : times.first_s).push_back(wall_s);
  }
  return times;
}

}  // namespace saccade
