#include "core/process/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

#include "core/process/progress_observer.h"

namespace saccade {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr std::chrono::milliseconds kRedraw{100};
constexpr std::chrono::seconds kFirstLine{5};
constexpr int kBarWidth = 24;

std::atomic<bool> quiet{false};

ProgressObserver& observer() {
  static ProgressObserver instance;
  return instance;
}

/// 1234567 -> "1.23 M ", to be followed by the unit.
std::string with_prefix(double value) {
  for (const auto& [scale, prefix] : {std::pair{1e9, "G"}, {1e6, "M"}, {1e3, "k"}})
    if (value >= scale) return fmt::format("{:.3g} {} ", value / scale, prefix);
  return fmt::format("{:.3g} ", value);
}

std::string clock_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 60) return fmt::format("{:.1f} s", seconds);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string bar(double fraction) {
  const int filled = static_cast<int>(fraction * kBarWidth);
  return "[" + std::string(static_cast<std::size_t>(filled), '#') +
         std::string(static_cast<std::size_t>(kBarWidth - filled), '.') + "] ";
}

}  // namespace

void set_progress_quiet(bool now_quiet) { quiet = now_quiet; }

void set_progress_observer(ProgressObserver now_observing) {
  observer() = std::move(now_observing);
}

void show_notice(const std::string& line) {
  if (!quiet) std::fputs((line + "\n").c_str(), stderr);
}

void show_warning(const std::string& line) {
  static std::mutex mutex;
  static std::set<std::string> shown;
  const std::scoped_lock lock(mutex);
  if (shown.insert(line).second) std::fputs(("warning: " + line + "\n").c_str(), stderr);
}

std::string progress_text(const ProgressState& state) {
  const double done = static_cast<double>(state.done);
  const double now = static_cast<double>(state.done - state.resumed);
  const double rate = state.elapsed_s > 0 ? now / state.elapsed_s : 0;
  const std::string speed = with_prefix(rate) + state.unit + "/s";
  if (state.finished)
    return fmt::format("{}: {}{} in {}, {}", state.label, with_prefix(now), state.unit,
                       clock_text(state.elapsed_s), speed);
  if (state.total == 0)
    return fmt::format("{}: {}{}, {}", state.label, with_prefix(done), state.unit, speed);
  const double fraction = std::min(1.0, done / static_cast<double>(state.total));
  std::string text = fmt::format("{}: {}{:3.0f} %, {}", state.label,
                                 state.with_bar ? bar(fraction) : "", 100 * fraction, speed);
  if (rate > 0)
    text += fmt::format(", {} left",
                        clock_text(std::max(0.0, static_cast<double>(state.total) - done) / rate));
  return text;
}

Progress::Progress(std::string label, std::uint64_t total, std::string unit, std::uint64_t resumed)
    : label_(std::move(label)),
      total_(total),
      unit_(std::move(unit)),
      resumed_(resumed),
      terminal_(::isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      done_(resumed),
      next_(start_ + (terminal_ ? Clock::duration(kRedraw) : Clock::duration(kFirstLine))) {}

Progress::~Progress() { finish(); }

void Progress::add(std::uint64_t units) {
  ProgressState reached;
  {
    const std::scoped_lock lock(mutex_);
    done_ += units;
    const Clock::time_point now = Clock::now();
    if (!finished_ && now >= next_) {
      show(now, false);
      next_ = terminal_ ? now + kRedraw : now + (now - start_);
    }
    if (!observer()) return;
    reached = {label_,    unit_, done_,   total_, Seconds(now - start_).count(),
               terminal_, false, resumed_};
  }
  observer()(reached);
}

void Progress::report(const std::string& line) {
  const std::scoped_lock lock(mutex_);
  const std::string text = (terminal_ ? "\r\x1b[K" : "") + line + "\n";
  std::fwrite(text.data(), 1, text.size(), stderr);
  if (!finished_ && terminal_) show(Clock::now(), false);
}

void Progress::finish() {
  const std::scoped_lock lock(mutex_);
  if (finished_) return;
  finished_ = true;
  show(Clock::now(), true);
}

void Progress::show(Clock::time_point now, bool last) const {
  if (quiet) return;
  const std::string text = progress_text(
      {label_, unit_, done_, total_, Seconds(now - start_).count(), terminal_, last, resumed_});
  // \r and "clear to the end of the line" redraw in place.
  const std::string line = terminal_ ? "\r" + text + "\x1b[K" + (last ? "\n" : "") : text + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
  std::fflush(stderr);
}

}  // namespace saccade
