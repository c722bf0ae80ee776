#include "estimator/external/adapter_config.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "core/io/events/event_formats.h"
#include "core/process/program.h"
#include "core/process/shell.h"
#include "estimator/external/command_template.h"

namespace saccade {
namespace {

void describe_trajectory(config::Fields& fields, TrajectoryFormat& format) {
  using Columns = TrajectoryFormat::Columns;
  using Convention = TrajectoryFormat::Convention;
  fields.value("file", format.file, "The trajectory file, relative to {out}.");
  fields.choice("columns", format.columns, {{"tum", Columns::kTum}, {"euroc", Columns::kEuroc}},
                "Order of the columns: t x y z qx qy qz qw (`tum`) or t x y z qw qx qy qz "
                "(`euroc`).");
  fields.choice("timestamp_unit", format.timestamp_unit,
                {{"s", StampUnit::kSeconds},
                 {"ms", StampUnit::kMilliseconds},
                 {"us", StampUnit::kMicroseconds},
                 {"ns", StampUnit::kNanoseconds}},
                "Unit of the time stamps.");
  fields.choice("poses", format.poses,
                {{"world_from_camera", Convention::kWorldFromCamera},
                 {"camera_from_world", Convention::kCameraFromWorld}},
                "Direction of the transform that a pose states.");
  fields
      .value("time_offset_s", format.time_offset_s,
             "Time that is added to every stamp, in seconds.")
      .range(-1e10, 1e10);
}

void describe_output(config::Fields& fields, AdapterOutput& output) {
  fields.group(
      "trajectory",
      [&](config::Fields& trajectory) { describe_trajectory(trajectory, output.trajectory); },
      "The trajectory that the program writes.");
  fields.value("covariance", output.covariance,
               "File in the format of covariance.txt. Empty: the program writes none.");
  fields.value("map", output.map,
               "PLY file with the tracked points. Empty: the program writes none.");
  fields.value("views", output.views,
               "Folder with views.yaml and depth maps. Empty: the program writes none.");
  fields.value("events", output.events,
               "File with the events that a simulator makes; its ending is that of the format. The "
               "program then writes no trajectory. Empty: the program makes none.");
  fields.expect(output.events.empty() ||
                    (output.covariance.empty() && output.map.empty() && output.views.empty()),
                "events",
                "is of a simulator: 'covariance', 'map' and 'views' belong to a trajectory");
}

void describe_input(config::Fields& fields, AdapterConfig& config) {
  config::Names<std::string> formats{{"csv", "csv"}};
  std::string help = "Format of the events: `csv`: lines t,x,y,p.";
  for (const EventFormat& format : event_formats()) {
    if (format.make_writer == nullptr) continue;
    formats.emplace_back(format.ending.substr(1), format.ending.substr(1));
    help.append(" `").append(format.ending.substr(1)).append("`: ").append(format.help);
  }
  fields.choice("events", config.events, formats, help);
  fields.choice("timestamp_unit", config.event_unit,
                {{"us", StampUnit::kMicroseconds}, {"ns", StampUnit::kNanoseconds}},
                "Time unit of h5 and csv.");
}

/// A class must not leave out what the adapter hands over.
void check_class(config::Fields& fields, const AdapterConfig& config) {
  if (!config.method_class) return;
  const std::set<MethodInput>& inputs = config.method_class->inputs;
  fields.expect(config.truth_s == 0 || inputs.contains(MethodInput::kStart), "class",
                "must hold `start` among its inputs: start.truth_s gives poses");
  fields.expect(!uses_placeholder(config.command, "imu") || inputs.contains(MethodInput::kImu),
                "class", "must hold `imu` among its inputs: the command takes {imu}");
  fields.expect(
      !uses_placeholder(config.command, "events") || inputs.contains(MethodInput::kEvents), "class",
      "must hold `events` among its inputs: the command takes {events}");
}

/// The interpreter, with the module of this build where there is one.
std::string python_words() {
  const char* stated = std::getenv("SACCADE_PYTHON");
  const std::string interpreter = stated != nullptr && *stated != '\0' ? stated : "python3";
  std::error_code unknown;
  const std::filesystem::path module =
      std::filesystem::read_symlink(program_file(), unknown).parent_path() / "python";
  if (!std::filesystem::exists(module / "saccade")) return shell_line(std::array{interpreter});
  const char* path = std::getenv("PYTHONPATH");
  const std::string folders =
      module.string() + (path != nullptr && *path != '\0' ? ":" + std::string(path) : "");
  return shell_line(std::array<std::string, 3>{"env", "PYTHONPATH=" + folders, interpreter});
}

/// The words of a line, in which no brace opens a placeholder.
std::string without_placeholders(const std::string& line) {
  std::string text;
  for (const char c : line) text += c == '{' || c == '}' ? std::string(2, c) : std::string(1, c);
  return text;
}

}  // namespace

std::string command_of(const AdapterConfig& config) {
  if (!config.python) return config.command;
  const bool takes_imu =
      config.method_class && config.method_class->inputs.contains(MethodInput::kImu);
  return without_placeholders(python_words()) +
         " -m saccade.method {program} --events {events} --calib {calib} --width {width} "
         "--height {height} --seed {seed} --out {out}" +
         (config.truth_s > 0 ? " --start {groundtruth_start}" : "") +
         (takes_imu ? " --imu {imu}" : "");
}

void describe(config::Fields& fields, AdapterConfig& config) {
  fields.value("name", config.name, "Name of the method in tables and reports.");
  fields.value("command", config.command,
               "Command line with placeholders in braces. It is run without a shell.");
  fields
      .path("python", config.python,
            "Python file with a method (docs/python.md), in place of a command. It runs by "
            "$SACCADE_PYTHON, default python3; its time is that of the method alone.")
      .must_exist();
  fields.expect(!config.python || config.command.empty(), "python",
                "must not be stated beside 'command'");
  fields.value("version_command", config.version_command,
               "Command that prints the version of the program. Empty: none.");
  fields.value("files", config.files,
               "Further placeholders and the files that they stand for, relative to the adapter.");
  fields.group(
      "input", [&](config::Fields& input) { describe_input(input, config); },
      "Events that the program receives.");
  fields.group(
      "start",
      [&](config::Fields& start) {
        start
            .value("truth_s", config.truth_s,
                   "How long poses of the ground truth are given, in seconds from the first event "
                   "on. 0 gives none.")
            .range(0, 1e3);
      },
      "What the program is given at the start.");
  fields.section("class", config.method_class,
                 "What the program is given and how far it looks ahead: it is ranked among methods "
                 "of the same class. `~`: not known.");
  check_class(fields, config);
  fields.group(
      "output", [&](config::Fields& output) { describe_output(output, config.output); },
      "Results that the program leaves in {out}.");
  fields
      .value("timeout_s", config.timeout_s,
             "Time limit of one repetition, in seconds. The program is ended after it.")
      .above(0);
  fields.value("seed", config.seed, "Value of the placeholder {seed}.");
  fields.path("container", config.container,
              "Image of Apptainer (or Singularity) in which the command runs. It sees the run's "
              "folder, the dataset and the folders of `files`.");
  fields.expect(!config.container || !config.python, "container",
                "is for a command; a method of the Python module runs by $SACCADE_PYTHON");
  fields.value("prepare", config.prepare,
               "Command without placeholders that `saccade sweep --submission` runs once in the "
               "adapter's folder, before anything else: what builds the program.");
  fields.value("licence", config.licence, "Licence of the method. A submission must state it.");
  fields.value("link", config.link, "Where the method is described.");
  fields
      .value("expected_s", config.expected_s,
             "Time that a second of recording takes, in seconds, as its authors state it; shown "
             "beside what was measured.")
      .above(0);
  fields.expect(!config.name.empty(), "name", "must not be empty");
  for (const char* key : {"command", "version_command"}) {
    const std::string& text =
        key == std::string("command") ? config.command : config.version_command;
    const std::string problem = placeholder_problem(text, config);
    fields.expect(problem.empty(), key, problem);
  }
}

}  // namespace saccade
