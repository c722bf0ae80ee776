#pragma once

#include <algorithm>

#include "simulator/sensor/noise/filtered_piece.h"
#include "simulator/sensor/noise/radiance.h"

namespace saccade {
namespace config {
class Fields;
}

/// The photoreceptor as a low pass of the log intensity with one pole or two equal ones, whose
/// cutoff grows with the photocurrent (Lichtsteiner et al. 2008, Hu et al. 2021):
///   f_c(I) = min(max_cutoff_hz, cutoff_hz (I + dark_radiance) / (bright_radiance + dark_radiance))
struct BandwidthOptions {
  double cutoff_hz = 0;
  int order = 1;
  double bright_radiance = 1;
  double dark_radiance = 0.08;  ///< stands for the dark current: keeps f_c > 0 at I = 0
  double max_cutoff_hz = 1e5;

  [[nodiscard]] bool on() const { return cutoff_hz > 0; }
};
void describe(config::Fields& fields, BandwidthOptions& options);

/// The low pass of the photoreceptor (formula at BandwidthOptions): with w = 2 pi f_c(I)
///   order 1: y' = w (x - y)        order 2: y1' = w (x - y1),  y' = w (y1 - y)
/// on the log intensity x, which is given in pieces that are linear in time; a piece has the cutoff
/// of its middle. Each piece is solved in closed form, so the result depends on the pieces' error
/// alone: where the pieces are within d of the true signal and the cutoff within a fraction r of
/// the true one, the output is within d + r max|x - y| per stage of the exact one, since every
/// stage averages its input with positive weights. For the same reason the output never leaves the
/// hull of the state and the inputs since. A jump of the signal is a gap between the values of two
/// pieces. Thread-safe.
class PhotoreceptorFilter {
 public:
  /// `log_eps`: eps of L = ln(eps + I).
  PhotoreceptorFilter(const BandwidthOptions& options, double log_eps);

  [[nodiscard]] bool on() const { return options_.on(); }

  /// f_c(I) [Hz].
  [[nodiscard]] double cutoff_hz(double log_intensity) const;
  /// For how long the output remembers [s], at radiances of at least `least`: kMemory time
  /// constants of the slowest. Two outputs of the same input that were d apart, and their first
  /// stages too, are (1 + kMemory) e^-kMemory d apart then, which is d / 2000.
  [[nodiscard]] double memory_s(double least) const;
  /// The state of a pixel that has seen one intensity for long.
  [[nodiscard]] static FilterState settled(double log_intensity) {
    return {log_intensity, log_intensity};
  }
  /// The output over a piece that `state` enters; on() must hold.
  [[nodiscard]] FilteredPiece piece(const FilterState& state, const LinearPiece& input) const {
    return piece(state, input, radiance_from_log(0.5 * (input.start + input.end), log_eps_));
  }
  /// The same where the radiance of its middle is known.
  [[nodiscard]] FilteredPiece piece(const FilterState& state, const LinearPiece& input,
                                    double middle_radiance) const {
    return {state, input, rate_at(middle_radiance), options_.order};
  }

 private:
  static constexpr double kMemory = 10;

  /// 2 pi f_c [1/s]; never so small that it is nothing.
  [[nodiscard]] double rate_at(double radiance) const {
    constexpr double kLeast = 1e-9;
    return std::clamp(rate_per_radiance_ * (radiance + options_.dark_radiance), kLeast, max_rate_);
  }

  BandwidthOptions options_;
  double log_eps_;
  double rate_per_radiance_, max_rate_;
};

}  // namespace saccade
