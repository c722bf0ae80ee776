#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include "apps/common_options.h"
#include "apps/verbs.h"
#include "core/error.h"
#include "core/io/dataset.h"
#include "core/io/event_file.h"

namespace saccade {
namespace {

struct ConvertOptions {
  std::filesystem::path input;
  std::filesystem::path output;
  std::string unit;  ///< empty: the coarsest that keeps every time
  CommonOptions common;
};

/// Events of a file, or of the dataset in a folder, whose sensor they are checked against.
Events load(const ConvertOptions& options) {
  if (std::filesystem::is_directory(options.input))
    return Dataset::open(options.input).load_events();
  return read_events(options.input, SensorSize{});
}

TimestampUnit unit_of(const ConvertOptions& options, const Events& events) {
  const bool keeps_microseconds =
      std::all_of(events.begin(), events.end(), [](const Event& e) { return e.t_ns % 1000 == 0; });
  const bool microseconds = options.unit.empty() ? keeps_microseconds : options.unit == "us";
  return microseconds ? TimestampUnit::kMicroseconds : TimestampUnit::kNanoseconds;
}

void convert(const ConvertOptions& options) {
  options.common.apply();
  const std::string ending = options.output.extension().string();
  if (ending != ".h5" && ending != ".hdf5" && ending != ".txt")
    throw InputError(options.output.string(),
                     "cannot tell the format from the ending; valid endings: .h5, .hdf5, .txt");
  const Events events = load(options);
  const std::unique_ptr<EventWriter> writer =
      make_event_writer(options.output, unit_of(options, events));
  writer->append(events);
  writer->close();
  if (!options.common.quiet) fmt::print("{}: {} events\n", options.output.string(), events.size());
}

}  // namespace

void add_convert_verb(CLI::App& command) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* verb = command.add_subcommand("convert", "Convert events between text and HDF5");
  verb->add_option("IN", options->input, "Event file (.txt, .h5) or dataset folder")->required();
  verb->add_option("OUT", options->output, "Event file; its ending names the format")->required();
  verb->add_option("--unit", options->unit,
                   "Unit of the times in HDF5 (default: us, or ns where us would round)")
      ->check(CLI::IsMember({"us", "ns"}));
  add_common_options(*verb, options->common);
  verb->footer("Example:\n  saccade convert recording/events.txt events.h5");
  verb->callback([options] { convert(*options); });
}

}  // namespace saccade
