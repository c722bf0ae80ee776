#include "simulator/sensor/adaptive/adaptive_tile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/sensor/adaptive/arc_signal.h"
#include "simulator/sensor/signal/linear_signal.h"

namespace saccade {
namespace {

/// Two triangles that a pixel sees one after the other within this part of a short step are the only
/// ones there: which one it sees in between is a matter of their edges alone.
constexpr double kNeighbours = 0.004;
/// A crossing is narrowed down to so many tolerances; the line through both ends is more exact by
/// far where the signal is smooth, and half of this is the error where it jumps.
constexpr double kBracketTolerances = 4;
/// The steps of a tile are this part of `max_step_px`, which is what the exact camera takes where
/// surfaces occlude one another: without proofs it is everywhere as blind.
constexpr double kStepPart = 0.5;
/// Steps are so many times as long where a tile and those around it saw no edge in the slice before:
/// what is small enough to be missed then is met by others before it comes. Where such a step finds
/// an edge after all, it is looked at in as many parts as short ones.
constexpr std::size_t kQuietSteps = 4;
/// Among edges all pixels of a tile look around in so many parts of a step, and those next to a
/// shadow are sampled: there thin things, and gaps between them, pass by. Of the events of Office
/// and Desk 0.7 and 0.9 % are missed with four parts, 0.6 and 0.8 % with eight, 0.5 and 0.8 % with
/// sixteen, which need a third more time.
constexpr std::size_t kParts = 8;
constexpr std::size_t kMostParts = kParts * kQuietSteps;
/// Within this part of a short step the edge of a shadow is located in double precision: sixteen
/// times what single precision is wrong by, so that it is within.
constexpr double kSettled = 1.0 / 16;
/// Between two samples of a glossy surface its highlight may change the radiance by this part. With
/// 0.05 of the events of plates that turn 0.956 to 0.982 come within 10 us of the exact ones, with
/// 0.02 0.976 to 0.995, with 0.005 0.980 to 1 in twice the time. A surface that turns sends a light
/// through a pixel while its image hardly moves.
constexpr double kMostFlash = 0.02;
/// Halves of steps are as long as this times what they should be, at most.
constexpr double kArcSlack = 1.01;

}  // namespace

AdaptiveTile::AdaptiveTile(const Scene& scene, const PixelRays& rays, const EventOptions& options,
                           const PixelNoise& noise, std::uint64_t seed, std::size_t index)
    : scene_(scene),
      rays_(rays),
      options_(options),
      index_(index),
      bracket_s_(kBracketTolerances * 1e-6 * options.time_tolerance_us),
      judge_(scene, bracket_s_, noise, rays.rays_per_pixel()),
      has_arcs_(rays.rays_per_pixel() == 1 && scene.flickers().empty() && !scene.has_spots()),
      is_animated_(scene.is_animated()),
      pixels_(options, noise, seed, rays.tile(index)),
      sampler_(scene, rays, options, index, statistics_) {}

void AdaptiveTile::start(const AdaptiveSlice& slice) {
  sampler_.set_poses(slice.poses);
  std::array<SampleRequest, kTilePixels> requests;
  std::array<ViewSample, kTilePixels> samples;
  for (std::size_t i = 0; i < pixels_.size(); ++i) requests[i] = {i, slice.from_s};
  sampler_.trace({requests.data(), pixels_.size()}, {samples.data(), pixels_.size()});
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    views_[i] = {samples[i], 0, false};
    pixels_.start(i, samples[i].log_intensity, slice.from_s);
  }
  update_speed(slice);
}

void AdaptiveTile::advance(const AdaptiveSlice& slice, const Surroundings& around) {
  sampler_.set_poses(slice.poses);
  const double way_px = around.speed_px_s * (slice.to_s - slice.from_s);
  const double short_px = kStepPart * options_.max_step_px;
  const double most_steps = std::max(1.0, std::ceil(way_px / short_px));
  const double steps =
      around.have_edges ? most_steps : std::ceil(most_steps / static_cast<double>(kQuietSteps));
  // An irradiance bends as no texture does: over a long step its parabola would be off by far more.
  short_step_s_ = (slice.to_s - slice.from_s) / most_steps;
  longest_arc_s_ = scene_.is_lit() ? short_step_s_ : std::numeric_limits<double>::infinity();
  has_edges_ = false;
  const double step_px = way_px / steps;
  for (double k = 1; k <= steps; ++k)
    sense_step(k == steps ? slice.to_s : std::lerp(slice.from_s, slice.to_s, k / steps), step_px);
  update_speed(slice);
}

