#include "apps/calibration.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>

#include "core/blind_time.h"
#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/scratch_folder.h"
#include "eval/calibration/noise_rates.h"
#include "eval/table/number_text.h"
#include "simulator/replica/effective_contrast.h"
#include "simulator/replica/resimulation.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

/// What the events of all recordings tell without any simulation.
struct EventFindings {
  BlindTime blind;
  CountedRate on, off;
  double pixel_seconds = 0;
  std::size_t pixels = 0;
  std::vector<NoiseRates> noise;  ///< of each recording
};

EventFindings findings_of(const CalibrationRequest& request) {
  EventFindings found;
  std::vector<double> gaps;
  std::size_t on = 0, off = 0;
  for (const fs::path& path : request.recordings) {
    const EventRecording recording = read_recording(path, request.replica.part);
    const Events& events = recording.events;
    if (events.size() < 2 || events.front().t_ns == events.back().t_ns)
      throw InputError(path.string(), "holds no two events at different times in this part");
    const std::vector<double> own = event_gaps_us(events, recording.size);
    gaps.insert(gaps.end(), own.begin(), own.end());
    found.noise.push_back(noise_rates(events, recording.size));
    const NoiseRates& noise = found.noise.back();
    if (noise.is_told) {
      on += noise.on.count;
      off += noise.off.count;
      found.pixel_seconds += noise.pixel_seconds;
    }
    found.pixels += static_cast<std::size_t>(recording.size.width) *
                    static_cast<std::size_t>(recording.size.height);
  }
  std::sort(gaps.begin(), gaps.end());
  found.blind = blind_time(gaps);
  if (found.pixel_seconds > 0) {
    found.on = counted_rate(on, found.pixel_seconds);
    found.off = counted_rate(off, found.pixel_seconds);
  }
  return found;
}

void put_blind_time(const BlindTime& blind, SensorFile& sensor) {
  const char* const kName = "refractory.period_us";
  if (!blind.us) {
    sensor.remarks[kName] = fmt::format("not told: {} short gaps show no floor, it is below {} us",
                                        blind.gaps, significant(blind.high_us));
    return;
  }
  sensor.events.refractory_us = blind.us;
  sensor.intervals[kName] = {blind.low_us, blind.high_us};
  sensor.remarks[kName] = fmt::format("floor of the {} shortest gaps", blind.gaps);
}

void put_hot_pixels(const EventFindings& found, SensorFile& sensor) {
  std::vector<double> logs;
  for (const NoiseRates& noise : found.noise)
    for (const NoiseRates::HotPixel& pixel : noise.hot) logs.push_back(std::log(pixel.hz));
  sensor.events.hot_fraction = static_cast<double>(logs.size()) / static_cast<double>(found.pixels);
  sensor.remarks["hot.fraction"] =
      fmt::format("{} of {} pixels; those that fire less often than the part is long do not show",
                  logs.size(), found.pixels);
  if (logs.empty()) return;
  const auto n = static_cast<double>(logs.size());
  const double mean = std::accumulate(logs.begin(), logs.end(), 0.0) / n;
  double squares = 0;
  for (const double log : logs) squares += (log - mean) * (log - mean);
  sensor.events.hot_hz = std::exp(mean);
  sensor.events.hot_sigma = std::min(1.0, std::sqrt(squares / n));
}

/// `radiance`: mean of the frames, on which the model's shot noise depends; nullopt: not known.
void put_noise(const EventFindings& found, std::optional<double> radiance, SensorFile& sensor) {
  if (found.pixel_seconds <= 0) {
    for (const char* name : {"shot.rate_hz", "leak.rate_hz"})
      sensor.remarks[name] = "not told: something moves everywhere; record a camera at rest";
    return;
  }
  // Both count events that weak texture causes where the camera moves: not more than this.
  sensor.noise_on_hz = found.on.hz;
  sensor.noise_off_hz = found.off.hz;
  sensor.intervals["measured.noise_on_hz"] = {found.on.low_hz, found.on.high_hz};
  sensor.intervals["measured.noise_off_hz"] = {found.off.low_hz, found.off.high_hz};
  const NoiseRates& last = found.noise.back();
  const std::string basis =
      fmt::format("{} ON and {} OFF events without another within {} px and {:.0f} ms",
                  found.on.count, found.off.count, last.reach_px, 1e3 * last.reach_s);
  sensor.remarks["measured.noise_on_hz"] = basis;
  // ShotOptions: a quarter of the rate in the dark remains at radiance 1.
  const double brightness = 1 - 0.75 * std::min(1.0, radiance.value_or(0));
  const auto to_shot = [&](double off_hz) { return 2 * off_hz / brightness; };
  sensor.events.shot_hz = to_shot(found.off.hz);
  sensor.intervals["shot.rate_hz"] = {to_shot(found.off.low_hz), to_shot(found.off.high_hz)};
  sensor.remarks["shot.rate_hz"] =
      radiance ? fmt::format("twice the OFF noise, at the frames' mean radiance {}",
                             significant(*radiance))
               : "twice the OFF noise: the rate in the dark is more, by a factor that only the "
                 "light of the scene tells";
  const double leak = found.on.hz - found.off.hz;
  const double half = std::hypot(found.on.high_hz - found.on.hz, found.off.high_hz - found.off.hz);
  sensor.events.leak_hz = std::max(0.0, leak);
  sensor.intervals["leak.rate_hz"] = {std::max(0.0, leak - half), std::max(0.0, leak + half)};
  sensor.remarks["leak.rate_hz"] = "ON noise less OFF noise";
}

