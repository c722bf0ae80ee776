#include "estimator/depth/depth_stream.h"

#include <algorithm>
#include <utility>

#include "core/check.h"

namespace saccade {

DepthStream::DepthStream(const DepthEstimator& estimator, double window_s, double reference_share,
                         Sink sink)
    : estimator_(estimator),
      window_ns_(ns_from_seconds(window_s)),
      reference_share_(reference_share),
      sink_(std::move(sink)) {
  SACCADE_CHECK(window_ns_ > 0 && reference_share >= 0 && reference_share <= 1);
}

void DepthStream::push(std::span<const Event> events, const Trajectory& trajectory) {
  while (!events.empty()) {
    const TimeNs start_ns = events_.empty() ? events.front().t_ns : events_.front().t_ns;
    const TimeNs end_ns = start_ns + window_ns_;
    const auto end = std::partition_point(events.begin(), events.end(),
                                          [end_ns](const Event& e) { return e.t_ns < end_ns; });
    events_.insert(events_.end(), events.begin(), end);
    if (end == events.end()) return;
    estimate(trajectory, seconds_from_ns(end_ns));
    events = events.subspan(static_cast<std::size_t>(end - events.begin()));
  }
}

void DepthStream::finish(const Trajectory& trajectory) {
  if (!events_.empty()) estimate(trajectory, seconds_from_ns(events_.back().t_ns));
}

void DepthStream::estimate(const Trajectory& trajectory, double end_s) {
  const double start_s = seconds_from_ns(events_.front().t_ns);
  const double reference_s = start_s + reference_share_ * (end_s - start_s);
  sink_(reference_s, estimator_.estimate({events_, &trajectory, reference_s}));
  events_.clear();
}

}  // namespace saccade