void AdaptiveTile::update_speed(const AdaptiveSlice& slice) {
  speed_px_s_ = 0;
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const ViewSample& seen = views_[i].now;
    const Eigen::Vector3d& ray = rays_.rays(index_)[i * rays_.rays_per_pixel()];
    const CameraFrame camera = is_animated_ ? slice.poses.at(seen.t_s) : CameraFrame{};
    const Ray in_world{camera.position, camera.rotation * ray, seen.t_s};
    for (const RelativeTwists* twists : {&slice.first, &slice.last})
      speed_px_s_ =
          std::max(speed_px_s_, twists->fastest_px_s(rays_.camera(), ray, seen.distance, in_world,
                                                     seen.triangle, AdaptiveSlice::kLongest_s));
  }
}

InverseDepthRange AdaptiveTile::inverse_depths() const {
  InverseDepthRange range{std::numeric_limits<double>::infinity(), 0};
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const double distance = views_[i].now.distance;
    const double inverse = distance > 0 ? 1 / distance : 0;
    range.low = std::min(range.low, inverse);
    range.high = std::max(range.high, inverse);
  }
  return range;
}

auto AdaptiveTile::find_edges(std::span<const ViewSample> next) const -> Edges {
  const auto width = static_cast<std::size_t>(rays_.tile(index_).width);
  Edges edges;
  const auto compare = [&](const ViewSample& a, const ViewSample& b, std::size_t i, std::size_t k) {
    if (!judge_.is_one_surface(a, b)) {
      edges.of_surfaces = true;
    } else if (a.lights != b.lights) {
      edges.of_lights |= a.lights_of_ray ^ b.lights_of_ray;
      edges.of_shadows.set(i);
      edges.of_shadows.set(k);
    }
  };
  const auto compare_pixels = [&](std::size_t i, std::size_t k) {
    compare(views_[i].now, views_[k].now, i, k);
    compare(next[i], next[k], i, k);
  };
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    compare(views_[i].now, next[i], i, i);
    if (i % width + 1 < width) compare_pixels(i, i + 1);
    if (i + width < pixels_.size()) compare_pixels(i, i + width);
  }
  return edges;
}

void AdaptiveTile::sense_step(double to_s, double step_px) {
  std::array<SampleRequest, kTilePixels> requests;
  std::array<ViewSample, kTilePixels> samples;
  std::size_t count = pixels_.size();
  for (std::size_t i = 0; i < count; ++i) requests[i] = {i, to_s};
  step_s_ = to_s - views_[0].now.t_s;
  sampler_.trace({requests.data(), count}, {samples.data(), count});
  for (std::size_t i = 0; i < count; ++i) ahead_[i].push_back(samples[i]);
  sample_parts(find_edges({samples.data(), count}), step_px);
  std::size_t open = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (const std::optional<double> t_s = sense_lines(i)) requests[open++] = {i, *t_s};
  while (open > 0) {
    count = open;
    open = 0;
    sampler_.trace({requests.data(), count}, {samples.data(), count});
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = requests[k].pixel;
      ahead_[i].push_back(samples[k]);
      if (const std::optional<double> t_s = sense_lines(i)) requests[open++] = {i, *t_s};
    }
  }
}

void AdaptiveTile::sample_parts(const Edges& edges, double step_px) {
  if (!edges.of_surfaces && edges.of_shadows.none()) return;
  has_edges_ = true;
  const std::size_t parts = static_cast<std::size_t>(
      std::clamp(std::ceil(step_px / (kStepPart * options_.max_step_px) * kParts), 1.0,
                 static_cast<double>(kMostParts)));
  const double from_s = views_[0].now.t_s;
  const auto part_s = [&](std::size_t k) {
    return from_s + static_cast<double>(k) / static_cast<double>(parts) * step_s_;
  };
  // What is seen tells where another surface comes into view; only there all lights are asked for.
  const std::size_t count = pixels_.size();
  const bool is_single = sampler_.rays_per_pixel() == 1;
  std::array<std::array<TriangleId, kTilePixels>, kMostParts + 1> seen;
  std::array<std::array<LightSet, kTilePixels>, kMostParts + 1> lights;
  std::bitset<kTilePixels> on_triangle;  // next to a shadow, and seeing one triangle at both ends
  for (std::size_t i = 0; i < count; ++i) {
    const ViewSample& now = views_[i].now;
    const ViewSample& next = ahead_[i].back();
    on_triangle[i] = is_single && edges.of_shadows[i] && now.triangles == next.triangles &&
                     now.triangle != kNothing;
    for (std::size_t k = 0; k <= parts; ++k) seen[k][i] = now.triangle;
    for (std::size_t k = 0; k <= parts; ++k) lights[k][i] = now.lights_of_ray;
    seen[parts][i] = next.triangle;
    lights[parts][i] = next.lights_of_ray;
  }
  if (edges.of_surfaces && is_single)
    for (std::size_t k = 1; k < parts; ++k) sampler_.look(part_s(k), {seen[k].data(), count});
  for (std::size_t k = 1; k < parts; ++k) look_at_shadows(edges, on_triangle, part_s(k), lights[k]);
  std::array<SampleRequest, kTilePixels> requests;
  std::array<ViewSample, kTilePixels> samples;
  for (std::size_t k = parts - 1; k > 0; --k) {  // the latest first, as they are taken
    std::size_t open = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_change = is_single
                                 ? seen[k][i] != seen[k - 1][i] || seen[k][i] != seen[k + 1][i]
                                 : edges.of_surfaces;
      if (is_change || (edges.of_shadows[i] && !on_triangle[i]))
        requests[open++] = {i, part_s(k)};
      else if (on_triangle[i] && seen[k][i] == views_[i].now.triangle &&
               (lights[k][i] != lights[k - 1][i] || lights[k][i] != lights[k + 1][i]))
        ahead_[i].push_back(sampler_.resample({i, part_s(k)}, views_[i].now, lights[k][i]));
    }
    sampler_.trace({requests.data(), open}, {samples.data(), open});
    for (std::size_t m = 0; m < open; ++m) ahead_[requests[m].pixel].push_back(samples[m]);
  }
}

