#include "simulator/resume.h"

#include <fmt/format.h>

#include <span>
#include <string>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/sha256.h"
#include "core/process/program.h"
#include "core/process/progress.h"

namespace saccade {
namespace {

EventLogs logs_in(const std::filesystem::path& folder, std::size_t cameras) {
  EventLogs logs;
  for (std::size_t i = 0; i < cameras; ++i)
    logs.push_back(std::make_unique<EventLog>(event_log_folder(folder, i)));
  return logs;
}

/// Fraction of the events' time that is recorded [%].
double percent_of(const EventLogs& logs, double duration_s) {
  double reached_s = 0;
  for (const auto& log : logs) reached_s += log->statistics() ? duration_s : log->reached_s();
  return 100 * reached_s / (static_cast<double>(logs.size()) * duration_s);
}

}  // namespace

std::filesystem::path event_log_folder(const std::filesystem::path& journal, std::size_t camera) {
  return journal / fmt::format("cam{}", camera);
}

Fingerprint fingerprint_of(const SimulationConfig& config, const InputLog& inputs) {
  Fingerprint fingerprint = inputs.files();
  const std::string text = config::print(config);
  fingerprint["the configuration"] = sha256(std::as_bytes(std::span(text)));
  fingerprint["the program"] = program_identity();
  return fingerprint;
}

EventLogs open_logs(ResumableFolder& output, std::size_t cameras, double duration_s) {
  EventLogs logs;
  try {
    logs = logs_in(output.journal(), cameras);
  } catch (const InputError& error) {
    if (!output.is_resumed()) throw;
    output.start_clean(error.what());
    logs = logs_in(output.journal(), cameras);
  }
  if (output.is_resumed())
    show_notice(fmt::format("{}: resuming at {:.0f} % of the events", output.target().string(),
                            percent_of(logs, duration_s)));
  else if (!output.refusal().empty())
    show_notice(fmt::format("{}: starting clean instead of resuming: {}", output.target().string(),
                            output.refusal()));
  return logs;
}

}  // namespace saccade
