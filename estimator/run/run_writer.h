#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "core/io/files/atomic_file.h"
#include "core/io/run/method_class.h"
#include "core/io/run/run_record.h"
#include "estimator/run/run_request.h"

namespace saccade {

/// What timing.json states. All times without reading and writing files but `io_s`.
struct RunTiming {
  std::vector<double> wall_s;        ///< of every repetition
  std::size_t events = 0;            ///< processed in one repetition
  std::optional<std::size_t> poses;  ///< found in one repetition, by modules that find poses
  double sequence_s = 0;             ///< length of the recording
  double io_s = 0;  ///< for events to be read and handed over, and for writing, in one repetition
  std::vector<std::pair<std::string, double>> stages_s;  ///< of the last repetition
  std::vector<double> latency_ms;  ///< of every pose of the last repetition, where it has one
  std::optional<std::size_t> dropped_events;  ///< in the last repetition, where some may be
  std::vector<double> cpu_s;  ///< of every repetition, where another program did the work
  std::optional<double> peak_memory_mb;  ///< of that program; default: of this one
};

/// The JSON text: wall_s, events_per_s, poses_per_s and realtime_factor as median, min and max over
/// the repetitions.
[[nodiscard]] std::string to_json(const RunTiming& timing);

/// What there is to say about a run that found `found`.
[[nodiscard]] RunSummary summary_of(const RunTiming& timing, const std::string& found);

/// What run.yaml calls the dataset's sha256: of its dataset.yaml, or of its events where it has
/// none.
[[nodiscard]] std::string dataset_hash(const Dataset& dataset);

/// The run folder while it is filled: run.yaml and timing.json are the same for every module.
class RunWriter {
 public:
  /// Checks that the output folder may be written, before the work begins.
  explicit RunWriter(const RunRequest& request);

  /// Where the module writes its own files.
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

  /// States what the module was given and how far it looks ahead. What the runs were given that the
  /// request names is added by finish(); where one of them does not state it, neither does this.
  void set_class(const MethodClass& method_class) { method_class_ = method_class; }

  /// States the contrast thresholds that the module found itself [log units].
  void set_contrast(const RunRecord::Contrast& contrast) { contrast_ = contrast; }

  /// Writes run.yaml and timing.json and gives the folder its name. Contract: set_class() before,
  /// but of an external program.
  void finish(const std::string& module, const RunRequest& request, const Dataset& dataset,
              const RunRecord::Window& window, std::uint64_t seed, const std::string& config_yaml,
              const RunTiming& timing, const std::optional<RunRecord::External>& external = {});

 private:
  AtomicFolder folder_;
  std::optional<MethodClass> method_class_;
  std::optional<RunRecord::Contrast> contrast_;
};

}  // namespace saccade