void AdaptiveTile::look_at_shadows(const Edges& edges, const std::bitset<kTilePixels>& pixels,
                                   double t_s, std::span<LightSet> lights) {
  std::array<SampleRequest, kTilePixels> requests;
  std::array<const ViewSample*, kTilePixels> like;
  std::array<LightSet, kTilePixels> among, found;
  std::size_t count = 0;
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    if (!pixels[i]) continue;
    requests[count] = {i, t_s};
    like[count] = &views_[i].now;
    among[count++] = edges.of_lights;
  }
  if (count == 0) return;
  sampler_.look_at_lights({requests.data(), count}, {like.data(), count}, {among.data(), count},
                          {found.data(), count});
  for (std::size_t k = 0; k < count; ++k) lights[requests[k].pixel] = found[k];
}

std::optional<double> AdaptiveTile::sense_lines(std::size_t i) {
  SignalSoFar& pixel = views_[i];
  std::vector<ViewSample>& ahead = ahead_[i];
  while (!ahead.empty()) {
    if (is_animated_ && is_arc(pixel.now, ahead.back()))
      if (const auto kink_s = judge_.first_kink_s(pixel.now, ahead.back())) {
        ahead.push_back(sampler_.resample({i, *kink_s}, pixel.now));
        continue;
      }
    if (may_flash(i, pixel.now, ahead.back())) {
      const double middle_s = 0.5 * (pixel.now.t_s + ahead.back().t_s);
      if (ahead.back().t_s - pixel.now.t_s <= bracket_s_) {
        sense_line(i, pixel, ahead.back());
        ahead.pop_back();
      } else if (sampler_.rays_per_pixel() > 1) {
        return middle_s;
      } else {
        ahead.push_back(sampler_.resample({i, middle_s}, pixel.now));
      }
      continue;
    }
    if (is_arc(pixel.now, ahead.back())) {
      if (sense_arc(i, pixel, ahead.back())) {
        ahead.pop_back();
      } else {
        const double middle_s = 0.5 * (pixel.now.t_s + ahead.back().t_s);
        ahead.push_back(sampler_.resample({i, middle_s}, pixel.now));
      }
      continue;
    }
    if (settle_lights(i, pixel.now, ahead.back())) continue;
    const ViewSample next = ahead.back();
    const LineJudgement judgement = judge_.judge(pixel, next, pixels_.refractory_until_s(i),
                                                 pixels_.thresholds(i), short_step_s_);
    if (judgement.is_line) {
      sense_line(i, pixel, next);
      ahead.pop_back();
    } else if (!judgement.needs_ray) {
      ahead.push_back(sampler_.resample({i, judgement.t_s}, next));
    } else {
      std::optional<ViewSample> sample = resample_settled(i, judgement.t_s, pixel.now, next);
      if (!sample && are_neighbours(pixel.now, next))
        sample = sampler_.resample({i, judgement.t_s}, pixel.now, next);
      if (!sample) return judgement.t_s;
      ahead.push_back(*sample);
    }
  }
  return std::nullopt;
}