/// A stretch that can be simulated again; in memory, from the files of its replica.
struct Repeater {
  ReplicaStretch stretch;
  std::unique_ptr<Resimulation> resimulation;

  [[nodiscard]] SensedEvents sensed(const SensorParameters& sensor) const {
    SensedEvents events = resimulation->events(sensor);
    const TimeNs warm_up_ns = ns_from_seconds(stretch.source.warm_up_s);
    std::erase_if(events, [&](const SensedEvent& e) {
      return e.t_ns < warm_up_ns || stretch.comparable(e.x, e.y) == 0;
    });
    for (SensedEvent& event : events) event.t_ns -= warm_up_ns;
    return events;
  }
  [[nodiscard]] Events events(const SensorParameters& sensor) const {
    Events plain;
    for (const SensedEvent& event : sensed(sensor)) plain.push_back(event.event());
    return plain;
  }
};

SimulationConfig read_simulation(const fs::path& folder, std::uint64_t seed) {
  const std::vector<std::string> overrides{fmt::format("seed={}", seed)};
  return config::read<SimulationConfig>(config::load(folder / "simulation.yaml", overrides));
}

void leave_out_hot_pixels(const NoiseRates& noise, ReplicaStretch& stretch) {
  for (const NoiseRates::HotPixel& pixel : noise.hot) {
    stretch.comparable(pixel.x, pixel.y) = 0;
    std::erase_if(stretch.events, [&](const Event& e) { return e.x == pixel.x && e.y == pixel.y; });
  }
}

std::vector<Repeater> make_repeaters(const CalibrationRequest& request, const EventFindings& found,
                                     std::vector<std::string>& remarks) {
  /// With fewer events a stretch says little and may break what others say.
  constexpr std::size_t kLeastEvents = 500;
  std::vector<Repeater> repeaters;
  for (std::size_t i = 0; i < request.recordings.size(); ++i)
    for (ReplicaStretch& stretch :
         replica_stretches(request.recordings[i], request.replica, remarks)) {
      leave_out_hot_pixels(found.noise[i], stretch);
      if (stretch.events.size() < kLeastEvents) {
        remarks.push_back(stretch.name + ": too few events to compare");
        continue;
      }
      const ScratchFolder scratch;
      write_replica(stretch.source, scratch.path());
      repeaters.push_back({std::move(stretch), std::make_unique<Resimulation>(
                                                   read_simulation(scratch.path(), request.seed))});
    }
  return repeaters;
}

double mean_radiance(std::span<const Repeater> repeaters) {
  double sum = 0;
  for (const Repeater& repeater : repeaters) {
    const auto pixels = repeater.stretch.source.radiance.pixels();
    sum += std::accumulate(pixels.begin(), pixels.end(), 0.0) / static_cast<double>(pixels.size());
  }
  return sum / static_cast<double>(repeaters.size());
}

/// Where the search for what the events alone did not tell begins.
SensorParameters start_of(const SensorFile& sensor) {
  SensorParameters start = sensor.events;
  start.hot_fraction = 0;  // hot pixels are not compared
  start.contrast_on = start.contrast_off = 0.25;
  start.mismatch_sigma = 0.1;
  return start;
}

/// Whether an address is a pixel: events that were moved to another grid put two pixels under some
/// addresses and none under others, which looks like mismatch.
bool is_pixel_by_pixel(const BlindTime& blind, SensorFile& sensor) {
  constexpr double kMost = 0.01;
  if (blind.without_floor < kMost) return true;
  sensor.remarks["mismatch.sigma"] = fmt::format(
      "not told: {} % of the gaps are shorter than the blind time, as where events were moved to "
      "another grid",
      significant(100 * blind.without_floor, 2));
  return false;
}

