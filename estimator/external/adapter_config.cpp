#include "estimator/external/adapter_config.h"

#include "estimator/external/command_template.h"

namespace saccade {
namespace {

void describe_trajectory(config::Fields& fields, TrajectoryFormat& format) {
  using Columns = TrajectoryFormat::Columns;
  using Convention = TrajectoryFormat::Convention;
  fields.value("file", format.file, "in {out}");
  fields.choice("columns", format.columns, {{"tum", Columns::kTum}, {"euroc", Columns::kEuroc}},
                "t x y z qx qy qz qw, or with qw first");
  fields.choice("time_unit", format.time_unit,
                {{"s", StampUnit::kSeconds},
                 {"ms", StampUnit::kMilliseconds},
                 {"us", StampUnit::kMicroseconds},
                 {"ns", StampUnit::kNanoseconds}},
                "of the stamps");
  fields.choice("poses", format.poses,
                {{"world_from_camera", Convention::kWorldFromCamera},
                 {"camera_from_world", Convention::kCameraFromWorld}},
                "what a pose maps");
  fields.value("time_offset_s", format.time_offset_s, "added to every stamp");
}

void describe_output(config::Fields& fields, AdapterOutput& output) {
  fields.group(
      "trajectory",
      [&](config::Fields& trajectory) { describe_trajectory(trajectory, output.trajectory); },
      "poses that the program writes");
  fields.value("covariance", output.covariance, "as covariance.txt; empty is none");
  fields.value("map", output.map, "tracked points as map.ply; empty is none");
  fields.value("views", output.views, "folder with views.yaml and depth maps; empty is none");
}

void describe_input(config::Fields& fields, AdapterConfig& config) {
  fields.choice(
      "events", config.events,
      {{"txt", HandoverEvents::kText}, {"h5", HandoverEvents::kH5}, {"csv", HandoverEvents::kCsv}},
      "t x y p in seconds; the layout of DSEC; t,x,y,p");
  fields.choice("time_unit", config.event_unit,
                {{"us", StampUnit::kMicroseconds}, {"ns", StampUnit::kNanoseconds}},
                "of h5 and csv");
}

}  // namespace

void describe(config::Fields& fields, AdapterConfig& config) {
  fields.value("name", config.name, "of the method");
  fields.value("command", config.command, "words with placeholders, no shell");
  fields.value("version_command", config.version_command, "prints a version; empty is none");
  fields.value("files", config.files, "placeholder: file that the command needs");
  fields.value("environment", config.environment, "variables of the program");
  fields.group(
      "input", [&](config::Fields& input) { describe_input(input, config); },
      "what it is handed over");
  fields.value("groundtruth_start_s", config.groundtruth_start_s, "of true poses it may see")
      .at_least(0);
  fields.group(
      "output", [&](config::Fields& output) { describe_output(output, config.output); },
      "what it leaves in {out}");
  fields.value("timeout_s", config.timeout_s, "of one repetition").above(0);
  fields.value("seed", config.seed, "stands for {seed}");
  fields.expect(!config.name.empty(), "name", "must not be empty");
  for (const char* key : {"command", "version_command"}) {
    const std::string& text =
        key == std::string("command") ? config.command : config.version_command;
    const std::string problem = placeholder_problem(text, config);
    fields.expect(problem.empty(), key, problem);
  }
  for (const auto& [name, value] : config.environment) {
    const std::string problem = placeholder_problem(value, config);
    fields.expect(problem.empty(), "environment", "." + name + " " + problem);
  }
}

}  // namespace saccade
