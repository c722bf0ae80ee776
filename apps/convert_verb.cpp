#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "apps/common_options.h"
#include "apps/convert_grids.h"
#include "apps/convert_poses.h"
#include "apps/option_checks.h"
#include "apps/verbs.h"
#include "core/error.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/event_file.h"
#include "core/io/events/event_formats.h"
#include "core/io/export/ros_export.h"
#include "core/io/import/public_sequence.h"
#include "core/io/import/ros_recording.h"
#include "core/io/ros/message_writer.h"
#include "core/process/progress.h"

namespace saccade {
namespace {

struct ConvertOptions {
  std::filesystem::path input;
  std::filesystem::path output;
  std::string unit;    ///< empty: the coarsest that keeps every time
  std::string format;  ///< empty: the first of the ending
  std::filesystem::path calibration;
  std::filesystem::path dataset;  ///< whose frames COLMAP's pictures are
  ImportWindow window;
  GridRequest grids;
  CommonOptions common;
};

/// An event file, or that of the dataset in a folder, whose sensor it is checked against.
struct EventInput {
  std::filesystem::path file;
  SensorSize size;
};

EventInput find_events(const std::filesystem::path& input) {
  if (!std::filesystem::is_directory(input) || is_ros_recording(input)) return {input, {}};
  const Dataset dataset = Dataset::open(input);
  if (dataset.events_file().empty())
    throw InputError(input.string(), "holds no events (" + event_file_names() + ")");
  return {dataset.events_file(), {dataset.camera().width, dataset.camera().height}};
}

/// The coarsest that keeps every time. A file that states its times in ns is read for it.
TimestampUnit coarsest_unit(const EventInput& input) {
  EventStream stream(input.file, input.size);
  if (stream.unit() == TimestampUnit::kMicroseconds) return TimestampUnit::kMicroseconds;
  while (true) {
    const std::span<const Event> events = stream.next();
    if (events.empty()) return TimestampUnit::kMicroseconds;
    if (!std::all_of(events.begin(), events.end(),
                     [](const Event& e) { return e.t_ns % 1000 == 0; }))
      return TimestampUnit::kNanoseconds;
  }
}

/// Block by block, so that memory does not grow with the file.
std::uint64_t convert_events(const ConvertOptions& options) {
  const EventInput input = find_events(options.input);
  TimestampUnit unit =
      options.unit == "ns" ? TimestampUnit::kNanoseconds : TimestampUnit::kMicroseconds;
  if (options.unit.empty()) unit = coarsest_unit(input);
  EventStream stream(input.file, input.size);
  const SensorSize sensor = input.size.width > 0 ? input.size : stream.sensor();
  const EventFormat* format = find_written_format(options.output, options.format);
  if (format == nullptr)
    throw InputError("--format", fmt::format("a file with the ending '{}' is not written as {}",
                                             options.output.extension().string(), options.format));
  if (unit == TimestampUnit::kNanoseconds && format->finest == TimestampUnit::kMicroseconds)
    show_notice(fmt::format("{} holds times in us, to which those of the input are rounded",
                            options.output.string()));
  const std::unique_ptr<EventWriter> writer = format->make_writer(options.output, unit, sensor);
  for (auto events = stream.next(); !events.empty(); events = stream.next()) writer->append(events);
  writer->close();
  return writer->count();
}

/// A sequence of a public benchmark into a dataset folder.
void convert_sequence(const PublicSequence& sequence, const ConvertOptions& options) {
  if (!options.unit.empty())
    throw InputError("--unit", "belongs to event files; a dataset keeps the sequence's unit");
  const ImportCounts counts = write_as_dataset(sequence, options.output, options.window);
  if (options.common.quiet) return;
  fmt::print("{}: {} of {}\n", options.output.string(), counts.text(), sequence.layout);
  if (sequence.camera.residual_px > 0)
    fmt::print("the lens model was replaced by one that differs by at most {:.2g} px\n",
               sequence.camera.residual_px);
}

void convert_ros(const ConvertOptions& options) {
  if (!options.unit.empty())
    throw InputError("--unit",
                     "belongs to event files; a dataset keeps the unit of the recording, ns");
  const ImportCounts counts =
      write_ros_recording(options.input, options.output, options.window, options.calibration);
  if (!options.common.quiet)
    fmt::print("{}: {} of a recording of ROS\n", options.output.string(), counts.text());
}

/// A folder whose events alone would be less than what it holds.
bool is_dataset_folder(const std::filesystem::path& input) {
  return std::filesystem::is_directory(input) && !is_ros_recording(input);
}

void export_ros(const ConvertOptions& options) {
  if (!options.unit.empty()) throw InputError("--unit", "recordings of ROS hold times in ns");
  const ImportCounts counts = write_ros_export(options.input, options.output);
  if (!options.common.quiet) fmt::print("{}: {}\n", options.output.string(), counts.text());
}

void convert(const ConvertOptions& options) {
  options.common.apply();
  if (options.grids.is_stated()) {
    if (!options.format.empty())
      throw InputError("--format", "belongs to event files, not to grids");
    if (!options.unit.empty() || options.window.start_s != 0 || options.window.duration_s)
      throw InputError(options.unit.empty() ? "--start-s" : "--unit",
                       "does not belong to grids, whose windows are keys: duration_s=0.05");
    const std::string text = convert_to_grids(options.input, options.output, options.grids);
    if (!options.common.quiet) fmt::print("{}", text);
    return;
  }
  if (const std::string text = convert_poses({options.input, options.output, options.dataset});
      !text.empty()) {
    if (!options.common.quiet) fmt::print("{}", text);
    return;
  }
  if (find_written_format(options.output) == nullptr) {
    if (is_ros_recording(options.input)) return convert_ros(options);
    if (const auto sequence = open_public_sequence(options.input, options.calibration))
      return convert_sequence(*sequence, options);
    throw InputError(
        options.output.string(),
        "cannot tell the format from the ending; valid endings: " + event_file_endings(true) +
            "; .json for nerfstudio, where IN is a dataset or a run; a folder, where IN is a "
            "recording of "
            "ROS, an AEDAT4 file, a run, or a sequence of DSEC, TUM-VIE, M3ED, MVSEC, VECtor, EDS "
            "or "
            "EuRoC (a folder in the layout of the Event Camera Dataset is read as it is)");
  }
  if (options.window.start_s != 0 || options.window.duration_s || !options.calibration.empty())
    throw InputError(options.calibration.empty() ? "--start-s" : "--calibration",
                     "belongs to the conversion of whole sequences");
  if (is_written_recording(options.output) && is_dataset_folder(options.input))
    return export_ros(options);
  const std::uint64_t count = convert_events(options);
  if (!options.common.quiet) fmt::print("{}: {} events\n", options.output.string(), count);
}

void add_grid_options(CLI::App& verb, GridRequest& request) {
  CLI::Option* voxels =
      verb.add_option("--voxel-grid", request.voxel_grid,
                      "Voxel grids as of E2VID, by key=value,... or default. Keys: bins, polarity "
                      "(signed, separate), normalize (none, nonzero), span (events, window), and "
                      "the window: duration_s, events or by_frames=true.")
          ->type_name("KEY=VALUE,...");
  verb.add_option("--event-frame", request.event_frame,
                  "Event frames, by key=value,... or default. Keys: kind (count, polarity, "
                  "time_surface), decay_s, and the window as above.")
      ->type_name("KEY=VALUE,...")
      ->excludes(voxels);
}

}  // namespace

void add_convert_verb(CLI::App& command) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* verb = command.add_subcommand("convert",
                                          "Convert events between formats or into grids, "
                                          "recordings and public sequences into datasets, "
                                          "datasets into recordings of ROS, and poses.");
  verb->add_option(
          "IN", options->input,
          "Event file of any format (docs/formats.md), recognised by its content; dataset or run "
          "folder; sequence of DSEC, TUM-VIE, M3ED, MVSEC, VECtor, EDS or EuRoC; or poses of "
          "COLMAP. "
          "BAG!/topic names one of several topics, FILE.h5!/group one of several cameras.")
      ->required();
  verb->add_option(
          "OUT", options->output,
          "Event file, whose extension selects the format (" + event_file_endings(true) +
              "; of a whole dataset a .bag or .mcap holds everything); file of grids (.h5, .npy) "
              "or, "
              "for event frames, a folder of pictures; the dataset folder for a sequence or a "
              "recording; or poses (.txt, .json of nerfstudio, a folder for "
              "rpg_trajectory_evaluation).")
      ->required();
  verb->add_option(
          "--unit", options->unit,
          "Unit of the time stamps in HDF5 and NumPy's archives (default: us, or ns where us would "
          "round them).")
      ->check(CLI::IsMember({"us", "ns"}));
  verb->add_option("--format", options->format, "Encoding of a .raw file: EVT3 (default) or EVT2.")
      ->check(CLI::IsMember({"EVT3", "EVT2"}));
  verb->add_option(
          "--start-s", options->window.start_s,
          "Start of the part of a sequence or bag to convert, in seconds from its first event.")
      ->check(number_between(0, 1e9));
  verb->add_option("--duration-s", options->window.duration_s, "Length of that part in seconds.")
      ->check(positive_number());
  verb->add_option(
          "--calibration", options->calibration,
          "Calibration of the camera for a sequence or bag that holds none, or in place of "
          "its own: calib.txt, a camchain of Kalibr (CHAIN.yaml!/cam1 names one of its "
          "cameras), or a camera_info of ROS.")
      ->type_name("FILE");
  verb->add_option("--data", options->dataset,
                   "Dataset whose frames are the pictures of COLMAP's images.txt.")
      ->type_name("DATASET");
  add_grid_options(*verb, options->grids);
  add_common_options(*verb, options->common);
  verb->footer(
      "Examples:\n"
      "  saccade convert recording/events.txt events.h5\n"
      "  saccade convert recording.raw recording.aedat4\n"
      "  saccade convert data/walls grids.h5 --voxel-grid bins=5,duration_s=0.05\n"
      "  saccade convert data/walls frames --event-frame kind=polarity,events=20000\n"
      "  saccade convert data/walls walls.mcap\n"
      "  saccade convert recording.bag data/mine --calibration camchain.yaml\n"
      "  saccade convert runs/walls evaluation\n"
      "  saccade convert dsec/interlaken_00_c data/interlaken_00_c\n"
      "  saccade convert tum_vie/mocap-desk2 data/mocap-desk2 --duration-s 10");
  verb->callback([options] { convert(*options); });
}

}  // namespace saccade
