#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "apps/common_options.h"
#include "apps/verbs.h"
#include "core/config/config.h"
#include "core/error.h"
#include "simulator/dataset_cache.h"
#include "simulator/scene/describe_mesh.h"
#include "simulator/simulate.h"

namespace saccade {
namespace {

struct SimulateVerbOptions {
  std::string config;
  std::filesystem::path output;
  bool cached = false;
  CommonOptions common;
};

/// What is known about the events' times.
std::string accuracy(const DatasetRecord& record) {
  if (record.time_bound_us)
    return fmt::format("timestamps within {:.2g} us", *record.time_bound_us);
  if (!record.audit) return "adaptive sampling without an audit";
  const auto percent = [](const DatasetRecord::Figure& figure) {
    return fmt::format("{:.2f} % ({:.2f} to {:.2f})", 100 * figure.value, 100 * figure.low,
                       100 * figure.high);
  };
  return fmt::format("adaptive: precision {}, recall {} at 10 us on {} audited pixels",
                     percent(record.audit->precision_10us), percent(record.audit->recall_10us),
                     record.audit->pixels);
}

void show(const CameraReport& camera, const std::filesystem::path& folder) {
  const DatasetRecord& record = camera.record;
  const double events = static_cast<double>(camera.event_count());
  fmt::print("{}: {:.4g} s, {:.3f} M events ({:.3f} M ON), mean depth {:.2f} m, path {:.2f} m\n",
             folder.string(), record.duration_s, events * 1e-6,
             static_cast<double>(record.counts ? record.counts->events_on : 0) * 1e-6,
             record.mean_scene_depth_m.value_or(0), record.path_length_m.value_or(0));
  fmt::print(
      "  {:.1f} M rays ({:.2f} per event), {}\n"
      "  images {:.1f} s, events {:.1f} s ({:.2f} M events/s)\n",
      static_cast<double>(record.rays.value_or(0)) * 1e-6, record.rays_per_event.value_or(0),
      accuracy(record), camera.images_s, camera.events_s, 1e-6 * events / camera.events_s);
}

void show(const SimulationReport& report, const std::filesystem::path& output) {
  for (std::size_t i = 0; i < report.cameras.size(); ++i)
    show(report.cameras[i], i == 0 ? output : output / fmt::format("cam{}", i));
  fmt::print("  {:.1f} s in all, scene {:.1f} s\n", report.total_s, report.load_s);
}

/// Simulates into the cache what is not there yet; `-o` becomes a link to it.
void simulate_cached(const SimulateVerbOptions& options, const SimulationConfig& config) {
  const DatasetCache::Obtained obtained =
      DatasetCache(default_cache_folder())
          .obtain(config, std::filesystem::path(options.config).stem().string());
  if (!options.output.empty()) link_dataset(obtained.folder, options.output);
  if (options.common.quiet) return;
  if (obtained.report)
    show(*obtained.report, obtained.folder);
  else
    fmt::print("{}: simulated before\n", obtained.folder.string());
}

void simulate_config(const SimulateVerbOptions& options) {
  options.common.apply();
  if (is_mesh_name(options.config) && std::filesystem::is_regular_file(options.config))
    throw InputError(options.config,
                     "is a mesh; a configuration that shows it is wanted, for which saccade info "
                     "suggests an entry");
  const auto config = config::read<SimulationConfig>(options.common.load(options.config));
  if (options.common.print_config) {
    fmt::print("{}", config::print_documented(config));
    return;
  }
  if (options.cached) return simulate_cached(options, config);
  if (options.output.empty())
    throw InputError("-o", "name the dataset folder to write: -o DATASET");
  unlink_dataset(options.output);
  const SimulationReport report = simulate(config, options.output);
  if (!options.common.quiet) show(report, options.output);
}

}  // namespace

void add_simulate_verb(CLI::App& command) {
  const auto options = std::make_shared<SimulateVerbOptions>();
  CLI::App* verb = command.add_subcommand(
      "simulate", "Render a scene along a trajectory into events, frames, depth, IMU and poses.");
  verb->add_option("CONFIG", options->config, "Simulation configuration (YAML).")->required();
  verb->add_option("-o,--output", options->output, "Dataset folder to write.")
      ->type_name("DATASET");
  verb->add_flag("--cached", options->cached,
                 "Simulate into the cache ($SACCADE_CACHE, see `saccade cache`) unless the dataset "
                 "is there already; DATASET becomes a link to it.");
  add_config_options(*verb, options->common);
  add_sensor_option(*verb, options->common);
  add_reference_option(*verb, "simulate");
  add_common_options(*verb, options->common);
  verb->footer(
      "Example:\n"
      "  saccade simulate configs/simulation/walls.yaml -o data/walls --set duration_s=0.5");
  verb->callback([options] { simulate_config(*options); });
}

}  // namespace saccade