/// Fits, then again without what the data did not tell.
SensorFit fit_what_is_told(std::span<const RepeatedRecording> recordings, SensorParameters start,
                           SensorFitOptions options, SensorFile& sensor) {
  if (!options.fits_mismatch) start.mismatch_sigma.reset();
  if (options.fits_cutoff) {
    start.cutoff_hz = 1500;
    start.filter_order = 2;
  }
  for (;;) {
    SensorFit fit = fit_sensor(recordings, start, options);
    const auto untold = std::ranges::find_if(fit.parameters, [](const FittedParameter& p) {
      return !p.is_told && (p.name.starts_with("bandwidth") || p.name.starts_with("mismatch"));
    });
    if (untold == fit.parameters.end()) return fit;
    sensor.remarks[untold->name] = fmt::format("not told: anything from {} to {} fits",
                                               significant(untold->low), significant(untold->high));
    const bool is_cutoff = untold->name.starts_with("bandwidth");
    start = fit.sensor;
    if (is_cutoff) {
      options.fits_cutoff = false;
      start.cutoff_hz.reset();
      start.filter_order.reset();
    } else {
      options.fits_mismatch = false;
      start.mismatch_sigma.reset();
    }
  }
}

void put_fit(const SensorFit& fit, SensorFile& sensor) {
  const std::optional<double> hot = sensor.events.hot_fraction;
  sensor.events = fit.sensor;
  sensor.events.hot_fraction = hot;
  for (const FittedParameter& p : fit.parameters) {
    sensor.intervals[p.name] = {p.low, p.high};
    sensor.remarks[p.name] = "simulated again";
  }
  if (!fit.has_converged)
    sensor.remarks["contrast_on"] = "simulated again; the fit had not come to rest";
}

/// The mean change between a pixel's events, of what the calibrated sensor fires.
void put_effective_contrast(std::span<const Repeater> repeaters, SensorFile& sensor) {
  ContrastSums sums;
  for (const Repeater& repeater : repeaters)
    sums += contrast_sums(repeater.sensed(sensor.events), {repeater.stretch.source.camera.width,
                                                           repeater.stretch.source.camera.height});
  sensor.effective_contrast_on = sums.mean_on();
  sensor.effective_contrast_off = sums.mean_off();
  sensor.remarks["estimators.contrast_on"] =
      "mean change of the log intensity from a pixel's event to its next, simulated";
}

void write_replicas(const CalibrationRequest& request, std::span<const Repeater> repeaters,
                    const SensorFile& sensor) {
  for (std::size_t i = 0; i < repeaters.size(); ++i) {
    const fs::path folder = *request.replicas / fmt::format("stretch{}", i);
    write_replica(repeaters[i].stretch.source, folder);
    write_sensor_file(folder / "sensor.yaml", sensor);
  }
}

void simulate_again(const CalibrationRequest& request, const EventFindings& found,
                    CalibrationSummary& summary) {
  const std::vector<Repeater> repeaters = make_repeaters(request, found, summary.remarks);
  if (repeaters.empty()) return;
  SensorFile& sensor = summary.sensor;
  put_noise(found, mean_radiance(repeaters), sensor);
  sensor.events.log_eps = repeaters.front().stretch.source.log_eps;
  sensor.remarks["log_eps"] = "assumed: a frame does not tell its black level";
  std::vector<RepeatedRecording> recordings;
  for (const Repeater& r : repeaters) {
    const PinholeCamera& camera = r.stretch.source.camera;
    recordings.push_back({r.stretch.name,
                          {camera.width, camera.height},
                          r.stretch.source.duration_s,
                          r.stretch.events,
                          [&r](const SensorParameters& p) { return r.events(p); }});
  }
  SensorFitOptions options;
  const bool has_pixels = is_pixel_by_pixel(found.blind, sensor);
  options.fits_refractory = sensor.events.refractory_us.has_value();
  if (!has_pixels) options.shortest_gap_us = 0.8 * sensor.events.refractory_us.value_or(0);
  options.fits_cutoff = request.fits_cutoff;
  options.fits_mismatch = has_pixels && request.fits_mismatch;
  const SensorFit fit = fit_what_is_told(recordings, start_of(sensor), options, sensor);
  put_fit(fit, sensor);
  put_effective_contrast(repeaters, sensor);
  for (std::size_t i = 0; i < recordings.size(); ++i)
    summary.stretches.push_back({recordings[i].name, recordings[i].size, recordings[i].recorded,
                                 repeaters[i].events(fit.sensor), fit.distances[i]});
  summary.folds = fit.folds;
  if (request.replicas) write_replicas(request, repeaters, sensor);
}

}  // namespace

CalibrationSummary calibrate(const CalibrationRequest& request) {
  CalibrationSummary summary;
  summary.sensor.name = request.name;
  const EventFindings found = findings_of(request);
  put_blind_time(found.blind, summary.sensor);
  put_hot_pixels(found, summary.sensor);
  put_noise(found, std::nullopt, summary.sensor);
  if (request.simulates) simulate_again(request, found, summary);
  if (!summary.sensor.events.contrast_on)
    summary.sensor.remarks["contrast_on"] = "not told without a frame and a motion";
  return summary;
}

}  // namespace saccade
