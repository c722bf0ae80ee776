#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "simulator/motion/spline_table.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/adaptive/line_judge.h"
#include "simulator/sensor/adaptive/view_sampler.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/motion/image_motion.h"
#include "simulator/sensor/motion/object_motion.h"
#include "simulator/sensor/noise/state_bytes.h"
#include "simulator/sensor/pixel/pixel_bank.h"
#include "simulator/sensor/pixel/pixel_noise.h"
#include "simulator/sensor/rays/pixel_rays.h"

namespace saccade {

/// The camera during a slice, as all tiles share it.
struct AdaptiveSlice {
  const SplineTable& poses;  ///< cover it
  double from_s, to_s;
  const RelativeTwists& first;  ///< at its start
  const RelativeTwists& last;   ///< and at its end

  /// Image speeds are those at both ends of a slice, and an arc is at most as long: longer ones
  /// would miss how hand-held motion turns in between. Four times shorter ones took up to twice the
  /// rays.
  static constexpr double kLongest_s = 0.02;
};

/// What a tile and those around it have come to see: no tile knows of what comes in from another.
struct Surroundings {
  double speed_px_s = 0;   ///< of what moves fastest over the image
  bool have_edges = true;  ///< of surfaces or shadows
};

/// 4 x 4 event pixels that are sampled with rays: all of them after every half
/// `max_step_px` of image motion, four times as rarely far from all edges, and each in between where
/// it comes to see another surface or another light. While it sees one triangle, its signal is an
/// arc, else lines.
class AdaptiveTile {
 public:
  /// All outlive the tile.
  AdaptiveTile(const Scene& scene, const PixelRays& rays, const EventOptions& options,
               const PixelNoise& noise, std::uint64_t seed, std::size_t index);

  /// Sets the pixels' references to the signal at the start of the slice.
  void start(const AdaptiveSlice& slice);
  /// Senses to the end of the slice. `around`: as all tiles were at its start.
  void advance(const AdaptiveSlice& slice, const Surroundings& around);

  /// How fast what the pixels see now moves over the image, at most [px/s].
  [[nodiscard]] double speed_px_s() const { return speed_px_s_; }
  /// Whether they saw an edge of a surface or of a shadow in the last slice.
  [[nodiscard]] bool has_edges() const { return has_edges_; }
  /// Of the surfaces that they see now.
  [[nodiscard]] InverseDepthRange inverse_depths() const;

  /// Moves out the events found since the last call; times rounded to the unit.
  void take_events(SensedEvents& out) { pixels_.take_events(out); }
  [[nodiscard]] const EventStatistics& statistics() const { return statistics_; }

  void save(StateWriter& state) const;
  void load(StateReader& state);

 private:
  /// Among what the pixels see now and at the end of a step.
  struct Edges {
    bool of_surfaces = false;
    std::bitset<kTilePixels> of_shadows;  ///< the pixels next to one
    LightSet of_lights = 0;               ///< whose shadows end there
  };
  /// `step_px`: how far the image moves until then, at most.
  void sense_step(double to_s, double step_px);
  [[nodiscard]] Edges find_edges(std::span<const ViewSample> next) const;
  /// Samples the pixels within the step where there are edges.
  void sample_parts(const Edges& edges, double step_px);
  /// The lights of some pixels at `t_s` if they see the same triangles as now.
  void look_at_shadows(const Edges& edges, const std::bitset<kTilePixels>& pixels, double t_s,
                       std::span<LightSet> lights);
  /// Senses pixel `i` up to its next samples, latest first in ahead_[i], as far as their lines are
  /// good; the time of the sample that is missing where one is not.
  [[nodiscard]] std::optional<double> sense_lines(std::size_t i);
  /// Whether nothing but the triangles of two samples can be seen between them.
  [[nodiscard]] bool are_neighbours(const ViewSample& a, const ViewSample& b) const;
  /// Settles which lights light the later of two samples of one triangle, where that is not known
  /// well enough for the time between them; whether there was anything to settle.
  [[nodiscard]] bool settle_lights(std::size_t i, ViewSample& from, ViewSample& to);
  /// Between two such samples that have been settled.
  [[nodiscard]] std::optional<ViewSample> resample_settled(std::size_t i, double t_s,
                                                           const ViewSample& from,
                                                           const ViewSample& to);
  void sense_line(std::size_t i, SignalSoFar& pixel, const ViewSample& next);
  /// Whether all between two samples follows from what both see.
  [[nodiscard]] bool is_arc(const ViewSample& from, const ViewSample& to) const;
  /// Whether the highlight of a glossy surface may pass between two samples.
  [[nodiscard]] bool may_flash(std::size_t i, const ViewSample& from, const ViewSample& to);
  /// Senses pixel `i`, which sees one triangle up to its next sample. False where that needs more
  /// samples in between.
  [[nodiscard]] bool sense_arc(std::size_t i, SignalSoFar& pixel, const ViewSample& next);
  void update_speed(const AdaptiveSlice& slice);

  const Scene& scene_;
  const PixelRays& rays_;
  const EventOptions& options_;
  std::size_t index_;
  double bracket_s_;
  LineJudge judge_;
  bool has_arcs_;     ///< one ray per pixel, and light without flicker and cones
  bool is_animated_;  ///< the corners of some triangles move in their body
  PixelBank pixels_;
  EventStatistics statistics_;
  ViewSampler sampler_;
  std::array<SignalSoFar, kTilePixels> views_;
  double speed_px_s_ = 0;
  bool has_edges_ = true;
  double step_s_ = 0;                                       ///< length of the step at work
  double short_step_s_ = 0;                                 ///< of a step among edges
  double longest_arc_s_ = 0;                                ///< of the slice at work
  std::array<std::vector<ViewSample>, kTilePixels> ahead_;  ///< scratch, empty between two steps
};

}  // namespace saccade
