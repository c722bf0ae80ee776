#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace saccade {

/// A stretch of time in which a triangle that is cut out stops a ray or lets it through.
struct OpaqueStretch {
  double from_s, to_s;
  bool is_opaque;
};

/// How opaque a cut-out is where a ray meets it.
struct OpacityLook {
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
  /// `opacity(t_s)` between two looks at it.
  OpacitySearch(const Opacity& opacity, const OpacityLook& from, const OpacityLook& to,
                std::size_t steps)
      : opacity_(opacity) {
    const double step_s = (to.t_s - from.t_s) / static_cast<double>(steps);
    looks_.reserve(steps + 1);
    looks_.push_back(from);
    for (std::size_t k = 1; k < steps; ++k)
      looks_.push_back(look(from.t_s + static_cast<double>(k) * step_s));
    looks_.push_back(to);
  }

  /// All stretches, in order.
  [[nodiscard]] std::vector<OpaqueStretch> stretches() const {
    const auto is_earlier = [](const auto& a, const auto& b) { return a.t_s < b.t_s; };
    OpacityLook last = looks_.front();
    std::vector<OpaqueStretch> found{{last.t_s, last.t_s, last.is_opaque()}};
    const auto go_to = [&](const OpacityLook& next) {
      if (next.t_s <= last.t_s) return;
      if (next.is_opaque() != last.is_opaque()) {
        const double share = last.excess() / (last.excess() - next.excess());
        found.back().to_s = last.t_s + share * (next.t_s - last.t_s);
        found.push_back({found.back().to_s, next.t_s, next.is_opaque()});
      }
      found.back().to_s = next.t_s;
      last = next;
    };
    for (std::size_t k = 0; k < looks_.size(); ++k) {
      const OpacityLook& before = looks_[k == 0 ? 0 : k - 1];
      const OpacityLook& after = looks_[std::min(k + 1, looks_.size() - 1)];
      if (may_graze(before, looks_[k], after)) {
        const OpacityLook peak = extremum(before.t_s, after.t_s, looks_[k].is_opaque());
        go_to(std::min(peak, looks_[k], is_earlier));
        go_to(std::max(peak, looks_[k], is_earlier));
      }
      go_to(looks_[k]);
    }
    return found;
  }

 private:
  [[nodiscard]] OpacityLook look(double t_s) const { return {t_s, opacity_(t_s)}; }

  /// Whether the opacity turns next to `middle` and would, as steep as it is, get to 0.5 before.
  [[nodiscard]] static bool may_graze(const OpacityLook& before, const OpacityLook& middle,
                                      const OpacityLook& after) {
    if (before.is_opaque() != middle.is_opaque() || after.is_opaque() != middle.is_opaque())
      return false;
    const double from = std::abs(before.excess()), at = std::abs(middle.excess()),
                 to = std::abs(after.excess());
    return at <= std::min(from, to) && 2 * at < std::max(from, to);
  }

  /// The lowest opacity between two times, or the highest; by golden sections, up to the first look
  /// beyond 0.5.
  [[nodiscard]] OpacityLook extremum(double from_s, double to_s, bool is_lowest) const {
    constexpr int kSections = 20;
    constexpr double kGolden = 0.6180339887498949;
    const auto is_better = [&](const OpacityLook& a, const OpacityLook& b) {
      return is_lowest ? a.excess() < b.excess() : a.excess() > b.excess();
    };
    OpacityLook a = look(to_s - kGolden * (to_s - from_s));
    OpacityLook b = look(from_s + kGolden * (to_s - from_s));
    for (int k = 0; k < kSections; ++k) {
      if (a.is_opaque() != is_lowest) return a;
      if (b.is_opaque() != is_lowest) return b;
      if (is_better(a, b)) {
        to_s = b.t_s;
        b = a;
        a = look(to_s - kGolden * (to_s - from_s));
      } else {
        from_s = a.t_s;
        a = b;
        b = look(from_s + kGolden * (to_s - from_s));
      }
    }
    return is_better(a, b) ? a : b;
  }

  const Opacity& opacity_;
  std::vector<OpacityLook> looks_;
};

}  // namespace saccade