bool AdaptiveTile::settle_lights(std::size_t i, ViewSample& from, ViewSample& to) {
  const LightSet lights = from.lights_of_ray ^ to.lights_of_ray;
  if ((lights & ~(from.settled & to.settled)) == 0 || sampler_.rays_per_pixel() > 1 ||
      to.t_s - from.t_s > kSettled * short_step_s_ || from.triangles != to.triangles)
    return false;
  if (!sampler_.find_lights_between(i, from, to, lights)) return false;
  // What has been sensed stands: where double precision sees it otherwise, rays go on.
  ViewSample known = from;
  sampler_.settle_lights(i, lights, known);
  if (known.lights_of_ray != from.lights_of_ray) return false;
  sampler_.settle_lights(i, lights, to);
  from.settled |= lights;
  return true;
}

std::optional<ViewSample> AdaptiveTile::resample_settled(std::size_t i, double t_s,
                                                         const ViewSample& from,
                                                         const ViewSample& to) {
  const LightSet lights = from.lights_of_ray ^ to.lights_of_ray;
  if (lights == 0 || (lights & ~(from.settled & to.settled)) != 0 || from.triangles != to.triangles)
    return std::nullopt;
  if (!sampler_.find_lights_between(i, from, to, lights)) return std::nullopt;
  ViewSample sample = sampler_.resample({i, t_s}, from);
  sampler_.settle_lights(i, lights, sample);
  return sample;
}

bool AdaptiveTile::is_arc(const ViewSample& from, const ViewSample& to) const {
  return from.triangles == to.triangles && from.lights == to.lights && from.triangle != kNothing &&
         has_arcs_ && !scene_.has_normal_map(from.triangle);
}

bool AdaptiveTile::may_flash(std::size_t i, const ViewSample& from, const ViewSample& to) {
  return scene_.is_glossy(from.triangle) && from.triangle == to.triangle &&
         from.lights_of_ray == to.lights_of_ray && from.distance > 0 && to.distance > 0 &&
         sampler_.mirrored_span(i, from, to) >
             kMostFlash * (options_.log_eps + std::min(from.radiance, to.radiance));
}

bool AdaptiveTile::sense_arc(std::size_t i, SignalSoFar& pixel, const ViewSample& next) {
  const double length_s = next.t_s - pixel.now.t_s;
  if (pixels_.is_idle(i, pixel.now.t_s, next.t_s) &&
      LineJudge::is_quiet(pixel, next, pixels_.thresholds(i))) {
    pixel.before_s = (next.log_intensity - pixel.now.log_intensity) / length_s;
  } else if (length_s > kArcSlack * longest_arc_s_) {
    return false;
  } else {
    const SurfaceArc arc = sampler_.arc(i, pixel.now, next);
    if (!arc.is_smooth()) {
      if (length_s > bracket_s_) return false;
      sense_line(i, pixel, next);
      return true;
    }
    const ArcSignal signal(arc, options_.log_eps, 1e-6 * options_.time_tolerance_us);
    pixels_.sense(i, signal, {pixel.now.t_s, pixel.now.radiance, pixel.now.log_intensity},
                  {next.t_s, next.radiance, next.log_intensity});
    const double last_s = 0.25 * length_s;
    pixel.before_s = (next.log_intensity - signal.at(next.t_s - last_s).log_intensity) / last_s;
    pixel.has_slope = true;
  }
  pixel.now = next;
  return true;
}

bool AdaptiveTile::are_neighbours(const ViewSample& a, const ViewSample& b) const {
  return sampler_.rays_per_pixel() == 1 && a.triangle != b.triangle &&
         b.t_s - a.t_s <= kNeighbours * short_step_s_;
}

void AdaptiveTile::sense_line(std::size_t i, SignalSoFar& pixel, const ViewSample& next) {
  const LinearSample from{pixel.now.t_s, pixel.now.log_intensity};
  const LinearSample to{next.t_s, next.log_intensity};
  const Thresholds& thresholds = pixels_.thresholds(i);
  if (pixels_.is_noisy() || !thresholds.band().contains(thresholds.signal(to)))
    pixels_.sense(i, LinearSignal(options_.log_eps, 1e-6 * options_.time_tolerance_us), from, to);
  pixel.has_slope = judge_.is_continuous(pixel.now, next) &&
                    !first_jump(scene_.flickers(), pixel.now.t_s, next.t_s);
  if (pixel.has_slope)
    pixel.before_s = (to.log_intensity - from.log_intensity) / (to.t_s - from.t_s);
  pixel.now = next;
}

void AdaptiveTile::save(StateWriter& state) const {
  for (std::size_t i = 0; i < pixels_.size(); ++i) state.value(views_[i]);
  pixels_.save(state);
  state.value(speed_px_s_);
  state.value(has_edges_);
  state.value(statistics_);
}

void AdaptiveTile::load(StateReader& state) {
  for (std::size_t i = 0; i < pixels_.size(); ++i) state.value(views_[i]);
  pixels_.load(state);
  state.value(speed_px_s_);
  state.value(has_edges_);
  state.value(statistics_);
}

}  // namespace saccade
