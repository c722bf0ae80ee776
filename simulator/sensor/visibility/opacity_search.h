#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace saccade {

/// An interval of time in which a triangle that is cut out stops a ray or lets it through.
struct OpacityInterval {
  double from_s, to_s;
  bool is_opaque;
};

/// How opaque a cut-out is where a ray intersects it.
struct OpacitySample {
  double t_s;
  double opacity;

  [[nodiscard]] bool is_opaque() const { return opacity >= 0.5; }
  [[nodiscard]] double excess() const { return opacity - 0.5; }
};

/// Finds when an opacity passes 0.5 from its values at equal steps, and from its extrema next to
/// 0.5, where it may graze that between two steps. Of two extrema within two steps one may be
/// missed.
template <class Opacity>
class OpacitySearch {
 public:
  /// `opacity(t_s)` between two samples at it.
  OpacitySearch(const Opacity& opacity, const OpacitySample& from, const OpacitySample& to,
                std::size_t steps)
      : opacity_(opacity) {
    const double step_s = (to.t_s - from.t_s) / static_cast<double>(steps);
    samples_.reserve(steps + 1);
    samples_.push_back(from);
    for (std::size_t k = 1; k < steps; ++k)
      samples_.push_back(sample(from.t_s + static_cast<double>(k) * step_s));
    samples_.push_back(to);
  }

  /// All intervals, in order.
  [[nodiscard]] std::vector<OpacityInterval> intervals() const {
    const auto is_earlier = [](const auto& a, const auto& b) { return a.t_s < b.t_s; };
    OpacitySample last = samples_.front();
    std::vector<OpacityInterval> found{{last.t_s, last.t_s, last.is_opaque()}};
    const auto go_to = [&](const OpacitySample& next) {
      if (next.t_s <= last.t_s) return;
      if (next.is_opaque() != last.is_opaque()) {
        const double fraction = last.excess() / (last.excess() - next.excess());
        found.back().to_s = last.t_s + fraction * (next.t_s - last.t_s);
        found.push_back({found.back().to_s, next.t_s, next.is_opaque()});
      }
      found.back().to_s = next.t_s;
      last = next;
    };
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      const OpacitySample& before = samples_[k == 0 ? 0 : k - 1];
      const OpacitySample& after = samples_[std::min(k + 1, samples_.size() - 1)];
      if (may_graze(before, samples_[k], after)) {
        const OpacitySample peak = extremum(before.t_s, after.t_s, samples_[k].is_opaque());
        go_to(std::min(peak, samples_[k], is_earlier));
        go_to(std::max(peak, samples_[k], is_earlier));
      }
      go_to(samples_[k]);
    }
    return found;
  }

 private:
  [[nodiscard]] OpacitySample sample(double t_s) const { return {t_s, opacity_(t_s)}; }

  /// Whether the opacity turns next to `middle` and would, as steep as it is, get to 0.5 before.
  [[nodiscard]] static bool may_graze(const OpacitySample& before, const OpacitySample& middle,
                                      const OpacitySample& after) {
    if (before.is_opaque() != middle.is_opaque() || after.is_opaque() != middle.is_opaque())
      return false;
    const double from = std::abs(before.excess()), at = std::abs(middle.excess()),
                 to = std::abs(after.excess());
    return at <= std::min(from, to) && 2 * at < std::max(from, to);
  }

  /// The lowest opacity between two times, or the highest; by golden sections, up to the first
  /// sample beyond 0.5.
  [[nodiscard]] OpacitySample extremum(double from_s, double to_s, bool is_lowest) const {
    constexpr int kSections = 20;
    constexpr double kGolden = 0.6180339887498949;
    const auto is_better = [&](const OpacitySample& a, const OpacitySample& b) {
      return is_lowest ? a.excess() < b.excess() : a.excess() > b.excess();
    };
    OpacitySample a = sample(to_s - kGolden * (to_s - from_s));
    OpacitySample b = sample(from_s + kGolden * (to_s - from_s));
    for (int k = 0; k < kSections; ++k) {
      if (a.is_opaque() != is_lowest) return a;
      if (b.is_opaque() != is_lowest) return b;
      if (is_better(a, b)) {
        to_s = b.t_s;
        b = a;
        a = sample(to_s - kGolden * (to_s - from_s));
      } else {
        from_s = a.t_s;
        a = b;
        b = sample(from_s + kGolden * (to_s - from_s));
      }
    }
    return is_better(a, b) ? a : b;
  }

  const Opacity& opacity_;
  std::vector<OpacitySample> samples_;
};

}  // namespace saccade
