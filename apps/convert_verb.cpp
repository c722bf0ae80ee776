#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "apps/common_options.h"
#include "apps/convert_grids.h"
#include "apps/option_checks.h"
#include "apps/verbs.h"
#include "core/error.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/event_file.h"
#include "core/io/events/event_formats.h"
#include "core/io/import/public_sequence.h"
#include "core/io/import/ros_bag.h"
#include "core/process/progress.h"

namespace saccade {
namespace {

struct ConvertOptions {
  std::filesystem::path input;
  std::filesystem::path output;
  std::string unit;    ///< empty: the coarsest that keeps every time
  std::string format;  ///< empty: the first of the ending
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
  if (!std::filesystem::is_directory(input)) return {input, {}};
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
  const std::uint64_t events = write_as_dataset(sequence, options.output, options.window);
  if (options.common.quiet) return;
  fmt::print("{}: {} events of a {} sequence\n", options.output.string(), events, sequence.layout);
  if (sequence.camera_residual_px > 0)
    fmt::print("the lens model was replaced by one that differs by at most {:.2g} px\n",
               sequence.camera_residual_px);
}

void convert_bag(const ConvertOptions& options) {
  if (!options.unit.empty())
    throw InputError("--unit", "belongs to event files; a dataset keeps the unit of the bag, ns");
  const BagCounts counts = write_bag_as_dataset(options.input, options.output, options.window);
  if (options.common.quiet) return;
  fmt::print("{}: {} events, {} frames, {} inertial samples and {} poses of a bag\n",
             options.output.string(), counts.events, counts.frames, counts.imu_samples,
             counts.poses);
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
  if (find_written_format(options.output) == nullptr) {
    if (is_bag(options.input)) return convert_bag(options);
    if (std::filesystem::is_directory(options.input))
      if (const auto sequence = open_public_sequence(options.input))
        return convert_sequence(*sequence, options);
    throw InputError(
        options.output.string(),
        "cannot tell the format from the ending; valid endings: " + event_file_endings(true) +
            "; a folder, where IN is a bag or a sequence of DSEC or TUM-VIE (a folder in the "
            "layout of the Event Camera Dataset is read as it is)");
  }
  if (options.window.start_s != 0 || options.window.duration_s)
    throw InputError("--start-s", "belongs to the conversion of whole sequences");
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
  CLI::App* verb = command.add_subcommand(
      "convert",
      "Convert events between formats or into grids, or a public sequence into a dataset.");
  verb->add_option(
          "IN", options->input,
          "Event file of any format (docs/formats.md), recognised by its content; dataset folder; "
          "or folder of a sequence of DSEC or TUM-VIE. BAG!/topic names one of several topics.")
      ->required();
  verb->add_option(
          "OUT", options->output,
          "Event file, whose extension selects the format (" + event_file_endings(true) +
              "); file of grids (.h5, .npy) or, for event frames, a folder of pictures; or the "
              "dataset folder for a sequence or a bag.")
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
  add_grid_options(*verb, options->grids);
  add_common_options(*verb, options->common);
  verb->footer(
      "Examples:\n"
      "  saccade convert recording/events.txt events.h5\n"
      "  saccade convert recording.raw recording.aedat4\n"
      "  saccade convert data/walls grids.h5 --voxel-grid bins=5,duration_s=0.05\n"
      "  saccade convert data/walls frames --event-frame kind=polarity,events=20000\n"
      "  saccade convert dsec/interlaken_00_c data/interlaken_00_c\n"
      "  saccade convert tum_vie/mocap-desk2 data/mocap-desk2 --duration-s 10");
  verb->callback([options] { convert(*options); });
}

}  // namespace saccade
