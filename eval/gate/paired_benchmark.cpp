#include "eval/gate/paired_benchmark.h"

#include <poll.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/scratch_folder.h"
#include "core/process/child_process.h"
#include "core/stopwatch.h"
#include "eval/evaluate.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr int kWaitMs = 200;
constexpr std::size_t kMaxShownOutput = 2000;  // [characters]

/// The output of the current repetition, in a temporary file.
class OutputLog {
 public:
  OutputLog() { clear(); }

  [[nodiscard]] fs::path file() const { return folder_.path() / "output.log"; }
  void clear() const { write_atomically(file(), ""); }
  [[nodiscard]] std::string end() const {
    std::ifstream in(file(), std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(in), {});
    return text.size() > kMaxShownOutput ? text.substr(text.size() - kMaxShownOutput) : text;
  }

 private:
  ScratchFolder folder_;
};

/// The run folder that the arguments of `saccade run` name; empty for other arguments.
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

/// Wall time of one run [s].
double time_once(const fs::path& program, const std::vector<std::string>& arguments,
                 const OutputLog& log, const InterruptGuard& interrupt) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  log.clear();
  const Stopwatch stopwatch;
  ChildProcess process(program, words, log.file());
  const ChildEnd end = wait_for(process, interrupt);
  const double wall_s = stopwatch.seconds();
  if (end.exit_code != 0)
    throw std::runtime_error(program.string() + " ended with " + end.text() + ":\n" + log.end());
  const fs::path output = run_output(arguments);
  if (output.empty()) return wall_s;
  const fs::path timing = output / "timing.json";
  const std::optional<double> stated_s = speed_value(read_json_metrics(timing), "wall_s");
  if (!stated_s || *stated_s <= 0)
    throw InputError(timing.string(), "wall_s: must be a time above 0");
  return *stated_s;
}

}  // namespace

std::vector<Repetition> repetition_order(int repeats) {
  SACCADE_CHECK(repeats >= 2);
  std::vector<Repetition> order{{false, false}, {true, false}};
  for (int i = 0; i < repeats; ++i) {
    const bool second_leads = i % 2 == 1;
    order.push_back({second_leads, true});
    order.push_back({!second_leads, true});
  }
  return order;
}

PairedTimes run_paired_benchmark(const PairedBenchmark& benchmark,
                                 const std::function<void(const Repetition&)>& before) {
  const OutputLog log;
  const InterruptGuard interrupt;
  PairedTimes times;
  for (const Repetition& repetition : repetition_order(benchmark.repeats)) {
    before(repetition);
    const fs::path& program = repetition.second ? benchmark.second : benchmark.first;
    const double wall_s = time_once(program, benchmark.arguments, log, interrupt);
    if (repetition.timed) (repetition.second ? times.second_s : times.first_s).push_back(wall_s);
  }
  return times;
}

}  // namespace saccade
