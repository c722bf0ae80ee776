#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "core/io/run/view_list.h"
#include "eval/picture/image/image_picture.h"
#include "eval/run_folder.h"
#include "eval/view/event_windows.h"
#include "eval/view/unfinished_events.h"

namespace saccade {

/// A dataset on the page. Its events and pictures are read when the page asks for them.
struct ViewRecording {
  explicit ViewRecording(const std::filesystem::path& folder);

  std::filesystem::path folder;
  Dataset dataset;
  std::optional<EventWindows> events;     ///< nullopt: the folder holds none
  std::optional<DepthRange> depth_range;  ///< of the first depth map, for all of them
};

/// A run on the page.
struct ViewRun {
  std::string name;  ///< the folder's; its path as it was given where two have the same
  RunFolder run;
  std::vector<RunView> views;            ///< of views.yaml
  std::optional<std::size_t> recording;  ///< index; nullopt: its dataset is not there any more
  /// Brings path, map and depth to where they are shown; of a start from events alone the
  /// alignment that it is scored after.
  Similarity truth_from_estimate;
  bool is_aligned = false;

  [[nodiscard]] Trajectory aligned_path() const;
};

/// A folder that another program is writing and that has not its name yet.
struct ViewUnfinished {
  std::filesystem::path folder;              ///< the name that it will have
  std::filesystem::path hidden;              ///< where it grows
  std::shared_ptr<UnfinishedEvents> events;  ///< nullptr: nobody knows how to read them
  std::optional<std::size_t> recording;      ///< of a run that shows its path (PathSoFar)

  /// The frames that are complete: frame_<8 digits>.png of these numbers, from 0 on without a gap.
  [[nodiscard]] std::size_t frames() const;
  /// The dataset of a run that shows its path; nullopt where it shows none, or the dataset is gone.
  [[nodiscard]] std::optional<std::filesystem::path> shown_dataset() const;
  [[nodiscard]] std::filesystem::path frame(std::size_t index) const;
};

/// What a page shows: recordings, each once, and runs, in the order in which they were named.
struct ViewContent {
  std::vector<std::unique_ptr<ViewRecording>> recordings;
  std::vector<ViewRun> runs;
  std::vector<ViewUnfinished> unfinished;

  /// Opens dataset and run folders; a run brings its dataset. InputError for a path that is
  /// neither, and for one that is not there, unless a program is writing it.
  /// `tail_of`: reads the events of what is being written; may be empty.
  [[nodiscard]] static ViewContent open(std::span<const std::filesystem::path> paths,
                                        const EventTailOf& tail_of = {});
};

}  // namespace saccade
