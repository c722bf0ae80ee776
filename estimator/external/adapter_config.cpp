#include "estimator/external/adapter_config.h"

#include "estimator/external/command_template.h"

namespace saccade {
namespace {

void describe_trajectory(config::Fields& fields, TrajectoryFormat& format) {
  using Columns = TrajectoryFormat::Columns;
  using Convention = TrajectoryFormat::Convention;
  fields.value("file", format.file, "Trajectory file that the program writes, relative to {out}.");
  fields.choice(
      "columns", format.columns, {{"tum", Columns::kTum}, {"euroc", Columns::kEuroc}},
      "Columns of the trajectory: `tum` is t x y z qx qy qz qw, `euroc` is t x y z qw qx qy qz.");
  fields.choice("time_unit", format.time_unit,
                {{"s", StampUnit::kSeconds},
                 {"ms", StampUnit::kMilliseconds},
                 {"us", StampUnit::kMicroseconds},
                 {"ns", StampUnit::kNanoseconds}},
                "Time unit of the time stamps.");
  fields.choice("poses", format.poses,
                {{"world_from_camera", Convention::kWorldFromCamera},
                 {"camera_from_world", Convention::kCameraFromWorld}},
                "Direction of the poses: `world_from_camera` maps camera to world coordinates.");
  fields
      .value("time_offset_s", format.time_offset_s,
             "Offset that is added to every time stamp, in seconds.")
      .range(-1e12, 1e12);
}

void describe_output(config::Fields& fields, AdapterOutput& output) {
  fields.group(
      "trajectory",
      [&](config::Fields& trajectory) { describe_trajectory(trajectory, output.trajectory); },
      "Format of the poses that the program writes.");
  fields.value(
      "covariance", output.covariance,
      "File with covariances in the format of covariance.txt, relative to {out}. Empty: none.");
  fields.value("map", output.map,
               "File with the map in the format of map.ply, relative to {out}. Empty: none.");
  fields.value("views", output.views,
               "Folder with views.yaml and depth maps, relative to {out}. Empty: none.");
}

void describe_input(config::Fields& fields, AdapterConfig& config) {
  fields.choice(
      "events", config.events,
      {{"txt", HandoverEvents::kText}, {"h5", HandoverEvents::kH5}, {"csv", HandoverEvents::kCsv}},
      "Format of the events: `txt` is t x y p with t in seconds, `h5` is the layout of DSEC, `csv` "
      "is t,x,y,p.");
  fields.choice("time_unit", config.event_unit,
                {{"us", StampUnit::kMicroseconds}, {"ns", StampUnit::kNanoseconds}},
                "Time unit of the events in h5 and csv.");
}

}  // namespace

void describe(config::Fields& fields, AdapterConfig& config) {
  fields.value("name", config.name, "Name of the method in tables.");
  fields.value(
      "command", config.command,
      "Command line with placeholders such as {events} and {out}. It runs without a shell.");
  fields.value("version_command", config.version_command,
               "Command line that prints the version of the program. Empty: none.");
  fields.value("files", config.files, "Files that the command needs, as `placeholder: path`.");
  fields.value("environment", config.environment,
               "Environment variables of the program. Their values may contain placeholders.");
  fields.group(
      "input", [&](config::Fields& input) { describe_input(input, config); },
      "Files that the program receives.");
  fields
      .value("groundtruth_start_s", config.groundtruth_start_s,
             "Time from the start of the window, in seconds, over which the program receives true "
             "poses. 0 gives none.")
      .at_least(0);
  fields.group(
      "output", [&](config::Fields& output) { describe_output(output, config.output); },
      "Files that the program writes to {out}.");
  fields
      .value("timeout_s", config.timeout_s,
             "Time limit of one repetition, in seconds; the program is killed after it.")
      .above(0);
  fields.value("seed", config.seed, "Value of the placeholder {seed}.");
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
