#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/calibration.h"
#include "apps/command_line.h"
#include "apps/common_options.h"
#include "apps/option_checks.h"
#include "apps/verbs.h"
#include "core/error.h"

namespace saccade {
namespace {

struct CalibrateOptions {
  CalibrationRequest request;
  std::filesystem::path output;
  std::optional<std::filesystem::path> page;
  CommonOptions common;
};

void show(const CalibrationSummary& summary) {
  fmt::print("{}", table_text(parameter_table(summary.sensor)));
  if (!summary.stretches.empty()) fmt::print("\n{}", table_text(distance_table(summary)));
  if (!summary.folds.empty()) fmt::print("\n{}", table_text(fold_table(summary)));
  for (const std::string& remark : summary.remarks) fmt::print("{}\n", remark);
}

void calibrate_recordings(CalibrateOptions options) {
  options.common.apply();
  if (options.output.empty()) throw InputError("-o", "name the file to write: -o sensor.yaml");
  CalibrationRequest& request = options.request;
  request.seed = options.common.seed.value_or(1);
  if (request.name.empty()) request.name = options.output.stem().string();
  CalibrationSummary summary = calibrate(request);
  summary.command = command_line();
  const std::filesystem::path page =
      options.page.value_or(std::filesystem::path(options.output).replace_extension(".html"));
  write_sensor_file(options.output, summary.sensor);
  write_calibration_page(summary, page);
  if (options.common.quiet) return;
  show(summary);
  fmt::print("wrote {} and {}\n", options.output.string(), page.string());
}

void add_replica_options(CLI::App& verb, ReplicaOptions& replica) {
  using Motion = ReplicaOptions::Motion;
  using Tone = ReplicaOptions::Tone;
  verb.add_option("--start-s", replica.part.start_s,
                  "Begin of the part that counts (default: first event).")
      ->check(number_between(-kLongest_s, kLongest_s));
  verb.add_option("--duration-s", replica.part.duration_s, "Length of the part that counts.")
      ->check(number_between(1e-9, kLongest_s));
  verb.add_option("--motion", replica.motion,
                  "Motion of the camera: poses, imu (its rotation by the gyroscope), events (its "
                  "rotation by contrast maximisation), or auto, the first of these that is there.")
      ->transform(
          CLI::CheckedTransformer(std::map<std::string, Motion>{{"auto", Motion::kAuto},
                                                                {"poses", Motion::kPoses},
                                                                {"imu", Motion::kImu},
                                                                {"events", Motion::kEvents}}));
  verb.add_option("--frame-tone", replica.tone,
                  "What the codes of 8-bit frames are: linear in the light, srgb, or auto, linear "
                  "unless the dataset is simulated.")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Tone>{
          {"auto", Tone::kAuto}, {"srgb", Tone::kSrgb}, {"linear", Tone::kLinear}}));
  verb.add_option("--depth-m", replica.depth_m,
                  "Depth of the plane on which a frame hangs, where the camera translates "
                  "(default: median of the nearest depth map).")
      ->check(positive_number());
  verb.add_option("--log-eps", replica.log_eps,
                  "Light that a pixel takes its dark current for, as a fraction of the frame's "
                  "white (default: the dataset's, or 0.02).")
      ->check(number_between(1e-9, 1));
  verb.add_option("--stretches", replica.stretches, "Stretches that are simulated again, at most.")
      ->check(whole_number(1, 100))
      ->capture_default_str();
  verb.add_option("--stretch-s", replica.stretch_s, "Longest stretch [s].")
      ->check(number_between(0.005, 10))
      ->capture_default_str();
}

}  // namespace

void add_calibrate_verb(CLI::App& command) {
  const auto options = std::make_shared<CalibrateOptions>();
  CalibrationRequest& request = options->request;
  CLI::App* verb = command.add_subcommand(
      "calibrate", "Find a sensor's thresholds, blind time and noise from its recordings.");
  verb->add_option("RECORDING", request.recordings,
                   "Dataset folders or event files, all of one sensor.")
      ->required();
  verb->add_option("-o,--output", options->output, "Sensor file to write (YAML).")
      ->type_name("SENSOR");
  verb->add_option("--page", options->page,
                   "Page with tables and pictures (default: SENSOR with the ending .html).")
      ->type_name("HTML");
  verb->add_option("--name", request.name, "Name of the sensor (default: that of the file).");
  verb->add_option("--replicas", request.replicas,
                   "Folder for the simulation of every stretch (simulation.yaml and its scene).")
      ->type_name("FOLDER");
  verb->add_flag_callback(
      "--events-only", [options] { options->request.simulates = false; },
      "Simulate nothing again: blind time, noise and hot pixels alone.");
  verb->add_flag("--bandwidth", request.fits_cutoff,
                 "Fit the photoreceptor's low pass, too: only where frames are sharp, since their "
                 "blur looks like it.");
  add_replica_options(*verb, request.replica);
  verb->add_option("--seed", options->common.seed, "Seed of the simulated noise.")
      ->type_name("N")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()));
  add_common_options(*verb, options->common);
  verb->footer(
      "Example:\n"
      "  saccade calibrate data/poster data/shapes -o davis.yaml\n"
      "  saccade simulate configs/simulation/walls.yaml --sensor davis.yaml -o data/walls");
  verb->callback([options] { calibrate_recordings(*options); });
}

}  // namespace saccade
