#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <tuple>

#include "core/error.h"
#include "core/io/events/events_h5.h"

namespace saccade {
namespace {

class EventH5Blocks final : public EventReader {
 public:
  EventH5Blocks(const std::filesystem::path& file, SensorSize size, TimeWindow window)
      : name_(file.string()),
        reader_(file),
        size_(size),
        info_(reader_.info()),
        block_(reader_.block_events()) {
    std::tie(next_, end_) = reader_.range(window);
  }

  bool read(Events& events) override {
    if (next_ == end_) return false;
    const std::size_t before = events.size();
    const std::uint64_t block_end = std::min(end_, (next_ / block_ + 1) * block_);
    reader_.append(next_, block_end, size_, events);
    if (events[before].t_ns < last_ns_)
      throw InputError(fmt::format("{}:/events/t[{}]", name_, next_), "time goes back");
    last_ns_ = events.back().t_ns;
    next_ = block_end;
    return true;
  }

  [[nodiscard]] SensorSize sensor() const override { return info_.sensor; }
  [[nodiscard]] TimestampUnit unit() const override { return info_.unit; }
  [[nodiscard]] std::uint64_t expected_count() const override { return end_ - next_; }

 private:
  std::string name_;
  EventH5Reader reader_;
  SensorSize size_;
  EventFileInfo info_;
  std::uint64_t block_;
  std::uint64_t next_ = 0;
  std::uint64_t end_ = 0;
  TimeNs last_ns_ = std::numeric_limits<TimeNs>::min();
};

}  // namespace

std::unique_ptr<EventReader> open_events_h5(const std::filesystem::path& file, SensorSize size,
                                            TimeWindow window) {
  return std::make_unique<EventH5Blocks>(file, size, window);
}

}  // namespace saccade
